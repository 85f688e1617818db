#include "gl/surface_renderer.h"

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "camera/framing.h"
#include "egl_context.h"
#include "gl_target.h"
#include "model/surface.h"

namespace isolux::viewer {
namespace {

// Pixels that a triangle covers in part have their middle beyond it, where there may be no brick. White on white: a
// pixel that looked there would be dark.
TEST(SurfaceRenderer, FindsTheBricksOfPixelsAtTheEdgesOfTriangles) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  const auto volume = std::make_shared<const ViewedVolume>(read_volume("gen:sphere:64"));
  IlluminationGrid light(cell_lattice(volume->lattice()), 1);
  std::fill(light.values.begin(), light.values.end(), 1.0f);
  light.detail.isovalues = ValueRange{.low = -0.4f, .high = -0.4f};
  SurfaceRenderer renderer(volume);
  renderer.set_surface(SurfaceMaker(volume, extractors(), {}).make({.isovalue = -0.4f}, {}, {}).mesh, -0.4f);
  renderer.set_light(light);
  ASSERT_LT(renderer.light_memory().light, renderer.light_memory().dense);
  SurfaceView view;
  view.camera = orbit_camera(volume->lattice(), 30.0, 20.0, 1.0);
  view.camera.half_height *= 8.0;  // far away: a pixel is some bricks wide
  view.lighting = Lighting::kGlobal;
  view.colour.albedo = Vec3f(1.0f);
  Target many(4);
  glClearColor(1.0f, 1.0f, 1.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_CULL_FACE);  // the inner side is dark, and may show along the outline
  renderer.draw(view);
  Target target;
  many.resolve(target);
  target.read();
  int covered = 0;
  int dark = 0;
  for (const auto& colour : target.colours) {
    if (colour[3] != 0) ++covered;
    if (colour[0] != 255) ++dark;
  }
  EXPECT_GT(covered, 100);
  // Mesa's rasterizer still looks beyond triangles that are seen edge-on.
  EXPECT_LE(dark, covered / 50);
}

TEST(SurfaceRenderer, ShowsTheHeadlightAndTheSkyWithoutLight) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  const auto volume = std::make_shared<const ViewedVolume>(read_volume("gen:sphere:32"));
  const Lattice& lattice = volume->lattice();
  SurfaceRenderer renderer(volume);
  renderer.set_surface(SurfaceMaker(volume, extractors(), {}).make({.isovalue = -0.4f}, {}, {}).mesh, -0.4f);
  SurfaceView view;
  view.camera = orbit_camera(lattice, 0.0, 0.0, 1.0);
  Target target;
  renderer.draw(view);
  target.read();
  // In the middle the ball faces the camera: .7 of headlight and .15 of a sky that is half in view.
  const auto& middle = target.colours[std::size_t(kSize / 2) * kSize + kSize / 2];
  EXPECT_NEAR(middle[0], srgb_code(0.8f * 0.85f), 2) << "the smoothed normal of a mesh of 32 cells";
  const auto brightness = [&](int y) { return int(target.colours[std::size_t(y) * kSize + kSize / 2][0]); };
  EXPECT_GT(brightness(kSize / 2 + 30), brightness(kSize / 2 - 30)) << "the sky is above";
}

// gen:sphere seen from the middle of its box: back faces all around.
TEST(SurfaceRenderer, ShowsTheInnerSideInItsOwnLight) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  const auto volume = std::make_shared<const ViewedVolume>(read_volume("gen:sphere:32"));
  const Lattice texels = cell_lattice(volume->lattice());
  const auto white = [&](float e) {
    IlluminationGrid light(texels, 1);
    light.values.assign(light.values.size(), e);
    return light;
  };
  SurfaceRenderer renderer(volume);
  renderer.set_surface(SurfaceMaker(volume, extractors(), {}).make({.isovalue = -0.3f}, {}, {}).mesh, -0.3f);
  const auto middle_from = [&](const Vec3& eye) {
    SurfaceView view;
    view.camera = Camera{.eye = eye};
    view.lighting = Lighting::kGlobal;
    Target target;
    renderer.draw(view);
    target.read();
    return int(target.colours[std::size_t(kSize / 2) * kSize + kSize / 2][0]);
  };
  const Vec3 within(0.5);
  const Vec3 outside(0.5, -1.5, 0.5);
  renderer.set_light(white(0.5f));
  const int dim = middle_from(within);
  EXPECT_LT(dim, srgb_code(0.8f * 0.1f) + 2) << "without light of its own the inner side is dim";
  const IlluminationGrid quarter = white(0.25f);
  renderer.set_light(white(0.5f), &quarter);
  EXPECT_NEAR(middle_from(within), srgb_code(0.8f * 0.25f), 1);
  EXPECT_NEAR(middle_from(outside), srgb_code(0.8f * 0.5f), 1);
  renderer.set_light(white(0.5f));
  EXPECT_EQ(middle_from(within), dim) << "another light's inner side is forgotten";
  renderer.set_light(white(0.5f), &quarter);
  const IlluminationGrid elsewhere(Lattice{.size = Index3(4), .frame = {.origin = Vec3(9.0), .axes = Mat3(1.0)}}, 2);
  EXPECT_THROW(renderer.set_light(elsewhere), Error);
  EXPECT_THROW(renderer.set_light(white(1.0f), &elsewhere), Error);
  EXPECT_NEAR(middle_from(within), srgb_code(0.8f * 0.25f), 1) << "what cannot be shown leaves what was";
  EXPECT_NEAR(middle_from(outside), srgb_code(0.8f * 0.5f), 1);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST(SurfaceRenderer, SaysThatTheVolumeIsTooLongForALightOfFewTexels) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  const Lattice lattice{.size = {largest_texture() + 1, 2, 2}, .frame = {}};
  Volume volume;
  volume.values = Grid<float>(lattice, std::vector<float>(lattice.count(), 0.0f));
  volume.values.values()[0] = 1.0f;
  SurfaceRenderer renderer(std::make_shared<const ViewedVolume>(std::move(volume)));
  IlluminationGrid light(cell_lattice(lattice, {8, 1, 1}), 1);
  renderer.set_light(light);
  light.detail.near_field = {{.step = 1.0f, .mean = 0.9f, .weight = Vec3f(0.1f)}};
  try {
    renderer.set_light(light);
    FAIL() << "it needs the volume's values";
  } catch (const InvalidInput& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("the volume's"), std::string::npos) << words;
    EXPECT_NE(words.find("resampler.near_field=false"), std::string::npos) << words;
    EXPECT_EQ(words.find("fewer texels"), std::string::npos) << words;
  }
}

TEST(SurfaceRenderer, DrawsNothingWhereThereIsNothing) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  SurfaceRenderer renderer(std::make_shared<const ViewedVolume>(read_volume("gen:sphere:4")));
  Target target;
  renderer.draw({});
  target.read();
  for (const auto& colour : target.colours) ASSERT_EQ(colour[3], 0);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

}  // namespace
}  // namespace isolux::viewer
