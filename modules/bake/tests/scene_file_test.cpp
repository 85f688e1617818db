// What a scene may not say, and what its message names.
#include <gtest/gtest.h>
#include <isolux/bake/scene_file.h>
#include <isolux/core/error.h>

#include <string>
#include <variant>

namespace isolux {
namespace {

std::string refusal(const std::string& text) {
  try {
    (void)parse_scene(text, "", "s.json");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(SceneFile, RefusesAKeyThatIsGivenTwice) {
  EXPECT_EQ(refusal(R"({"albedo":[1,0,0],"outer":"lower","albedo":[0,1,0]})"),
            "s.json: the key \"albedo\" is given twice");
  EXPECT_EQ(refusal(R"({"lights":[{"type":"sun","type":"sphere"}]})"), "s.json: the key \"type\" is given twice");
  // In objects of their own they are two keys.
  const char* suns = R"({"lights":[{"type":"sun","direction":[0,0,1],"irradiance":[1,1,1]},
                                   {"type":"sun","direction":[0,1,0],"irradiance":[1,1,1]}]})";
  EXPECT_EQ(parse_scene(suns, "", "s.json").lights.size(), 2u);
}

TEST(SceneFile, NamesWhatItCannotRead) {
  EXPECT_EQ(refusal(R"({"albedo":[1e400,0,0]})"), "s.json: a number is too large: at most 3.4e+38 is allowed");
  EXPECT_EQ(refusal("{\"environment\":{\"type\":\"image\",\"file\":\"a\\u0000b.png\"}}"),
            "s.json.environment.file: \"a\\u0000b.png\" is no file's name");
  EXPECT_EQ(refusal("{]"), "s.json: not JSON at byte 2");
}

// The library writes values for messages level by level on the stack, which a million of them overflow.
TEST(SceneFile, RefusesJsonOfAnyDepth) {
  constexpr std::size_t kLevels = 1000000;
  const std::string arrays = std::string(kLevels, '[') + std::string(kLevels, ']');
  EXPECT_EQ(refusal("{\"lights\":" + arrays + "}"),
            "s.json: objects and arrays within each other: at most 64 are allowed");
  std::string objects;
  for (std::size_t level = 0; level < kLevels; ++level) objects += "{\"type\":";
  EXPECT_EQ(refusal("{\"lights\":[" + objects + "1" + std::string(kLevels, '}') + "]}"),
            "s.json: objects and arrays within each other: at most 64 are allowed");
}

TEST(SceneFile, HoldsLampsOfAnySize) {
  const Scene scene = parse_scene(
      R"({"lights":[{"type":"rectangle","center":[0,0,0],"u":[1e-25,0,0],"v":[0,1e-25,0],"radiance":[1,1,1]}]})", "",
      "");
  EXPECT_TRUE(std::holds_alternative<RectangleLight>(scene.lights.at(0)));
  EXPECT_NE(refusal(R"({"lights":[{"type":"rectangle","center":[0,0,0],"u":[1,0,0],"v":[2,0,0],"radiance":[1,1,1]}]})")
                .find("u and v are parallel"),
            std::string::npos);
}

}  // namespace
}  // namespace isolux
