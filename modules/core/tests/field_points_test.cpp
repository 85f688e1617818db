#include <gtest/gtest.h>
#include <isolux/core/field_points.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "wide_targets.h"

namespace isolux {
namespace {

Volume noisy_volume(const Index3& size) {
  Lattice lattice;
  lattice.size = size;
  Volume volume;
  volume.values = Grid<float>(lattice);
  RandomStream random(3, 0);
  for (float& value : volume.values.values()) value = float(2.0 * random.uniform_double() - 0.7);
  return volume;
}

/// Points inside cells, on faces, edges and grid points, on the box and beyond it.
Points points_everywhere(const Index3& size) {
  Points points;
  RandomStream random(5, 0);
  for (int n = 0; n < 1003; ++n) {  // not a whole number of vectors
    Vec3 p;
    for (int a = 0; a < 3; ++a) {
      p[a] = (1.2 * random.uniform_double() - 0.1) * (size[a] - 1);
      if (random.uniform_double() < 0.3) p[a] = std::round(p[a]);
    }
    points.push_back(p);
  }
  points.push_back(Vec3(0.0));
  points.push_back(Vec3(size - 1));
  return points;
}

void expect_what_the_field_says(const Index3& size) {
  const Volume volume = noisy_volume(size);
  const TrilinearField field(volume);
  const Points points = points_everywhere(size);
  PointSamples samples;
  sample_field(field, points, samples);
  std::vector<double> values;
  sample_values(field, points, values);
  ASSERT_EQ(values.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points.at(i);
    EXPECT_EQ(values[i], field.value(p));
    EXPECT_EQ(samples.values[i], field.value(p));
    EXPECT_EQ(samples.gradient(i), field.smooth_gradient(p)) << p.x << " " << p.y << " " << p.z;
    EXPECT_EQ(samples.least[i], field.corner_range(p).low);
    EXPECT_EQ(samples.largest[i], field.corner_range(p).high);
  }
}

TEST(FieldPoints, SayWhatTheFieldSaysOfEachPointToTheBit) {
  test::on_every_target([] {
    for (const Index3& size : {Index3(13, 9, 11), Index3(2, 2, 2), Index3(5, 2, 7), Index3(3, 4, 3)})
      expect_what_the_field_says(size);
  });
}

TEST(FieldPoints, OfNoPointsAreNone) {
  const Volume volume = noisy_volume({3, 3, 3});
  PointSamples samples;
  samples.resize(7);
  sample_field(TrilinearField(volume), {}, samples);
  EXPECT_TRUE(samples.values.empty());
}

}  // namespace
}  // namespace isolux
