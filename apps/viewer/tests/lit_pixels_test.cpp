// Pixels against the look-up on the processor.
#include "gl/surface_renderer.h"

#include <gtest/gtest.h>
#include <isolux/core/field.h>
#include <isolux/render/image.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "camera/framing.h"
#include "egl_context.h"
#include "gl_target.h"
#include "model/surface.h"

namespace isolux::viewer {
namespace {

/// A ball far from the world's origin, stretched and turned, so that a wrong frame shows; in lengths and values so many
/// times as large.
Volume far_ball(double length, float value) {
  Volume volume = read_volume("gen:sphere:32");
  Lattice lattice = volume.lattice();
  lattice.frame = {.origin = length * Vec3(4000.0, -700.0, 90.0),
                   .axes = length * Mat3({0.6, 0.8, 0.0}, {-1.6, 1.2, 0.0}, {0.0, 0.0, 3.0})};
  std::vector<float> values(volume.values.values().begin(), volume.values.values().end());
  for (float& v : values) v *= value;
  volume.values = Grid<float>(lattice, std::move(values));
  return volume;
}

IlluminationGrid varied_light(const Lattice& texels, int channels) {
  IlluminationGrid light(texels, channels);
  std::size_t at = 0;
  for (int k = 0; k < texels.size.z; ++k)
    for (int j = 0; j < texels.size.y; ++j)
      for (int i = 0; i < texels.size.x; ++i)
        for (int c = 0; c < channels; ++c)
          light.values[at++] = 0.5f + 0.4f * float(std::sin(0.5 * i + c) * std::cos(0.4 * j) * std::sin(0.3 * k + c));
  return light;
}

/// The light with slopes of both kinds and a near field that change it by some tenths.
IlluminationGrid detailed(IlluminationGrid light) {
  for (std::size_t i = 0; i < light.values.size(); ++i)
    light.detail.slopes.push_back(0.8f * float(std::cos(0.01 * double(i))));
  for (std::size_t a = 0; a < 3; ++a)
    light.detail.normal_slopes[a] = varied_light(light.lattice, light.channels).values;
  for (float& slope : light.detail.normal_slopes[1]) slope = 0.3f - slope;
  light.detail.near_field = {{.step = 1.0f, .mean = 0.9f, .weight = {0.3f, 0.2f, 0.1f}},
                             {.step = -4.0f, .mean = -0.5f, .weight = {-0.1f, 0.2f, 0.3f}}};
  light.detail.ceiling = 0.95f;
  return light;
}

/// The light that a pixel of a mesh should show: that of LightReader, but for the near field and what the normal adds,
/// which are LightReader's at the vertices and linear between them.
class ExpectedLight {
 public:
  ExpectedLight(const Volume& volume, const IlluminationGrid& light, const IndexedMesh& mesh, float isovalue,
                float brightness)
      : frame_(volume.lattice().frame),
        mesh_(mesh),
        isovalue_(double(isovalue)),
        lift_(4.0f * brightness),
        high_(100.0f * brightness),
        ceiling_(light.detail.near_field.empty() ? high_ : light.detail.ceiling),
        texels_(volume, without_normals(volume, unclamped(light, true))) {
    if (light.detail.near_field.empty()) return;
    const LightReader whole(volume, unclamped(light, false));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 index = frame_.index(position(v));
      near_field_.push_back(whole.at_index(index, isovalue_) - texels_.at_index(index, isovalue_));
    }
  }

  /// At a point of the mesh, world space.
  [[nodiscard]] Vec3f at(const Vec3& world) const {
    const Vec3f e = texels_.at_index(frame_.index(world), isovalue_) - lift_;
    return glm::clamp(near_field_.empty() ? e : e + near_field_at(world), Vec3f(0.0f), Vec3f(ceiling_));
  }

