#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/illumination_grid.h>
#include <isolux/core/random.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace isolux {
namespace {

/// A volume whose frame is rotated, anisotropic and far from the origin.
Volume make_volume(Index3 size, const std::function<double(Vec3)>& f_of_index) {
  Lattice lattice;
  lattice.size = size;
  lattice.frame.origin = {10.0, -20.0, 5.0};
  lattice.frame.axes = Mat3(Vec3(0.0, 0.5, 0.0), Vec3(-0.75, 0.0, 0.0), Vec3(0.0, 0.0, 2.0));
  Volume volume;
  volume.values = Grid<float>(lattice);
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) volume.values(i, j, k) = float(f_of_index(Vec3(i, j, k)));
    }
  }
  return volume;
}

Vec3 random_point(RandomStream& random, Index3 size) {
  return {random.uniform_double() * (size.x - 1), random.uniform_double() * (size.y - 1),
          random.uniform_double() * (size.z - 1)};
}

TEST(TrilinearField, ReproducesTrilinearFunctionsAndTheirGradients) {
  const Index3 size(5, 4, 6);
  const auto f = [](Vec3 p) { return 2.0 + 3.0 * p.x - p.y + 0.5 * p.z + p.x * p.y - 0.25 * p.x * p.y * p.z; };
  const auto g = [](Vec3 p) {
    return Vec3(3.0 + p.y - 0.25 * p.y * p.z, -1.0 + p.x - 0.25 * p.x * p.z, 0.5 - 0.25 * p.x * p.y);
  };
  const Volume volume = make_volume(size, f);
  const TrilinearField field(volume);
  RandomStream random(1, 0);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random_point(random, size);
    // The voxels are floats of up to 60: their rounding is 4e-6.
    EXPECT_NEAR(field.value(p), f(p), 1e-5);
    EXPECT_LT(glm::length(field.cell_gradient(p) - g(p)), 3e-5);
    // f is linear along each axis, so central and one-sided differences are its derivative.
    EXPECT_LT(glm::length(field.smooth_gradient(p) - g(p)), 3e-5);
  }
}

TEST(TrilinearField, GivesTheWorldGradientOfALinearFunction) {
  // f = a . world + b
  const Vec3 a(1.5, -2.0, 0.25);
  const Volume frame = make_volume({4, 4, 4}, [](Vec3) { return 0.0; });
  const Volume volume = make_volume({4, 4, 4}, [&](Vec3 p) { return glm::dot(a, frame.lattice().frame.world(p)); });
  const TrilinearField field(volume);
  for (const auto kind : {GradientKind::kCell, GradientKind::kCentralDifferences}) {
    EXPECT_LT(glm::length(field.world_gradient({1.3, 2.1, 0.4}, kind) - a), 1e-4);  // voxels of 50 rounded to float
    EXPECT_LT(glm::length(field.normal({1.3, 2.1, 0.4}, OuterSide::kLower, kind) + glm::normalize(a)), 1e-4);
    EXPECT_LT(glm::length(field.normal({1.3, 2.1, 0.4}, OuterSide::kHigher, kind) - glm::normalize(a)), 1e-4);
  }
}

TEST(TrilinearField, HasNoNormalWhereTheDataAreFlat) {
  const Volume volume = make_volume({3, 3, 3}, [](Vec3) { return 1e6; });
  EXPECT_EQ(TrilinearField(volume).normal({1.2, 0.3, 1.9}, OuterSide::kLower, GradientKind::kCentralDifferences),
            Vec3(0.0));
}

TEST(TrilinearField, KeepsNormalsOfTinyAndHugeValues) {
  for (const double scale : {1e-30, 1e30}) {
    const Volume volume = make_volume({3, 3, 3}, [&](Vec3 p) { return scale * (p.x - 1.0); });
    const Vec3 n = TrilinearField(volume).normal({1.2, 0.3, 1.9}, OuterSide::kLower, GradientKind::kCell);
    EXPECT_LT(glm::length(n - Vec3(0.0, -1.0, 0.0)), 1e-6) << scale;  // index x is world y
  }
}

TEST(Lattice, CellTexelsLieAtTheCellCentres) {
  const Volume volume = make_volume({5, 4, 6}, [](Vec3) { return 0.0; });
  const Lattice texels = cell_lattice(volume.lattice());
  EXPECT_EQ(texels.size, Index3(4, 3, 5));
  EXPECT_LT(glm::length(texels.frame.world({1, 2, 3}) - volume.lattice().frame.world({1.5, 2.5, 3.5})), 1e-12);
  // Any other number of texels spreads over the same box: texel i of N at (i + .5)/N.
  const Lattice more = cell_lattice(volume.lattice(), {7, 1, 10});
  EXPECT_LT(glm::length(more.frame.world({3, 0, 2}) - volume.lattice().frame.world({0.5 * 4, 0.5 * 3, 0.25 * 5})),
            1e-12);
  EXPECT_THROW(static_cast<void>(cell_lattice(volume.lattice(), {0, 1, 1})), InvalidInput);
}

