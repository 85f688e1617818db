#include "held_out.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace isolux {
namespace {

/// Where little light is wrong by much, as in small grids, few places miss it.
constexpr double kFewestPlaces = 2048.0;
constexpr double kMostPlaces = 4096.0;
/// However few rays a bake has.
constexpr std::size_t kPlacesAlways = 64;
/// Of a place, if there are so many; four times as many towards errors below kRoughError, which noise of fewer hides.
constexpr double kPathsOfEach = 64.0;
constexpr double kRoughError = 0.012;
/// A path by so many rays of a large bake; of a small one many more, if each site has many rays: what they say is not
/// to be lost in noise of the paths.
constexpr double kRaysAPath = 256.0;
constexpr double kRaysAPathAtMost = 16.0;
constexpr double kPathsARayOfASite = 512.0;
constexpr double kFewestPaths = 0x1p16;
/// Towards kRoughError and larger errors, and without one at most; those below it take them as their inverse square.
constexpr double kPathsToRoughError = 0x1p18;
constexpr double kMostPaths = 0x1p21;
/// A site, at most, towards an error.
constexpr double kPathsASite = 16.0;
constexpr double kFewestPathsOfEach = 16.0;
constexpr double kMostPathsOfEach = 1024.0;
/// From this albedo on paths may be long, hundreds of rays in closed spaces: half of the places, as few of them may be
/// those in pockets, and an eighth of the paths of each have to do.
constexpr float kLasting = 0.95f;
constexpr double kFewerPlaces = 2.0;
constexpr double kFewerPaths = 8.0;
/// Of a place's paths, of which more are cut off its light is not known.
constexpr double kMostCut = 0.9;

/// Reflections after which roulette has ended nearly all paths of closed pockets; those of white ones it does not end,
/// and they are cut off as in any bake.
int longest_path(const Scene& scene) {
  constexpr double kLeft = 0.02;
  constexpr double kUsual = 1000.0;
  constexpr double kMost = 4000.0;
  const double wanted = std::log(kLeft) / std::log(double(largest_albedo(scene)));
  return int(wanted > kUsual && wanted <= kMost ? wanted : kUsual);
}

/// What a path that is cut off may still bring, at most: a path carries no more than it met, for roulette ends those
/// that lose light. Where surfaces emit or lamps shine there is no such bound.
double most_of_a_cut_path(const Scene& scene) {
  if (has_emission(scene) || !scene.lights.empty()) return std::numeric_limits<double>::infinity();
  return double(largest_radiance(scene.environment));
}

bool are_paths_long(const Scene& scene) { return largest_albedo(scene) > kLasting; }

/// Of all places together, of each side.
double paths_to_judge_by(std::size_t sites, const BakeSettings& settings) {
  if (!(settings.target_rmse > 0.0)) {
    const double of_each = std::max(settings.trace.rays, 1);
    const double rays = double(sites) * of_each;
    const double fine = std::min(rays / kRaysAPathAtMost, of_each * kPathsARayOfASite);
    return std::clamp(std::max(rays / kRaysAPath, fine), std::min(rays, kFewestPaths), kPathsToRoughError);
  }
  const double ratio = kRoughError / settings.target_rmse;
  const double most = std::clamp(kPathsASite * double(sites), 2.0 * kPathsToRoughError, kMostPaths);
  return std::clamp(kPathsToRoughError * ratio * ratio, kPathsToRoughError, most);
}

}  // namespace

HeldOut::HeldOut(const Volume& volume, const Scene& scene, const Sites& sites, std::vector<std::size_t> numbers,
                 const TraceSettings& settings, const Run& run)
    : numbers_(std::move(numbers)) {
  const auto tracer = tracers().create("wide", {{"longest_path", std::to_string(longest_path(scene))}});
  const double most = most_of_a_cut_path(scene);
  std::vector<std::uint8_t> is_known(numbers_.size(), 1);
  for (std::uint64_t side = 0; side < 2; ++side) {
    Run own = run;
    own.seed = mix_bits(run.seed ^ mix_bits(1 + side));
    TraceResult traced = tracer->trace(volume, scene, sites, settings, own);
    light_[side] = std::move(traced.samples.radiance);
    beyond_[side].assign(numbers_.size(), 0.0f);
    for (std::size_t i = 0; i < traced.cut.size(); ++i) {
      if (traced.cut[i] == 0) continue;
      const double share = double(traced.cut[i]) / double(settings.rays);
      beyond_[side][i] = float(share * most);
      if (!(share <= kMostCut && most < std::numeric_limits<double>::infinity())) is_known[i] = 0;
    }
    add(counters_, traced.counters);
  }
  leave_out(is_known);
}

