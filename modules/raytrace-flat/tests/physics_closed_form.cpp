// The exact answers of docs/theory.md that hold for whole families of level sets, for every backend.
#include <gtest/gtest.h>

#include <numbers>

#include "physics_support.h"

namespace isolux::test {
namespace {

constexpr int kGrid = 64;

class ClosedForm : public EveryTracer {};
ISOLUX_FOR_EVERY_TRACER(ClosedForm);

Vec3 position_of(const Volume& volume, const SampleSet& samples, std::size_t i) {
  return volume.lattice().frame.world(Vec3(samples.sites.positions[i]));
}

double isovalue_of(const SampleSet& samples, std::size_t i) { return double(samples.sites.isovalues[i]); }

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

TEST_P(ClosedForm, OpenIntegratingSphereMatchesAndItsErrorFallsWithTheRays) {
  const Volume volume = cavity(kGrid);
  const Sites sites = open_sphere_sites(volume);
  for (const float albedo : {0.5f, 0.8f}) {
    const auto error = [&](int rays) {
      const TraceResult result = trace(volume, furnace(albedo), sites, rays, kAllBounces);
      return error_of(result.samples, [&](std::size_t i) {
        const double s = open_fraction(isovalue_of(result.samples, i));
        return s / (1.0 - double(albedo) * (1.0 - s));
      });
    };
    const ErrorOfE few = error(64);
    const ErrorOfE many = error(full_stress() ? 16384 : 1024);
    // A path's standard deviation is under .4 here, so 1024 paths stay under .0125 even without stratification.
    EXPECT_LT(many.rms, 0.01) << "albedo " << albedo;
    // Sixteen times the rays: a quarter of the error; the grid's own bias is some .001.
    EXPECT_LT(many.rms, 0.5 * few.rms) << "albedo " << albedo;
    EXPECT_LT(std::abs(many.bias), 0.003) << "albedo " << albedo;
  }
}

TEST_P(ClosedForm, OpenIntegratingSphereWithoutBouncesSeesItsOpenFraction) {
  const Volume volume = cavity(kGrid);
  const TraceResult result = trace(volume, furnace(0.8f), open_sphere_sites(volume), 1024, 0);
  const ErrorOfE error =
      error_of(result.samples, [&](std::size_t i) { return open_fraction(isovalue_of(result.samples, i)); });
  EXPECT_LT(error.rms, 0.01);  // as above
  EXPECT_LT(std::abs(error.bias), 0.003);
}

// Level sets of the gyroid between -1.3 and 1.3 have no pocket on either side, so every path gets out with all it had.
TEST_P(ClosedForm, WhiteFurnace) {
  const Volume volume = gyroid(24);
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    const Sites sites = sites_at(volume,
                                 random_positions(300, 5,
                                                  [&](const Vec3& p) {
                                                    const Vec3 index = volume.lattice().frame.index(p);
                                                    return std::abs(TrilinearField(volume).value(index)) < 1.2;
                                                  }),
                                 outer);
    // Nearer to the extremes the pockets' necks are so narrow that some paths do not find out in 1000 reflections.
    const TraceResult result = trace(volume, furnace(1.0f, outer), sites, 32, kAllBounces);
    // Sums of ones, in floats at the end.
    EXPECT_LT(error_of(result.samples, [](std::size_t) { return 1.0; }).worst, 1e-6);
  }
}

TEST_P(ClosedForm, AClosedPocketStaysDark) {
  const Volume volume = cavity(24);
  const Sites sites = sites_at(volume,
                               random_positions(20, 6,
                                                [](const Vec3& p) {
                                                  const double r = glm::length(p - kCenter);
                                                  return r > 0.1 && r < 0.45;
                                                }),
                               OuterSide::kLower);
  const TraceResult result = trace(volume, furnace(1.0f), sites, 4, kAllBounces);
  EXPECT_EQ(error_of(result.samples, [](std::size_t) { return 0.0; }).worst, 0.0);
}

// Le = 1 - rho and a white environment: every path sums to 1 however it goes, closed or open, if no roulette ends it.
TEST_P(ClosedForm, EmissiveFurnace) {
  for (const Volume& volume : {noise(Index3(12), 9), gyroid(16), cavity(16)}) {
    const Vec3 last(volume.lattice().size - 1);
    const auto anywhere = random_positions(200, 7, [](const Vec3&) { return true; });
    std::vector<Vec3> positions;
    positions.reserve(anywhere.size());
    for (const Vec3& p : anywhere) positions.push_back(volume.lattice().frame.world(p * last));
    Scene scene = furnace(0.6f);
    scene.emission = constant(0.4f);
    const TraceResult result = trace(volume, scene, sites_at(volume, positions, OuterSide::kLower), 256, kAllBounces);
    const ErrorOfE error = error_of(result.samples, [](std::size_t) { return 1.0; });
    // Roulette from the third reflection on spreads the rest, .6^3, by about as much: .2/sqrt(256 rays) at a site, and
    // a fourteenth of that in the mean.
    EXPECT_LT(error.rms, 0.02);
    EXPECT_LT(std::abs(error.bias), 0.004);
  }
}

TEST_P(ClosedForm, EveryBounceOfAClosedIntegratingSphereAddsItsPower) {
  const Volume volume = cavity(24);
  const Sites sites = sites_at(volume, {{0.5, 0.5, 0.8}, {0.3, 0.4, 0.6}, {0.61, 0.57, 0.36}}, OuterSide::kLower);
  Scene scene = darkness(0.5f);
  scene.emission = constant(1.0f);
  for (const int bounces : {0, 1, 2}) {
    const TraceResult result = trace(volume, scene, sites, 16, bounces);
    const double expected = 2.0 - std::pow(0.5, bounces);
    // Powers of one half: exact.
    EXPECT_EQ(error_of(result.samples, [&](std::size_t) { return expected; }).worst, 0.0) << bounces;
  }
  const TraceResult all = trace(volume, scene, sites, 4096, kAllBounces);
  // What follows the third reflection, 1/4 in the mean, is spread by the roulette: .3/sqrt(4096), four times.
  EXPECT_LT(error_of(all.samples, [](std::size_t) { return 2.0; }).worst, 0.02);
}

/// Sites between the radii .1 and .45 about the center.
Sites sphere_sites(const Volume& volume, int count) {
  return sites_at(volume,
                  random_positions(count, 8,
                                   [](const Vec3& p) {
                                     const double r = glm::length(p - kCenter);
                                     return r > 0.1 && r < 0.45;
                                   }),
                  OuterSide::kLower);
}

TEST_P(ClosedForm, AConvexLevelSetSeesAllOfItsSky) {
  const Volume volume = sphere(kGrid);
  const Sites sites = sphere_sites(volume, 100);
  const TraceResult uniform = trace(volume, furnace(0.9f), sites, 64, 0);
  // The trilinear surface is a sphere up to facets of 1/(8 r) of a cell: some rays near the horizon meet the next one.
  EXPECT_LT(error_of(uniform.samples, [](std::size_t) { return 1.0; }).rms, 0.01);
  const TraceResult bouncing = trace(volume, furnace(1.0f), sites, 16, kAllBounces);
  EXPECT_LT(error_of(bouncing.samples, [](std::size_t) { return 1.0; }).worst, 1e-6);

  Scene half = furnace(0.9f);
  const Vec3 up = glm::normalize(Vec3(1.0, -2.0, 0.5));
  half.environment = half_sky(Vec3f(up));
  const TraceResult sky = trace(volume, half, sites, 1024, 0);
  const auto expected = [&](std::size_t i) { return 0.5 + 0.5 * glm::dot(Vec3(sites.normals[i]), up); };
  // The edge between sky and ground crosses some 32 of 1024 strata: an error near .5 sqrt(32)/1024, plus the facets'.
  EXPECT_LT(error_of(sky.samples, expected).rms, 0.01);
}

TEST_P(ClosedForm, AConvexLevelSetUnderTheSun) {
  const Volume volume = sphere(kGrid);
  const Sites sites = sphere_sites(volume, 200);
  const Vec3 to_sun = glm::normalize(Vec3(0.3, 0.5, 0.8));
  Scene scene = darkness(0.9f);
  scene.lights = {SunLight{.direction = Vec3f(3.0 * to_sun), .irradiance = Vec3f(2.0f), .angular_diameter_deg = 0.53f}};
  const TraceResult result = trace(volume, scene, sites, 64, 0);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const double cosine = glm::dot(Vec3(sites.normals[i]), to_sun);
    // At the terminator the facets of the trilinear surface, tilted by up to 1/(16 r) of a cell or .01, decide.
    if (std::abs(cosine) < 0.05) continue;
    // The disc's cosines differ from its center's by its radius, .005, averaged over 64 strata.
    EXPECT_NEAR(result.samples.radiance[i], 2.0 * std::max(cosine, 0.0) / std::numbers::pi, 3e-4) << cosine;
  }
}

