#include "support.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace isolux {
namespace {
using testing::HasSubstr;

TEST(Analytic, SamplesTheFormulasOfTheContract) {
  const Vec3 p(0.2, 0.7, 0.9);
  const auto value = [&](const char* name) { return analytic_field(name).value(p); };
  const double from_center = std::sqrt(0.09 + 0.04 + 0.16);
  // Each is a handful of double operations: 1e-12 is far above their rounding and far below any wrong formula.
  EXPECT_NEAR(value("sphere"), -from_center, 1e-12);
  EXPECT_NEAR(value("cavity"), from_center, 1e-12);
  EXPECT_NEAR(value("two-spheres"), -std::sqrt(0.01 + 0.04 + 0.16), 1e-12);
  EXPECT_NEAR(value("ball-over-plane"), -(from_center - 0.1), 1e-12);
  EXPECT_NEAR(value("torus"), -std::hypot(std::hypot(0.3, 0.2) - 0.28, 0.4), 1e-12);
  EXPECT_NEAR(analytic_field("gyroid").value(Vec3(0.125, 0.0, 0.0)), 1.0, 1e-12);
  // At the centre of Marschner and Lobb's signal: cos(2 pi 6) = 1, so (1 + .25 * 2) / 2.5.
  EXPECT_NEAR(analytic_field("marschner-lobb").value(Vec3(0.5)), 0.6, 1e-12);
  EXPECT_NEAR(analytic_field("hydrogen").value(Vec3(0.5, 0.5, 0.5 + 6.0 / 40.0)), 1.0, 1e-12);
}

TEST(Analytic, GradientsAreTheDerivatives) {
  for (const auto& field : analytic_fields()) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 p(std::fmod(0.017 + 0.618 * i, 1.0), std::fmod(0.29 + 0.755 * i, 1.0),
                   std::fmod(0.41 + 0.57 * i, 1.0));
      const double h = 1e-5;
      Vec3 difference(0.0);
      for (int a = 0; a < 3; ++a) {
        Vec3 step(0.0);
        step[a] = h;
        difference[a] = (field.value(p + step) - field.value(p - step)) / (2 * h);
      }
      const Vec3 gradient = field.gradient(p);
      // Central differences: h^2 times a third derivative of at most some 1e5 (the wiggles of Marschner and Lobb), and
      // 1e-16/h of rounding.
      EXPECT_LT(glm::distance(gradient, difference), 1e-4 * std::max(1.0, glm::length(gradient))) << field.name << i;
    }
  }
}

TEST(Analytic, SpansTheUnitCubeWithItsFirstAndLastPoint) {
  const Volume volume = read_volume("gen:sphere:9");
  const Lattice& lattice = volume.lattice();
  EXPECT_EQ(lattice.size, Index3(9));
  EXPECT_EQ(lattice.frame.world(Vec3(0)), Vec3(0));
  EXPECT_EQ(lattice.frame.world(Vec3(8)), Vec3(1));
  EXPECT_EQ(volume.values(4, 4, 4), 0.0f);
  EXPECT_EQ(volume.values(8, 8, 8), -float(std::sqrt(0.75)));
  EXPECT_EQ(read_volume("gen:gyroid").lattice().size, Index3(64));
}

TEST(Analytic, HydrogenIsADensityOfPeakOne) {
  const ValueRange range = value_range(read_volume("gen:hydrogen:81"));
  EXPECT_GE(range.low, 0.0f);
  // The peak lies on a grid point: index 40 +- 12 of 80 steps of half a Bohr radius.
  EXPECT_NEAR(range.high, 1.0f, 1e-6f);
}

TEST(Analytic, NoiseDependsOnSeedAndVoxelOnly) {
  isolux::Run one;
  one.threads = 1;
  isolux::Run four;
  four.threads = 4;
  const auto a = test::values_of(read_volume("gen:noise:33", {}, one));
  EXPECT_EQ(a, test::values_of(read_volume("gen:noise:33", {}, four)));
  four.seed = 2;
  EXPECT_NE(a, test::values_of(read_volume("gen:noise:33", {}, four)));
  double mean = 0.0;
  for (const float v : a) {
    ASSERT_GE(v, 0.0f);
    ASSERT_LT(v, 1.0f);
    mean += double(v) / double(a.size());
  }
  // Five standard errors of a mean of 33^3 uniform numbers.
  EXPECT_NEAR(mean, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / double(a.size())));
}

TEST(Analytic, RefusesOtherNamesAndSizes) {
  EXPECT_THAT(test::reading_error("gen:spere"), HasSubstr("did you mean 'sphere'"));
  EXPECT_THAT(test::reading_error("gen:"), HasSubstr("there are sphere, cavity"));
  for (const auto* size : {"1", "0", "-5", "2049", "99999999999", "8x", "", "8:8"})
    EXPECT_THAT(test::reading_error(std::string("gen:sphere:") + size), HasSubstr("2 to 2048")) << size;
}

}  // namespace
}  // namespace isolux
