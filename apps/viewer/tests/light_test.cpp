// Light of the document: which side it is of, exact light, drafts, and surfaces saved with it.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "model/document.h"
#include "model/surface.h"

namespace isolux::viewer {
namespace {

TEST(ExactLight, IsOneOnAConvexSurfaceWithAndWithoutABakedLight) {
  Document document = make_document(read_stored_volume("gen:sphere:16"));
  const std::vector<Vec3f> positions{{0.5f, 0.5f, 0.8f}, {0.3f, 0.5f, 0.5f}};
  Scene dim;
  dim.environment = UniformEnvironment{.radiance = Vec3f(0.5f)};
  const Stages stages = builtin_stages();
  const Lighted lighted{.scene = dim};
  for (const Vec3f& e : trace_surface(document, lighted, -0.3f, positions, stages, {}).radiance)
    EXPECT_EQ(e, Vec3f(0.5f));
  document.light =
      known_light(std::make_shared<const LightFile>(bake_draft(document.volume->floats(), Scene{}, {}, stages, {})));
  for (const Vec3f& e : trace_surface(document, lighted, -0.3f, positions, stages, {}).radiance) {
    EXPECT_NEAR(e.x, 1.0f, 1e-6f) << "the light's own scene counts";
  }
}

/// A light of gen:sphere:16 that says its scene, e everywhere the same on a side.
KnownLight even_light(OuterSide outer, std::optional<float> inner_e) {
  auto file = std::make_shared<LightFile>();
  file->grid = IlluminationGrid(cell_lattice(read_volume("gen:sphere:16").lattice()), 1);
  std::fill(file->grid.values.begin(), file->grid.values.end(), 0.75f);
  if (inner_e) {
    file->inner = file->grid;
    std::fill(file->inner->values.begin(), file->inner->values.end(), *inner_e);
  }
  file->metadata["isolux.scene"] = outer == OuterSide::kLower ? R"({"outer":"lower"})" : R"({"outer":"higher"})";
  return known_light(std::move(file));
}

TEST(OuterSide, IsWhatIsAskedForElseTheLightsElseTheScenes) {
  Document document = make_document(read_stored_volume("gen:sphere:16"));
  Scene scene;
  scene.outer = OuterSide::kHigher;
  EXPECT_EQ(outer_side(document, scene, {}), OuterSide::kHigher);
  EXPECT_EQ(outer_side(document, scene, OuterSide::kLower), OuterSide::kLower);
  document.light = even_light(OuterSide::kLower, {});
  EXPECT_EQ(outer_side(document, scene, {}), OuterSide::kLower);
  EXPECT_EQ(outer_side(document, scene, OuterSide::kHigher), OuterSide::kHigher);
}

TEST(OuterSide, ChoosesTheLight) {
  const KnownLight both = even_light(OuterSide::kLower, 0.25f);
  EXPECT_EQ(grid_of(*both.file, OuterSide::kLower), &both.file->grid);
  EXPECT_EQ(grid_of(*both.file, OuterSide::kHigher), &*both.file->inner);
  EXPECT_EQ(&shown_grid(*both.file, OuterSide::kHigher), &*both.file->inner);
  const KnownLight one = even_light(OuterSide::kHigher, {});
  EXPECT_EQ(grid_of(*one.file, OuterSide::kLower), nullptr);
  EXPECT_EQ(&shown_grid(*one.file, OuterSide::kHigher), &one.file->grid);
  EXPECT_THROW(static_cast<void>(shown_grid(*one.file, OuterSide::kLower)), InvalidInput) << "it is of the other side";
}

TEST(ExactLight, IsOfTheWindowsOuterSide) {
  Document document = make_document(read_stored_volume("gen:sphere:16"));
  const std::vector<Vec3f> positions{{0.5f, 0.5f, 0.8f}, {0.3f, 0.5f, 0.5f}};
  const Stages stages = builtin_stages();
  // Nothing shines into a closed ball.
  const auto traced = [&](OuterSide outer) {
    return trace_surface(document, {.scene = {}, .outer = outer}, -0.3f, positions, stages, {}).radiance;
  };
  for (const std::optional<float> inner : {std::optional<float>(), std::optional(0.0f)}) {
    for (const Vec3f& e : traced(OuterSide::kLower)) EXPECT_NEAR(e.x, 1.0f, 1e-6f);
    for (const Vec3f& e : traced(OuterSide::kHigher)) EXPECT_EQ(e.x, 0.0f);
    document.light = even_light(OuterSide::kLower, inner);
  }
  // A light of the other side says nothing of this one.
  document.light = even_light(OuterSide::kLower, {});
  for (const Vec3f& e : traced(OuterSide::kHigher)) EXPECT_EQ(e.x, 0.0f);
}

TEST(ExactLight, TakesNothingFromALightOfOtherIsovaluesOrTheOtherSide) {
  Document document = make_document(read_stored_volume("gen:gyroid:16"));
  const Stages stages = builtin_stages();
  constexpr float kIsovalue = 0.3f;
  const Surface surface = SurfaceMaker(document.volume, stages.extractors, {}).make({.isovalue = kIsovalue}, {}, {});
  const auto traced = [&](OuterSide outer) {
    return trace_surface(document, {.scene = {}, .outer = outer}, kIsovalue, surface.mesh.positions, stages, {})
        .radiance;
  };
  const std::vector<Vec3f> lower = traced(OuterSide::kLower);
  const std::vector<Vec3f> higher = traced(OuterSide::kHigher);
  LightFile file = *even_light(OuterSide::kLower, {}).file;
  document.light = known_light(std::make_shared<const LightFile>(file));
  EXPECT_NE(traced(OuterSide::kLower), lower) << "a light of this side and of all isovalues guides the rays";
  EXPECT_EQ(traced(OuterSide::kHigher), higher);
  file.grid.detail.isovalues = ValueRange{.low = -0.2f, .high = -0.1f};
  document.light = known_light(std::make_shared<const LightFile>(file));
  EXPECT_EQ(traced(OuterSide::kLower), lower);
}

TEST(Draft, HasAtMostSoManyTexelsInTheVolumesProportions) {
  EXPECT_EQ(draft_texels({65, 33, 17}, {.texels = 1e6}), Index3(64, 32, 16)) << "one a cell where they are few";
  const Index3 large = draft_texels({513, 513, 257}, {.texels = 1e6});
  EXPECT_LE(double(large.x) * large.y * large.z, 1e6);
  EXPECT_GT(double(large.x) * large.y * large.z, 0.9e6);
  EXPECT_NEAR(double(large.x) / large.z, 2.0, 0.03) << "whole texels";
  EXPECT_EQ(draft_texels({1000001, 2, 2}, {.texels = 1e3, .texels_an_axis = 1 << 20}), Index3(1000000 / 10, 1, 1))
      << "a factor of ten an axis";
  EXPECT_EQ(draft_texels({3000, 10, 10}, {.texels_an_axis = 2048}), Index3(2048, 9, 9));
}

TEST(Draft, KeepsToTheLargestTexture) {
  const Lattice lattice{.size = {40, 4, 4}, .frame = {}};
  std::vector<float> values(lattice.count());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = float((i * 37) % 101);
  Volume volume;
  volume.values = Grid<float>(lattice, std::move(values));
  const LightFile near_field = bake_draft(volume, {}, {.texels_an_axis = 40}, builtin_stages(), {});
  EXPECT_EQ(near_field.grid.lattice.size.x, 39);
  EXPECT_FALSE(near_field.grid.detail.near_field.empty());
  const LightFile plain = bake_draft(volume, {}, {.texels_an_axis = 20}, builtin_stages(), {});
  EXPECT_EQ(plain.grid.lattice.size.x, 20);
  EXPECT_TRUE(plain.grid.detail.near_field.empty()) << "the volume itself has no texture either";
}

/// The colours of a binary PLY's vertices, behind 6 floats each.
class SavedSurface : public testing::Test {
 protected:
  void SetUp() override { path_ = (std::filesystem::temp_directory_path() / "isolux-saved-surface.ply").string(); }
  void TearDown() override { std::filesystem::remove(path_); }

