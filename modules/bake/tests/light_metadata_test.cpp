// What is made of the words of a light's header, which anybody may have written.
#include <gtest/gtest.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>

#include <limits>
#include <string>

namespace isolux {
namespace {

LightFile light_with(const std::string& key, const std::string& value) {
  LightFile light;
  light.metadata = {{key, value}};
  return light;
}

TEST(LightMetadata, ScenesThatAreNoneAreRefusedInWords) {
  const std::string deep = std::string(1000000, '[') + std::string(1000000, ']');
  for (const std::string& scene : {std::string(R"({"environment": 5})"), std::string(R"({"environment": {"type": 5}})"),
                                   std::string(R"({"environment": []})"), "{\"lights\": " + deep + "}"}) {
    EXPECT_THROW((void)light_scene(light_with("isolux.scene", scene)), InvalidInput) << scene.substr(0, 40);
  }
  EXPECT_THROW((void)light_outer(light_with("isolux.scene", "{\"lights\": " + deep + "}")), InvalidInput);
  EXPECT_THROW((void)light_outer(light_with("isolux.scene", "[1]")), InvalidInput);
  EXPECT_THROW((void)light_outer(light_with("isolux.scene", "no JSON")), InvalidInput);
}

TEST(LightMetadata, ScenesThatAreRefusedNameTheirFile) {
  LightFile light = light_with("isolux.scene", R"({"outer": "lowex"})");
  const auto expect_named = [&](const std::string& name) {
    for (const bool all : {true, false}) {
      try {
        all ? static_cast<void>(light_scene(light)) : static_cast<void>(light_outer(light));
        ADD_FAILURE() << "it is taken";
      } catch (const InvalidInput& error) {
        EXPECT_EQ(std::string(error.what()), name + ".outer: 'lowex'; allowed are lower, higher");
      }
    }
  };
  expect_named("isolux.scene of the light");
  light.path = "l.nrrd";
  expect_named("l.nrrd: isolux.scene");
}

TEST(LightMetadata, AnImageEnvironmentIsNotTold) {
  const LightFile light = light_with("isolux.scene", R"({"environment": {"type": "image"}, "outer": "higher"})");
  EXPECT_FALSE(light_scene(light).has_value());
  EXPECT_EQ(light_outer(light), OuterSide::kHigher);
}

TEST(LightMetadata, BouncesAreANumberOrAll) {
  const auto bounces = [](const std::string& settings) {
    return light_bounces(light_with("isolux.settings", settings));
  };
  EXPECT_EQ(bounces(R"({"bounces": 3})"), 3);
  EXPECT_EQ(bounces(R"({"bounces": 4294967296})"), std::numeric_limits<int>::max());
  for (const char* settings : {R"({"bounces": "all"})", R"({"bounces": -7})", R"({"bounces": 1.5})", "{}", "[]", "x"})
    EXPECT_EQ(bounces(settings), kAllBounces) << settings;
  EXPECT_EQ(light_bounces({}), kAllBounces);
}

}  // namespace
}  // namespace isolux