TEST_P(ClosedForm, TwoBallsHideEachOtherByTheirSolidAngles) {
  const Volume volume = two_spheres(kGrid);
  const Vec3 centers[2] = {{0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}};
  const auto place = [&](const Vec3& p) {
    const int near = glm::length(p - centers[0]) < glm::length(p - centers[1]) ? 0 : 1;
    const double r = glm::length(p - centers[near]);
    const Vec3 way = centers[1 - near] - p;
    return std::tuple(r, glm::length(way), glm::dot(way, p - centers[near]) / (r * glm::length(way)));
  };
  const Sites sites = sites_at(volume,
                               random_positions(150, 9,
                                                [&](const Vec3& p) {
                                                  const auto [r, d, cosine] = place(p);
                                                  return r > 0.08 && r < 0.18 && d * cosine > r;
                                                }),
                               OuterSide::kLower);
  const TraceResult result = trace(volume, furnace(0.8f), sites, 1024, 0);
  const ErrorOfE error = error_of(result.samples, [&](std::size_t i) {
    const auto [r, d, cosine] = place(position_of(volume, result.samples, i));
    return 1.0 - cosine * (r / d) * (r / d);
  });
  // The ball's edge crosses some 60 of 1024 strata, .5 sqrt(60)/1024 = .004; its radius is right to 1/(8 r) of a cell.
  EXPECT_LT(error.rms, 0.01);
  EXPECT_LT(std::abs(error.bias), 0.003);
}

