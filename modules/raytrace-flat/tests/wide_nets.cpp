// Interleaved nets: what the rays of neighbouring sites are together.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/light_links.h>
#include <isolux/volume_io.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "wide/hemisphere.h"
#include "wide/net_places.h"

namespace isolux {
namespace {

constexpr std::uint32_t kRays = 16;

/// `an_axis`^3 sites a cell in a cube of cells, at the centres of equal parts.
Sites lattice_of_sites(int cells, int an_axis) {
  Sites sites;
  const int n = cells * an_axis;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) sites.positions.push_back((Vec3f(x, y, z) + 0.5f) / float(an_axis));
  sites.isovalues.resize(sites.positions.size());
  sites.normals.resize(sites.positions.size(), Vec3f(0.0f, 0.0f, 1.0f));
  return sites;
}

/// The points of the parts of one net, each part shifted as Aimer does.
std::vector<wide::SobolPoint> points_of(const std::vector<std::uint32_t>& parts) {
  std::vector<wide::SobolPoint> points;
  for (const std::uint32_t part : parts) {
    const wide::SobolPoint shift = wide::sobol_point(std::uint64_t(part) * kRays);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      const wide::SobolPoint point = wide::sobol_point(ray);
      points.push_back({point.u ^ shift.u, point.v ^ shift.v});
    }
  }
  return points;
}

/// Has every elementary interval of area 1/count one point?
bool is_net(const std::vector<wide::SobolPoint>& points) {
  const int m = int(std::lround(std::log2(double(points.size()))));
  for (int a = 0; a <= m; ++a) {
    std::vector<char> taken(points.size());
    for (const wide::SobolPoint& p : points) {
      char& here = taken[std::uint64_t(p.u) >> (32 - a) << (m - a) | std::uint64_t(p.v) >> (32 - (m - a))];
      if (here != 0) return false;
      here = 1;
    }
  }
  return true;
}

TEST(InterleavedNets, SitesOfAlignedCubesShareOne) {
  for (const int an_axis : {1, 2}) {
    const Sites sites = lattice_of_sites(16, an_axis);
    const wide::NetPlaces places(sites);
    for (const int cube : {1, 2, 4, 8}) {
      if (an_axis == 1 && cube == 1) continue;
      std::map<std::array<int, 3>, std::vector<std::uint32_t>> parts;
      std::map<std::array<int, 3>, std::set<std::uint64_t>> nets;
      for (std::size_t site = 0; site < sites.size(); ++site) {
        const Vec3f& p = sites.positions[site];
        const std::array<int, 3> key{int(p.x) / cube, int(p.y) / cube, int(p.z) / cube};
        const wide::NetPlaces::Place place = places.of(sites, site);
        parts[key].push_back(place.part);
        nets[key].insert(place.net);
      }
      for (const auto& [key, list] : parts) {
        EXPECT_EQ(nets[key].size(), 1u);
        EXPECT_TRUE(is_net(points_of(list))) << an_axis << " sites an axis, cubes of " << cube;
      }
    }
  }
}

TEST(InterleavedNets, TexelsCoarserThanCellsShareOneToo) {
  Sites sites = lattice_of_sites(16, 1);
  for (Vec3f& p : sites.positions) p *= 4.0f;
  const wide::NetPlaces places(sites);
  std::vector<std::uint32_t> parts;
  for (std::size_t site = 0; site < sites.size(); ++site) {
    const Vec3f& p = sites.positions[site];
    if (p.x < 8.0f && p.y < 8.0f && p.z < 8.0f) parts.push_back(places.of(sites, site).part);
  }
  ASSERT_EQ(parts.size(), 8u);
  EXPECT_TRUE(is_net(points_of(parts)));
}

TEST(InterleavedNets, NoTwoSitesOfANetAreTheSamePart) {
  // Three to a cell: neither a power of two nor on a lattice.
  Sites sites = lattice_of_sites(12, 1);
  const Sites once = sites;
  for (const float off : {-0.3f, 0.35f})
    for (const Vec3f& p : once.positions) sites.positions.push_back(p + off);
  const wide::NetPlaces places(sites);
  std::set<std::pair<std::uint64_t, std::uint32_t>> taken;
  for (std::size_t site = 0; site < sites.size(); ++site) {
    const wide::NetPlaces::Place place = places.of(sites, site);
    EXPECT_TRUE(taken.insert({place.net, place.part}).second) << site;
  }
}

/// Of means over 2^3 sites around a point, which see half a sky: (1 + n.up)/2 each. Nothing is in their way, so the
/// volume only has to be there.
double error_of_means(RayNets nets) {
  const Volume volume = read_volume("gen:sphere:32");
  Sites sites = lattice_of_sites(28, 1);
  for (std::size_t i = 0; i < sites.size(); ++i) sites.normals[i] = glm::normalize(sites.positions[i] - 14.0f);
  std::mutex adding;
  std::map<std::array<int, 3>, double> sums;
  (void)gather(volume, sites, {.rays = int(kRays), .nets = nets}, {.seed = 1}, [&](const GatheredRays& rays) {
    const std::scoped_lock lock(adding);
    for (std::size_t s = 0; s < rays.sites.size(); ++s) {
      const std::uint32_t site = rays.sites[s];
      const Vec3f& p = sites.positions[site];
      double& sum = sums[{int(p.x) / 2, int(p.y) / 2, int(p.z) / 2}];
      for (std::size_t k = 0; k < rays.rays; ++k)
        sum += rays.direction[2][s * rays.rays + k] > 0.0f ? 1.0 / kRays : 0.0;
      sum -= 0.5 + 0.5 * double(sites.normals[site].z);
    }
  });
  double squares = 0.0;
  for (const auto& [key, sum] : sums) squares += sum * sum / 64.0;
  return std::sqrt(squares / double(sums.size()));
}

TEST(InterleavedNets, MeansOverNeighboursLoseNoiseFaster) {
  // Independent nets lose the root of 8. Here normals turn by a tenth of a radian and more from texel to texel, so
  // that the nets do not match exactly: .63 of that was measured, with some .02 of noise (2744 means).
  EXPECT_LT(error_of_means(RayNets::kInterleaved), 0.75 * error_of_means(RayNets::kIndependent));
}

TEST(InterleavedNets, CannotGoOn) {
  const Volume volume = read_volume("gen:sphere:8");
  const Sites sites = lattice_of_sites(4, 1);
  const GatherSettings settings{.rays = 4, .first_ray = 4, .nets = RayNets::kInterleaved};
  EXPECT_THROW((void)gather(volume, sites, settings, {}, [](const GatheredRays&) {}), InvalidInput);
  const GatherSettings beyond_int{
      .rays = 4, .all_rays = 16, .first_ray = std::numeric_limits<int>::max(), .nets = RayNets::kInterleaved};
  EXPECT_THROW((void)gather(volume, sites, beyond_int, {}, [](const GatheredRays&) {}), InvalidInput);
  LightLinks links(volume, sites, {.rays = 4, .nets = RayNets::kInterleaved}, {});
  const std::vector<std::uint32_t> first{0};
  EXPECT_THROW(links.extend(first, {}), InvalidInput);
}

}  // namespace
}  // namespace isolux