TEST(Lattice, IndexUndoesWorld) {
  const Volume volume = make_volume({5, 4, 6}, [](Vec3) { return 0.0; });
  const Vec3 p(1.25, 2.5, 3.75);
  EXPECT_LT(glm::length(volume.lattice().frame.index(volume.lattice().frame.world(p)) - p), 1e-13);
}

TEST(Lattice, FindsPointsButForTheRoundingOfFloats) {
  const Lattice lattice{.size = {5, 4, 6}, .frame = {}};
  EXPECT_EQ(point_at(lattice, {4.009, 2.991, 0.0}), lattice.offset(4, 3, 0));
  EXPECT_EQ(point_at(lattice, {-0.009, 0.0, 5.009}), lattice.offset(0, 0, 5));
  for (const Vec3 none : {Vec3(4.02, 3.0, 0.0), Vec3(0.5), Vec3(5.0, 0.0, 0.0), Vec3(0.0, -1.0, 0.0),
                          Vec3(0.0, 0.0, 1e300), Vec3(std::nan(""), 0.0, 0.0)})
    EXPECT_FALSE(point_at(lattice, none)) << none.x << " " << none.y << " " << none.z;
}

TEST(IlluminationGrid, ReproducesARampInsideAndClampsOutside) {
  const Volume volume = make_volume({5, 4, 6}, [](Vec3) { return 0.0; });
  for (const int channels : {1, 3}) {
    IlluminationGrid light(cell_lattice(volume.lattice()), channels);
    for (int k = 0; k < 5; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) {
          for (int c = 0; c < channels; ++c) {
            light.values[light.lattice.offset(i, j, k) * std::size_t(channels) + std::size_t(c)] =
                float(i + 2 * j + 4 * k + 100 * c);
          }
        }
      }
    }
    const Vec3f e = light.at_world(volume.lattice().frame.world({2.0, 1.25, 3.5}));  // texel index (1.5, .75, 3)
    EXPECT_NEAR(e.x, 1.5 + 2 * 0.75 + 4 * 3.0, 1e-4);
    EXPECT_NEAR(e.z - e.x, channels == 3 ? 200 : 0, 1e-4);
    EXPECT_NEAR(light.at_index({-5.0, 0.0, 0.0}).x, 0.0, 0.0);
    EXPECT_NEAR(light.at_index({99.0, 99.0, 99.0}).x, 3 + 2 * 2 + 4 * 4, 0.0);
  }
}

TEST(ValueRange, FindsBothEndsWhereverTheyAre) {
  // From fewer voxels than a vector takes at once to several vectors and a rest.
  for (const Index3 size : {Index3(2, 2, 2), Index3(5, 4, 3), Index3(7, 5, 3)}) {
    const Volume flat = make_volume(size, [](Vec3) { return 1.0; });
    for (std::size_t at = 0; at < flat.values.values().size(); ++at) {
      Volume volume = flat;
      volume.values.values()[at] = 7.0f;
      EXPECT_EQ(value_range(volume).low, 1.0f);
      EXPECT_EQ(value_range(volume).high, 7.0f) << at;
      volume.values.values()[at] = -7.0f;
      EXPECT_EQ(value_range(volume).low, -7.0f) << at;
      EXPECT_EQ(value_range(volume).high, 1.0f);
    }
  }
}

TEST(RequireUsable, NamesTheFirstVoxelThatIsNotFinite) {
  Volume volume = make_volume({3, 3, 3}, [](Vec3) { return 1.0; });
  EXPECT_NO_THROW(require_usable(volume));
  volume.values(2, 1, 0) = std::numeric_limits<float>::quiet_NaN();
  volume.values(0, 0, 2) = std::numeric_limits<float>::infinity();
  volume.name = "some.nrrd";
  try {
    require_usable(volume);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(std::string(error.what()), "some.nrrd: 2 of 27 voxels are not finite numbers, the first (nan) at 2,1,0");
  }
  EXPECT_THROW(require_usable(make_volume({3, 1, 3}, [](Vec3) { return 1.0; })), InvalidInput);
}

}  // namespace
}  // namespace isolux