  std::vector<std::array<std::uint8_t, 3>> saved(const VertexLight& light, const BackendChoice& extractor = {}) {
    export_surface(document_, scene_, light, stages_, extractor, settings_, {}, path_);
    std::ifstream file(path_, std::ios::binary);
    std::string line;
    std::size_t vertices = 0;
    bool coloured = false;
    while (std::getline(file, line) && line != "end_header") {
      if (line.rfind("element vertex ", 0) == 0) vertices = std::stoul(line.substr(15));
      coloured = coloured || line == "property uchar red";
    }
    std::vector<std::array<std::uint8_t, 3>> colours(coloured ? vertices : 0);
    std::array<char, 27> record{};
    for (auto& colour : colours) {
      file.read(record.data(), std::streamsize(record.size()));
      for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<std::uint8_t>(record[24 + c]);
    }
    return colours;
  }

  std::string path_;
  Stages stages_ = builtin_stages();
  Scene scene_;
  Document document_ = make_document(read_stored_volume("gen:sphere:16"));
  ExtractSettings settings_{.isovalue = -0.3f, .outer = OuterSide::kLower, .normals = NormalKind::kGradient};
};

TEST_F(SavedSurface, HasTheColoursOfExactLightAsShown) {
  scene_.albedo.keys = {{0.0f, {0.9f, 0.05f, 0.05f}}};
  scene_.emission.keys = {{0.0f, {0.0f, 0.3f, 0.0f}}};
  for (const BackendInfo& info : stages_.extractors.backends()) {
    const BackendChoice extractor{.name = info.name, .settings = {}};
    Surface shown = SurfaceMaker(document_.volume, stages_.extractors, extractor).make(settings_, {}, {});
    std::vector<Vec3f> radiance;
    for (std::size_t v = 0; v < shown.mesh.positions.size(); ++v) radiance.emplace_back(float(v % 7) / 7.0f);
    const VertexLight light{
        .source = VertexLight::Source::kExact, .positions = shown.mesh.positions, .radiance = radiance};
    const auto colours = saved(light, extractor);
    ASSERT_EQ(colours.size(), radiance.size()) << info.name;
    for (std::size_t v = 0; v < colours.size(); ++v) {
      const Vec3f expected = Vec3f(0.9f, 0.05f, 0.05f) * radiance[v] + Vec3f(0.0f, 0.3f, 0.0f);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(colours[v][std::size_t(c)], srgb_code(expected[c])) << info.name << v;
    }
    shown.mesh.positions[0].x += 0.01f;
    EXPECT_THROW(saved(light, extractor), InvalidInput) << "of another mesh";
  }
}

TEST_F(SavedSurface, HasTheLightOfTheOuterSide) {
  document_.light = even_light(OuterSide::kLower, 0.25f);
  for (const auto& [outer, e] : {std::pair{OuterSide::kLower, 0.75f}, std::pair{OuterSide::kHigher, 0.25f}}) {
    settings_.outer = outer;
    const auto colours = saved({.source = VertexLight::Source::kBaked, .positions = {}, .radiance = {}});
    ASSERT_FALSE(colours.empty());
    for (const auto& colour : colours) ASSERT_EQ(colour[0], srgb_code(0.8f * e));
  }
  EXPECT_TRUE(saved({}).empty());
  document_.light = even_light(OuterSide::kLower, {});
  EXPECT_THROW(saved({.source = VertexLight::Source::kBaked, .positions = {}, .radiance = {}}), InvalidInput)
      << "of the other side alone";
}

}  // namespace
}  // namespace isolux::viewer
