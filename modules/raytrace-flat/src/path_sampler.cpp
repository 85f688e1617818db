#include "path_sampler.h"

#include <isolux/core/random.h>

namespace isolux {
namespace {

// A permutation in which a bit depends on the lower bits only (Laine & Karras 2011): seen from the other end, a nested
// uniform scramble.
std::uint32_t permute_upwards(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3D20ADEAu;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526C56u;
  x ^= x * 0x53A22864u;
  return x;
}

// The second dimension of Sobol's sequence, bits reversed: the binomials modulo 2 (Pascal's matrix) by doubling.
std::uint32_t sobol_second_reversed(std::uint32_t index) {
  index ^= (index & 0xAAAAAAAAu) >> 1;
  index ^= (index & 0xCCCCCCCCu) >> 2;
  index ^= (index & 0xF0F0F0F0u) >> 4;
  index ^= (index & 0xFF00FF00u) >> 8;
  index ^= (index & 0xFFFF0000u) >> 16;
  return index;
}

double unit(std::uint32_t reversed, std::uint32_t seed) {
  return reverse_bits(permute_upwards(reversed, seed)) * 0x1p-32;
}

}  // namespace

PathSampler::PathSampler(std::uint64_t seed, std::uint64_t site) : key_(mix_bits(mix_bits(seed) + site)) {}

UnitPair PathSampler::pair(std::uint32_t path, std::uint32_t dimension_pair) const {
  const std::uint64_t a = mix_bits(key_ + 0x9E3779B97F4A7C15ull * (dimension_pair + 1ull));
  const std::uint64_t b = mix_bits(a + 0x9E3779B97F4A7C15ull);
  const std::uint32_t index = reverse_bits(permute_upwards(reverse_bits(path), std::uint32_t(a)));
  return {.u = unit(index, std::uint32_t(a >> 32)), .v = unit(sobol_second_reversed(index), std::uint32_t(b))};
}

}  // namespace isolux
