#include <isolux/core/random.h>
#include <isolux/sample_sites/site_sampler.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "collect_sites.h"

namespace isolux {
namespace {

/// About `count` boxes that fill the unit cube, their edges in proportion to 1/lengths: cubes in the world. The longest
/// axis is divided last, so that rounding costs least.
Index3 strata_for(double count, const Vec3& lengths) {
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return lengths[a] < lengths[b]; });
  Index3 strata(1);
  double left = count;
  for (int n = 0; n < 3; ++n) {
    double part = left;
    for (int m = n + 1; m < 3; ++m) part *= lengths[axes[std::size_t(n)]] / lengths[axes[std::size_t(m)]];
    strata[axes[std::size_t(n)]] = std::max(1, int(std::lround(std::pow(part, 1.0 / (3 - n)))));
    left /= strata[axes[std::size_t(n)]];
  }
  return strata;
}

/// One jittered site in each of nearly cubic strata (Cook 1986, "Stochastic sampling in computer graphics").
class StratifiedSampler final : public SiteSampler {
 public:
  struct Options {
    double jitter = 1.0;
    void describe(OptionVisitor& option) {
      option("jitter", jitter, {.min = 0.0, .max = 1.0, .help = "part of the stratum that its site is spread over"});
    }
  };
  explicit StratifiedSampler(const Options& options) : options_(options) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    const ActiveCells cells(volume, request.isovalues, run);
    const std::size_t count = wanted_sites(request, cells);
    if (cells.empty() || count == 0) return {};
    const Lattice& lattice = volume.lattice();
    const Vec3 lengths = Vec3(lattice.size - 1) * lattice.frame.spacing();
    const Index3 pilot = strata_for(double(kPilot), lengths);
    const std::uint64_t pilot_count = product(pilot);
    const std::size_t found =
        sites_of_range(volume, request, cells, 0, pilot_count, jittered(pilot, run.seed), run).size();
    // Every stratum gives one candidate, so the share of them that are sites has to be known beforehand.
    const double candidates = std::min(double(count) * double(pilot_count) / std::max(1.0, double(found)),
                                       double(count) * double(kCandidatesPerSite));
    const Index3 strata = strata_for(candidates, lengths);
    Sites sites = room_for_sites(count + count / 16);  // the pilot knows their share to some percent
    const auto total = product(strata);
    for (std::uint64_t first = 0; first < total; first += kRound) {
      Sites more = sites_of_range(volume, request, cells, first, std::min(total, first + kRound),
                                  jittered(strata, run.seed), run);
      append_sites(sites, more, more.size());
    }
    return sites;
  }

 private:
  static constexpr std::size_t kPilot = 8192;
  static constexpr std::uint64_t kRound = std::uint64_t(1) << 22;

  [[nodiscard]] static std::uint64_t product(Index3 n) {
    return std::uint64_t(n.x) * std::uint64_t(n.y) * std::uint64_t(n.z);
  }
  [[nodiscard]] UnitSequence jittered(Index3 strata, std::uint64_t seed) const {
    return [strata, seed, jitter = options_.jitter](std::uint64_t i) {
      RandomStream random(seed, i);
      const auto nx = std::uint64_t(strata.x);
      const auto ny = std::uint64_t(strata.y);
      const std::uint64_t slab = i / (nx * ny);
      const std::uint64_t row = i / nx % ny;
      Vec3 u(double(i % nx), double(row), double(slab));
      for (int a = 0; a < 3; ++a) u[a] = (u[a] + 0.5 + jitter * (random.uniform_double() - 0.5)) / strata[a];
      return u;
    };
  }

  Options options_;
};

}  // namespace

namespace backends {
void stratified(Registry<SiteSampler>& registry) {
  registry.add<StratifiedSampler>("stratified", "one jittered site in each of nearly cubic strata");
}
}  // namespace backends

}  // namespace isolux
