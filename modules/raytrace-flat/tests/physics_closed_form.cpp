// The exact answers of docs/theory.md that hold for whole families of level sets.
#include <gtest/gtest.h>

#include "physics_support.h"

namespace isolux::test {
namespace {

constexpr int kGrid = 64;

/// Radii of the open integrating sphere: one site at a random place of each of 60 level sets.
Sites open_sphere_sites(const Volume& volume) {
  std::vector<Vec3> positions;
  RandomStream random(3, 4);
  for (int i = 0; i < 60; ++i) {
    const double radius = 0.52 + 0.16 * (i + 0.5) / 60.0;
    Vec3 p(-1.0);
    while (std::min({p.x, p.y, p.z}) < 0.0 || std::max({p.x, p.y, p.z}) > 1.0)
      p = Vec3(kCenter) + radius * random_direction(random);
    positions.push_back(p);
  }
  return sites_at(volume, positions, OuterSide::kLower);
}

double open_fraction(double radius) { return 3.0 * (1.0 - 0.5 / radius); }

TEST(OpenIntegratingSphere, AllBouncesMatchAndTheErrorFallsWithTheRays) {
  const Volume volume = cavity(kGrid);
  const Sites sites = open_sphere_sites(volume);
  for (const float albedo : {0.5f, 0.8f}) {
    const auto rms = [&](int rays) {
      const TraceResult result = trace(volume, furnace(albedo), sites, rays, kAllBounces);
      return error_of(result.samples, [&](std::size_t i) {
        const double s = open_fraction(double(sites.isovalues[i]));
        return s / (1.0 - double(albedo) * (1.0 - s));
      });
    };
    const ErrorOfE few = rms(64);
    const ErrorOfE many = rms(1024);
    // A path's standard deviation is under .4 here, so 1024 paths stay under .0125 even without stratification.
    EXPECT_LT(many.rms, 0.01) << "albedo " << albedo;
    // Sixteen times the rays: a quarter of the error; the grid's own bias is some .001.
    EXPECT_LT(many.rms, 0.5 * few.rms) << "albedo " << albedo;
    EXPECT_LT(std::abs(many.bias), 0.003) << "albedo " << albedo;
  }
}

}  // namespace
}  // namespace isolux::test
