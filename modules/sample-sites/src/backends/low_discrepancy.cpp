#include <isolux/core/random.h>
#include <isolux/sample_sites/site_sampler.h>

#include <cstdint>

#include "collect_sites.h"

namespace isolux {
namespace {

/// A nested uniform (Owen) scramble by hashing: each bit is flipped by a hash of the bits above it. Burley 2020,
/// "Practical hash-based Owen scrambling", with the constants of its Laine-Karras permutation.
std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return reverse_bits(x);
}

/// The first three dimensions of Sobol's sequence. Its direction numbers are those of the primitive polynomials 1, x +
/// 1 and x^2 + x + 1 with the initial values of Joe & Kuo 2008.
std::uint32_t sobol(std::uint32_t i, int dimension) {
  if (dimension == 0) return reverse_bits(i);
  std::uint32_t before = 0;  // the direction number before the last, of the third dimension's recurrence
  std::uint32_t direction = 0x80000000u;
  std::uint32_t x = 0;
  for (int bit = 0; i != 0; i >>= 1, ++bit) {
    if ((i & 1u) != 0) x ^= direction;
    std::uint32_t next = direction ^ (direction >> 1);
    if (dimension == 2) next = bit == 0 ? 0xC0000000u : direction ^ before ^ (before >> 2);
    before = direction;
    direction = next;
  }
  return x;
}

/// Sobol points, scrambled anew for each 2^32 of them.
Vec3 sobol_point(std::uint64_t i, std::uint64_t seed) {
  Vec3 u;
  for (int a = 0; a < 3; ++a) {
    const auto key = std::uint32_t(mix_bits(mix_bits(seed) + 3 * (i >> 32) + std::uint64_t(a)));
    u[a] = double(owen_scrambled(sobol(std::uint32_t(i), a), key)) * 0x1p-32;
  }
  return u;
}

/// Sites that fill the volume more evenly than chance: Owen-scrambled Sobol points. A Kronecker sequence (Roberts' R3)
/// was measured beside it and is worse: see the README.
class LowDiscrepancySampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit LowDiscrepancySampler(const Options& /*options*/) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    const ActiveCells cells(volume, request.isovalues, run);
    return collect_sites(
        volume, request, cells, wanted_sites(request, cells),
        [seed = run.seed](std::uint64_t i) { return sobol_point(i, seed); }, run);
  }
};

}  // namespace

namespace backends {
void low_discrepancy(Registry<SiteSampler>& registry) {
  registry.add<LowDiscrepancySampler>(
      "low_discrepancy", "sites that fill the volume more evenly than chance (Sobol's sequence, scrambled)");
}
}  // namespace backends

}  // namespace isolux
