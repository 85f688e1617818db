#include "held_out.h"

#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace isolux {
namespace {

constexpr std::size_t kTexelsAHeldOut = 8;
/// A place held out by so many rays of a bake.
constexpr std::size_t kRaysAPlace = 16384;
/// As many at least, if there are so many sites; paths of fewer cannot tell a bias from noise.
constexpr std::size_t kFewestPlaces = 1024;
constexpr std::size_t kMostPlaces = 4096;
/// From this albedo on paths may be long, hundreds of rays in closed spaces: a quarter of both places and rays has to
/// do.
constexpr float kLasting = 0.95f;

int share_by_length(const Scene& scene) {
  const bool last = std::any_of(scene.albedo.keys.begin(), scene.albedo.keys.end(), [](const auto& key) {
    return std::max({key.colour.x, key.colour.y, key.colour.z}) > kLasting;
  });
  return last ? 4 : 1;
}

}  // namespace

HeldOut::HeldOut(const Volume& volume, const Scene& scene, const Sites& sites, std::vector<std::size_t> numbers,
                 const TraceSettings& settings, const Run& run)
    : numbers_(std::move(numbers)) {
  const auto tracer = tracers().create("wide");
  for (std::uint64_t side = 0; side < 2; ++side) {
    Run own = run;
    own.seed = mix_bits(run.seed ^ mix_bits(1 + side));
    TraceResult traced = tracer->trace(volume, scene, sites, settings, own);
    light_[side] = std::move(traced.samples.radiance);
    add(counters_, traced.counters);
  }
}

HeldOut::SquaredError HeldOut::squared_error(std::span<const float> light) const {
  if (numbers_.empty()) return {};
  const std::size_t channels = light_[0].size() / numbers_.size();
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < light_[0].size(); ++i) {
    const auto found = double(light[numbers_[i / channels] * channels + i % channels]);
    const double product = (double(light_[0][i]) - found) * (double(light_[1][i]) - found);
    sum += product;
    squares += product * product;
  }
  const auto count = double(light_[0].size());
  const double mean = sum / count;
  // The channels of a site are taken for one another's copies.
  const double variance = std::max(0.0, squares / count - mean * mean) / double(numbers_.size());
  return {.mean = mean, .standard_error = std::sqrt(variance)};
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
  const std::size_t rays = sites * std::size_t(std::max(settings.trace.rays, 1));
  const std::size_t by_rays = settings.target_rmse > 0.0 ? kMostPlaces : rays / kRaysAPlace;
  return std::clamp(by_rays, kFewestPlaces, kMostPlaces) / std::size_t(share_by_length(scene));
}

TraceSettings paths_to_judge_by(const Scene& scene, const BakeSettings& settings) {
  TraceSettings judged = settings.trace;
  judged.nets = RayNets::kIndependent;
  judged.lamps = LampLight::kWithin;
  judged.rays = (settings.target_rmse > 0.0 && settings.target_rmse < 0.012 ? 128 : 64) / share_by_length(scene);
  return judged;
}

std::vector<std::size_t> held_out_texels(const Lattice& texels, const TexelSiteMaker& sites, std::size_t most,
                                         const Run& run) {
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
  const double wanted = std::min(double(most), std::ceil(can_be_lit * double(count) / double(kTexelsAHeldOut)));
  if (can_be_lit > 0.0) return from_shares(std::min(count, std::size_t(std::ceil(wanted / can_be_lit))));
  return drawn;
}

}  // namespace isolux
