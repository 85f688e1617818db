#include "net_cubes.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "wide/net_places.h"

namespace isolux {
namespace {

/// A net's variance falls as rays^-1.5.
constexpr double kFall = 1.5;
/// Rays go by this power of the noise of the first ones. The variance of all sites together is least for 1 / (1 +
/// kFall); less is better where what neighbours have in common is kept and the rest taken out
/// (docs/measured/resampling.md, "Rays go where noise is").
constexpr double kPower = 0.3;
/// Sites of mean noise that each cube is thought to have besides: few sites that agree by chance say little.
constexpr double kSitesBesides = 2.0;
/// One cube of so many says whether spreading pays, if that makes enough of them.
constexpr std::size_t kOneOf = 8;
constexpr std::size_t kEnough = 64;

/// What is wanted unless it is off by a factor of two; then the nearest of halves and quarters, and of two and four
/// times as many.
int rays_for(double wanted, int rays) {
  const double times = wanted / double(rays);
  if (times >= 2.0) return times < 2.0 * std::numbers::sqrt2 ? 2 * rays : 4 * rays;
  if (times <= 0.5) return times > 0.5 / std::numbers::sqrt2 ? rays / 2 : rays / NetCubes::kFirst;
  return rays;
}

}  // namespace

NetCubes::NetCubes(const Sites& sites) : of_site_(sites.size(), kNone) {
  const wide::NetPlaces places(sites);
  std::unordered_map<std::uint64_t, std::uint32_t> numbers;
  std::uint64_t last_net = 0;
  std::uint32_t last = kNone;
  for (std::size_t site = 0; site < sites.size(); ++site) {
    if (sites.normals[site] == Vec3f(0.0f)) continue;
    const std::uint64_t net = places.of(sites, site).net;
    if (last == kNone || net != last_net) {  // along a row there are several of a cube
      last = numbers.try_emplace(net, std::uint32_t(cubes_.size())).first->second;
      if (last == cubes_.size()) cubes_.emplace_back();
      last_net = net;
    }
    of_site_[site] = last;
    cubes_[last].sites += 1.0;
  }
}

NetCubes::Parts NetCubes::parts() const {
  const std::size_t step = std::clamp<std::size_t>(cubes_.size() / kEnough, 1, kOneOf);
  Parts parts;
  for (std::size_t site = 0; site < of_site_.size(); ++site) {
    if (of_site_[site] == kNone) continue;
    (mix_bits(of_site_[site]) % step == 0 ? parts.some : parts.others).push_back(std::uint32_t(site));
  }
  return parts;
}

void NetCubes::learn(std::span<const std::uint32_t> sites, const std::vector<float>& variances) {
  for (const std::uint32_t site : sites) {
    Cube& cube = cubes_[of_site_[site]];
    cube.noise += double(variances[site]);
    cube.is_known = true;
  }
}

std::vector<std::uint32_t> NetCubes::spread(int rays) const {
  const double by = factor(rays);
  const double mean = mean_noise();
  std::vector<std::uint32_t> result(of_site_.size(), std::uint32_t(rays));
  for (std::size_t site = 0; site < result.size(); ++site)
    if (of_site_[site] != kNone) result[site] = std::uint32_t(rays_for(by * wants(cubes_[of_site_[site]], mean), rays));
  return result;
}

double NetCubes::mean_noise() const {
  double noise = 0.0;
  double sites = 0.0;
  for (const Cube& cube : cubes_) {
    noise += cube.noise;
    sites += cube.is_known ? cube.sites : 0.0;
  }
  return sites > 0.0 ? noise / sites : 0.0;
}

double NetCubes::wants(const Cube& cube, double mean) {
  if (!(mean > 0.0)) return 1.0;
  return std::pow((cube.noise / mean + kSitesBesides) / (cube.sites + kSitesBesides), kPower);
}

double NetCubes::factor(int rays) const {
  constexpr int kHalvings = 40;
  constexpr double kHighest = 16.0;  // times as many: all have four times as many before
  const double mean = mean_noise();
  const auto too_many = [&](double factor) {
    double more = 0.0;  // than `rays` each
    for (const Cube& cube : cubes_) {
      if (!cube.is_known) continue;
      const int own = rays_for(factor * wants(cube, mean), rays);
      more += cube.sites * double(own > rays ? own + rays / kFirst - rays : own - rays);
    }
    return more > 0.0;
  };
  double low = 0.0;
  double high = kHighest * double(rays);
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (low + high);
    (too_many(middle) ? high : low) = middle;
  }
  return low;
}

double NetCubes::noise_left(double factor, int rays) const {
  const double mean = mean_noise();
  double all = 0.0;
  double left = 0.0;
  for (const Cube& cube : cubes_) {
    if (!cube.is_known) continue;
    all += cube.noise;
    left += cube.noise * std::pow(double(rays_for(factor * wants(cube, mean), rays)) / double(rays), -kFall);
  }
  return all > 0.0 ? left / all : 1.0;
}

}  // namespace isolux