void HeldOut::leave_out(const std::vector<std::uint8_t>& is_known) {
  const std::size_t channels = numbers_.empty() ? 1 : light_[0].size() / numbers_.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (is_known[i] == 0) continue;
    for (std::vector<float>& light : light_) std::copy_n(&light[i * channels], channels, &light[kept * channels]);
    for (std::vector<float>& beyond : beyond_) beyond[kept] = beyond[i];
    numbers_[kept++] = numbers_[i];
  }
  left_out_ = numbers_.size() - kept;
  numbers_.resize(kept);
  for (std::vector<float>& light : light_) light.resize(kept * channels);
  for (std::vector<float>& beyond : beyond_) beyond.resize(kept);
}

HeldOut::SquaredError HeldOut::squared_error(std::span<const float> light) const {
  if (numbers_.empty()) return {};
  const std::size_t channels = light_[0].size() / numbers_.size();
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < light_[0].size(); ++i) {
    const std::size_t place = i / channels;
    const auto found = double(light[numbers_[place] * channels + i % channels]);
    const auto off = [&](std::size_t side) {
      const double below = double(light_[side][i]) - found;
      return below > 0.0 ? below : std::min(0.0, below + double(beyond_[side][place]));
    };
    const double product = off(0) * off(1);
    sum += product;
    squares += product * product;
  }
  const auto count = double(light_[0].size());
  const double mean = sum / count;
  // The channels of a site are taken for one another's copies.
  const double variance = std::max(0.0, squares / count - mean * mean) / double(numbers_.size());
  return {.mean = mean, .standard_error = std::sqrt(variance)};
}

void count_judging(const HeldOut& held_out, BakeResult& result) {
  add(result.counters, held_out.counters());
  if (held_out.left_out() == 0) return;
  std::uint64_t& unjudged = result.skipped["places_unjudged"];
  unjudged = std::max<std::uint64_t>(unjudged, held_out.left_out());  // sites and texels lie in the same pockets
}

std::vector<std::size_t> one_of_each_share(std::size_t count, std::size_t shares, const Run& run) {
  RandomStream random(run.seed, 0, 0x4e656564);
  std::vector<std::size_t> numbers(shares);
  for (std::size_t i = 0; i < shares; ++i) {
    const std::size_t begin = i * count / shares;
    const std::size_t share = (i + 1) * count / shares - begin;
    numbers[i] = begin + std::min(share - 1, std::size_t(random.uniform_double() * double(share)));
  }
  return numbers;
}

std::size_t places_to_judge_by(std::size_t sites, const Scene& scene, const BakeSettings& settings) {
  const bool is_fine = settings.target_rmse > 0.0 && settings.target_rmse < kRoughError;
  const double paths = paths_to_judge_by(sites, settings);
  const double places = std::clamp(paths / (kPathsOfEach * (is_fine ? 4.0 : 1.0)), kFewestPlaces, kMostPlaces);
  const double affordable = std::min(places, paths / kFewestPathsOfEach) / (are_paths_long(scene) ? kFewerPlaces : 1.0);
  return std::max(kPlacesAlways, std::size_t(affordable));
}

TraceSettings paths_of_each(std::size_t places, std::size_t sites, const Scene& scene, const BakeSettings& settings) {
  const double paths = paths_to_judge_by(sites, settings) / (are_paths_long(scene) ? kFewerPlaces * kFewerPaths : 1.0);
  TraceSettings judged = settings.trace;
  judged.nets = RayNets::kIndependent;
  judged.lamps = LampLight::kWithin;
  judged.rays = int(std::clamp(paths / double(std::max<std::size_t>(places, 1)), kFewestPathsOfEach, kMostPathsOfEach));
  return judged;
}

std::vector<std::size_t> held_out_texels(const Lattice& texels, const TexelSiteMaker& sites, std::size_t most,
                                         std::size_t one_of, const Run& run) {
  const std::size_t count = texels.count();
  const auto from_shares = [&](std::size_t shares) {
    std::vector<std::size_t> drawn = one_of_each_share(count, shares, run);
    std::vector<std::uint8_t> lit;
    static_cast<void>(sites.make(drawn, &lit));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shares; ++i)
      if (lit[i] != 0) drawn[kept++] = drawn[i];
    drawn.resize(kept);
    return drawn;
  };
  const std::size_t first = std::min(most, count);
  std::vector<std::size_t> drawn = from_shares(first);
  const double can_be_lit = double(drawn.size()) / double(first);
  const double wanted = std::min(double(most), std::ceil(can_be_lit * double(count) / double(one_of)));
  if (can_be_lit > 0.0) return from_shares(std::min(count, std::size_t(std::ceil(wanted / can_be_lit))));
  return drawn;
}

}  // namespace isolux
