#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/resample.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "support.h"

namespace isolux {
namespace {

using testing::make_volume;
using testing::ramp_volume;
using testing::wavy_volume;

TEST(LightReader, ReadsAPlainGridTrilinearly) {
  const Volume volume = wavy_volume();
  IlluminationGrid light(cell_lattice(volume.lattice(), {5, 4, 3}), 3);
  for (std::size_t v = 0; v < light.values.size(); ++v) light.values[v] = float(v % 17);
  const LightReader reader(volume, light);
  for (const Vec3 p : {Vec3(0.0), Vec3(3.3, 4.4, 5.5), Vec3(11.0, 9.0, 8.0)}) {
    const Vec3 world = volume.lattice().frame.world(p);
    EXPECT_EQ(reader.at_world(world), light.at_world(world));
  }
}

TEST(LightReader, AddsSlopesTimesTheIsovaluesDifference) {
  const Volume volume = ramp_volume({5, 5, 5});
  IlluminationGrid light(cell_lattice(volume.lattice()), 1);
  for (float& v : light.values) v = 0.5f;
  light.detail.slopes.assign(light.values.size(), 0.1f);
  const LightReader reader(volume, light);
  const TrilinearField field(volume);
  // At a texel centre the difference is that from f there; the field is linear, so between them too.
  const Vec3 centre(1.5, 2.5, 0.5);
  EXPECT_NEAR(reader.at_index(centre).x, 0.5, 1e-6);  // float rounding of the offsets
  EXPECT_NEAR(reader.at_index(centre, field.value(centre) + 2.0).x, 0.7, 1e-6);
  EXPECT_NEAR(reader.at_index(Vec3(2.2, 2.7, 1.9)).x, 0.5, 1e-6);
}

TEST(LightReader, AddsNormalSlopesTimesTheNormalsDifference) {
  // Two ramps that meet at x = 5: normals (-1, 0, 0) and (0, -1, 0), world spacing aside.
  const Volume volume =
      make_volume({11, 7, 5}, {2.0, 1.0, 3.0}, [](const Vec3& p) { return p.x < 5.0 ? p.x : 5.0 + 0.5 * (p.y - 3.0); });
  IlluminationGrid light(cell_lattice(volume.lattice()), 3);
  for (float& v : light.values) v = 0.5f;
  for (std::size_t a = 0; a < 3; ++a) light.detail.normal_slopes[a].assign(light.values.size(), 0.1f * float(a + 1));
  const LightReader reader(volume, light);
  // Where all texels around have the point's own normal, the light is theirs.
  EXPECT_NEAR(reader.at_index({2.2, 3.0, 2.0}).x, 0.5, 1e-6);
  EXPECT_NEAR(reader.at_index({8.3, 3.4, 2.0}).x, 0.5, 1e-6);
  // At a texel's centre it is that texel's, whose own normal it has.
  EXPECT_NEAR(reader.at_index({5.5, 3.5, 1.5}).y, 0.5, 1e-6);
  // Between texels of different normals: here the gradient is that of x alone, as central differences are
  // interpolated, and half of the weight is that of texels with other normals.
  const TrilinearField field(volume);
  const Vec3 p(4.0, 3.5, 1.5);
  const auto normal = [&](const Vec3& at) {
    return field.normal(at, OuterSide::kLower, GradientKind::kCentralDifferences);
  };
  const Vec3 turned = normal(p) - 0.5 * (normal({3.5, 3.5, 1.5}) + normal({4.5, 3.5, 1.5}));
  ASSERT_GT(glm::length(turned), 0.01);
  EXPECT_NEAR(reader.at_index(p).x, 0.5 + glm::dot(turned, Vec3(0.1, 0.2, 0.3)), 1e-6);
}

TEST(LightReader, StaysBetweenBlackAndTheCeiling) {
  const Volume volume = ramp_volume({5, 5, 5});
  IlluminationGrid light(cell_lattice(volume.lattice()), 1);
  light.detail.slopes.assign(light.values.size(), 1.0f);
  light.detail.ceiling = 0.8f;
  const LightReader reader(volume, light);
  EXPECT_EQ(reader.at_index(Vec3(2.0), 100.0).x, 0.8f);
  EXPECT_EQ(reader.at_index(Vec3(2.0), -100.0).x, 0.0f);
}

TEST(LightReader, SeesAWallInFrontOfASurface) {
  // Two plates facing each other across a gap of a voxel or two, and the open outside of one of them.
  const Volume volume = make_volume({17, 5, 5}, Vec3(1.0), [](const Vec3& p) {
    return std::max(2.0 - std::fabs(p.x - 5.0), 2.0 - std::fabs(p.x - 8.0));
  });
  IlluminationGrid light(cell_lattice(volume.lattice()), 1);
  light.detail.near_field = {{.step = 2.0f, .mean = 0.0f, .weight = Vec3f(1.0f)}};
  const LightReader reader(volume, light);
  const float outside = reader.at_index({4.3, 2.0, 2.0}).x;
  const float between = reader.at_index({5.7, 2.0, 2.0}).x;
  EXPECT_NEAR(outside, 1.0, 1e-6);
  EXPECT_EQ(between, 0.0);
}

// What it has in another form takes no memory: slopes have arrays of their own, and in bricks all of them.
TEST(LightReader, HoldsNothingTwice) {
  const Volume volume = wavy_volume();
  IlluminationGrid light(cell_lattice(volume.lattice(), {24, 24, 24}), 1);
  light.detail.slopes.assign(light.values.size(), 0.1f);
  for (std::vector<float>& slopes : light.detail.normal_slopes) slopes.assign(light.values.size(), 0.1f);
  const ValueRange all = value_range(volume);
  light.detail.isovalues = ValueRange{.low = all.high - 1e-3f * (all.high - all.low), .high = all.high};
  const auto idle = [](const LightReader& reader) {
    const LightDetail& detail = reader.offsets().detail;
    return detail.slopes.capacity() + detail.normal_slopes[0].capacity() + detail.normal_slopes[1].capacity() +
           detail.normal_slopes[2].capacity();
  };
  const LightReader dense(volume, light);
  EXPECT_EQ(dense.offsets().values.size(), light.values.size());
  EXPECT_EQ(idle(dense), 0u);
  const LightReader bricks(volume, light, TexelStorage::kBricks);
  ASSERT_NE(bricks.bricks(), nullptr);
  EXPECT_EQ(bricks.offsets().values.capacity(), 0u);
  EXPECT_EQ(idle(bricks), 0u);
}

// What is lent is read as what is held, to the bit, at the box's faces and where an axis has one texel, too.
TEST(LightReader, ReadsWhatIsLentAlike) {
  const Volume volume = wavy_volume();
  RandomStream random(7, 0);
  const auto numbers = [&](std::size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = random.uniform_float();
    return values;
  };
  for (const Index3& size : {Index3(9, 7, 8), Index3(5, 1, 12)}) {
    for (const int terms : {1, 2, 5}) {
      for (const TexelLight own : {TexelLight::kReduced, TexelLight::kOwn}) {
        IlluminationGrid light(cell_lattice(volume.lattice(), size), terms == 2 ? 3 : 1);
        light.values = numbers(light.values.size());
        if (terms > 1) light.detail.slopes = numbers(light.values.size());
        for (std::vector<float>& slopes : light.detail.normal_slopes)
          if (terms > 2) slopes = numbers(light.values.size());
        light.detail.near_field = {{.step = 1.0f, .mean = 0.1f, .weight = Vec3f(0.2f)}};
        light.detail.texel_light = own;
        light.detail.isovalues = ValueRange{.low = -0.3f, .high = 0.4f};
        const LightReader held(volume, light);
        const LightReader lent(volume, light, TexelStorage::kLent);
        EXPECT_EQ(lent.offsets().values.empty(), own == TexelLight::kReduced);
        for (int n = 0; n < 300; ++n) {
          Vec3 p;
          for (int a = 0; a < 3; ++a) p[a] = (1.2 * random.uniform_double() - 0.1) * volume.lattice().size[a];
          EXPECT_EQ(lent.at_index(p), held.at_index(p));
          EXPECT_EQ(lent.at_index(p, 0.25), held.at_index(p, 0.25));
        }
      }
    }
  }
}

TEST(LightReader, RefusesSlopesOfAnotherGrid) {
  const Volume volume = ramp_volume({5, 5, 5});
  IlluminationGrid light(cell_lattice(volume.lattice()), 1);
  light.detail.slopes.assign(3, 1.0f);
  EXPECT_THROW(LightReader(volume, light), InvalidInput);
  light.detail.slopes.clear();
  light.detail.normal_slopes[0].assign(light.values.size(), 1.0f);  // and none along y and z
  EXPECT_THROW(LightReader(volume, light), InvalidInput);
}

}  // namespace
}  // namespace isolux