 private:
  [[nodiscard]] IlluminationGrid unclamped(IlluminationGrid light, bool texels_alone) const {
    for (float& v : light.values) v += lift_;
    light.detail.ceiling = high_;
    if (texels_alone) light.detail.near_field.clear();
    return light;
  }
  /// Texels' light from which what their own normals add is taken.
  static IlluminationGrid without_normals(const Volume& volume, IlluminationGrid light) {
    if (light.detail.normal_slopes[0].empty()) return light;
    const TrilinearField field(volume);
    const Index3 n = light.lattice.size;
    std::size_t v = 0;
    for (int k = 0; k < n.z; ++k)
      for (int j = 0; j < n.y; ++j)
        for (int i = 0; i < n.x; ++i) {
          const Vec3 centre = volume.lattice().frame.index(light.lattice.frame.world({i, j, k}));
          const Vec3 normal = field.normal(centre, OuterSide::kLower, GradientKind::kCentralDifferences);
          for (int c = 0; c < light.channels; ++c, ++v)
            for (std::size_t a = 0; a < 3; ++a)
              light.values[v] -= light.detail.normal_slopes[a][v] * float(normal[int(a)]);
        }
    light.detail.normal_slopes = {};
    return light;
  }
  [[nodiscard]] Vec3 position(std::size_t v) const { return Vec3(mesh_.positions[v]); }

  /// Of the triangle that the point lies on, which is the one least far off among those that it lies above.
  [[nodiscard]] Vec3f near_field_at(const Vec3& world) const {
    Vec3f found(0.0f);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& triangle : mesh_.triangles) {
      const Vec3 a = position(triangle[0]);
      const Vec3 b = position(triangle[1]) - a;
      const Vec3 c = position(triangle[2]) - a;
      const Vec3 p = world - a;
      const Vec3 n = glm::cross(b, c);
      const double square = glm::dot(n, n);
      const double u = glm::dot(glm::cross(p, c), n) / square;
      const double v = glm::dot(glm::cross(b, p), n) / square;
      const double off = std::fabs(glm::dot(p, n)) / std::sqrt(square);
      if (std::min({u, v, 1.0 - u - v}) < -0.01 || off >= least) continue;
      least = off;
      found = float(1.0 - u - v) * near_field_[triangle[0]] + float(u) * near_field_[triangle[1]] +
              float(v) * near_field_[triangle[2]];
    }
    return found;
  }

  IndexToWorld frame_;
  const IndexedMesh& mesh_;
  double isovalue_;
  float lift_;  ///< so that nothing is clamped at 0
  float high_;
  float ceiling_;
  LightReader texels_;
  std::vector<Vec3f> near_field_;  ///< at the vertices
};

void make_brighter(IlluminationGrid& light, float factor) {
  const auto times = [&](std::vector<float>& values) {
    for (float& v : values) v *= factor;
  };
  times(light.values);
  times(light.detail.slopes);
  for (auto& slopes : light.detail.normal_slopes) times(slopes);
  for (NearFieldTerm& term : light.detail.near_field) term.weight *= factor;
  light.detail.ceiling *= factor;
}

/// Part of a test's name: "_length_e17" for 1e17.
std::string scaled(const std::string& what, double factor) {
  const int exponent = int(std::lround(std::log10(factor)));
  return exponent == 0 ? "" : what + (exponent < 0 ? "_em" : "_e") + std::to_string(std::abs(exponent));
}

struct LightKind {
  bool at_voxels = false;
  int channels = 1;
  bool detail = false;
  bool bricks = false;
  bool own = false;  ///< TexelLight::kOwn
  // Times which lengths, values and light are as large: floats hold their squares no more.
  double length = 1.0;
  float value = 1.0f;
  float light = 1.0f;
};

class LitPixels : public testing::TestWithParam<LightKind> {};