TEST_P(ClosedForm, ABallAboveAPlaneShadesIt) {
  const Volume volume = ball_over_plane(kGrid);
  const Sites sites = sites_at(
      volume, random_positions(150, 10, [](const Vec3& p) { return p.z > 0.03 && p.z < 0.15; }), OuterSide::kLower);
  const TraceResult result = trace(volume, furnace(0.8f), sites, 1024, 0);
  const ErrorOfE error = error_of(result.samples, [&](std::size_t i) {
    const Vec3 p = position_of(volume, result.samples, i);
    const double height = 0.5 - p.z;
    const double radius = p.z + 0.1;
    const double aside = std::hypot(p.x - 0.5, p.y - 0.5);
    return 1.0 - height * radius * radius / std::pow(height * height + aside * aside, 1.5);
  });
  EXPECT_LT(error.rms, 0.01);  // as for two balls
  EXPECT_LT(std::abs(error.bias), 0.003);
}

// View factor of a rectangle in a parallel plane, its corner at (x, y), seen from under its other corner, at
// distance 1.
double corner_view_factor(double x, double y) {
  const double a = std::sqrt(1.0 + x * x);
  const double b = std::sqrt(1.0 + y * y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2.0 * std::numbers::pi);
}

TEST_P(ClosedForm, ParallelPlanesSeeEachOtherByTheViewFactor) {
  // A plane of voxels at z = c, so that f is exact.
  const Volume volume = unit_cube_volume(33, [](const Vec3& p) { return std::abs(p.z - kCenter); });
  const Sites sites =
      sites_at(volume, random_positions(150, 11, [](const Vec3& p) { return std::abs(p.z - kCenter) > 0.1; }),
               OuterSide::kLower);
  const TraceResult result = trace(volume, furnace(0.8f), sites, 1024, 0);
  const ErrorOfE error = error_of(result.samples, [&](std::size_t i) {
    const Vec3 p = position_of(volume, result.samples, i);
    const double gap = 2.0 * std::abs(p.z - kCenter);
    double covered = 0.0;
    for (const double x : {p.x, 1.0 - p.x})
      for (const double y : {p.y, 1.0 - p.y}) covered += corner_view_factor(x / gap, y / gap);
    return 1.0 - covered;
  });
  // The rectangle's edge crosses some 100 of 1024 strata: .5 sqrt(100)/1024.
  EXPECT_LT(error.rms, 0.01);
  EXPECT_LT(std::abs(error.bias), 0.002);
}

}  // namespace
}  // namespace isolux::test