// What the graphics card shows at a pixel is the light that the processor looks up at the point under it.
TEST_P(LitPixels, AgreeWithTheLookUpOnTheProcessor) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  const auto [at_voxels, channels, detail, bricks, own, length, value, brightness] = GetParam();
  const auto volume = std::make_shared<const ViewedVolume>(far_ball(length, value));
  const Lattice& lattice = volume->lattice();
  const Index3 cells = bricks ? Index3(62, 53, 49) : Index3(17, 31, 9);
  IlluminationGrid light = varied_light(at_voxels ? voxel_lattice(lattice) : cell_lattice(lattice, cells), channels);
  if (detail) light = detailed(std::move(light));
  for (float& slope : light.detail.slopes) slope /= value;
  if (bricks) light.detail.isovalues = ValueRange{.low = -0.405f * value, .high = -0.395f * value};
  make_brighter(light, brightness);
  const float isovalue = -0.4f * value;
  const Surface surface = SurfaceMaker(volume, extractors(), {}).make({.isovalue = isovalue}, {}, {});
  // Texels' own light shows as what a reader makes of it.
  if (own) {
    light.detail.texel_light = TexelLight::kOwn;
    light.detail.slopes.clear();
    light.detail.normal_slopes = {};
  }
  const ExpectedLight expected(volume->floats(), own ? LightReader(volume->floats(), light).offsets() : light,
                               surface.mesh, isovalue, brightness);

  SurfaceRenderer renderer(volume);
  renderer.set_surface(surface.mesh, isovalue);
  renderer.set_light(light);
  EXPECT_EQ(renderer.light_memory().light < renderer.light_memory().dense, bricks);
  SurfaceView view;
  view.camera = orbit_camera(lattice, 30.0, 20.0, 1.0);
  view.lighting = Lighting::kGlobal;
  view.colour = {.albedo = {0.9f, 0.8f, 0.6f}, .emission = brightness * Vec3f(0.0f, 0.05f, 0.1f)};
  view.exposure = 1.1f / brightness;
  Target target;
  renderer.draw(view);
  target.read();

  const Vec3 centre(Vec3f(box_middle(lattice)));
  const glm::dmat4 from_clip = glm::inverse(clip_from_centred(view.camera, centre, box_radius(lattice), 1.0));
  int compared = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::size_t at = std::size_t(y) * kSize + std::size_t(x);
      if (target.colours[at][3] == 0) continue;
      const glm::dvec4 clip(2.0 * (x + 0.5) / kSize - 1.0, 2.0 * (y + 0.5) / kSize - 1.0,
                            2.0 * double(target.depths[at]) - 1.0, 1.0);
      const glm::dvec4 centred = from_clip * clip;
      const Vec3 world = centre + Vec3(centred) / centred.w;
      const Vec3f shown = view.exposure * view.colour.shown(expected.at(world));
      for (int c = 0; c < 3; ++c) {
        // One code for the texture's float16 and 8-bit filter weights, one for rounding.
        ASSERT_LE(std::abs(int(target.colours[at][std::size_t(c)]) - int(srgb_code(shown[c]))), 2)
            << "pixel " << x << "," << y << " channel " << c;
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, kSize * kSize / 20);
}

// Lengths are powers of two: they leave the mesh its bits.
INSTANTIATE_TEST_SUITE_P(
    BothLattices, LitPixels,
    testing::Values(LightKind{false, 1, false}, LightKind{false, 3, false}, LightKind{true, 1, false},
                    LightKind{true, 3, false}, LightKind{false, 1, true}, LightKind{false, 3, true},
                    LightKind{true, 3, true}, LightKind{false, 1, false, true}, LightKind{false, 1, true, true},
                    LightKind{false, 3, true, true}, LightKind{false, 3, false, true},
                    LightKind{false, 1, true, false, true}, LightKind{false, 3, true, true, true},
                    LightKind{.detail = true, .length = 0x1p57}, LightKind{.detail = true, .length = 0x1p-80},
                    LightKind{.detail = true, .value = 1e20f}, LightKind{.detail = true, .value = 1e-24f},
                    LightKind{.detail = true, .bricks = true, .light = 1e-9f},
                    LightKind{.detail = true, .light = 1e9f}),
    [](const auto& tested) {
      return std::string(tested.param.at_voxels ? "voxels_" : "cells_") + std::to_string(tested.param.channels) +
             (tested.param.detail ? "_detailed" : "") + (tested.param.bricks ? "_bricks" : "") +
             (tested.param.own ? "_own" : "") + scaled("_length", tested.param.length) +
             scaled("_value", double(tested.param.value)) + scaled("_light", double(tested.param.light));
    });

}  // namespace
}  // namespace isolux::viewer
