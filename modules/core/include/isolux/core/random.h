#pragma once

#include <array>
#include <cstdint>

namespace isolux {

/// Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011): 128 random bits as a pure
/// function of a 128-bit counter and a 64-bit key, so that any number can be had in any order on any thread.
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                      std::array<std::uint32_t, 2> key);

/// A stream of uniform numbers keyed by (seed, stream, substream), such as (run seed, site index, bounce). Cheap to
/// make; equal keys give equal streams.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream, std::uint32_t substream = 0);

  [[nodiscard]] std::uint32_t next_bits();
  /// Uniform in [0, 1), 24 bits.
  [[nodiscard]] float uniform_float();
  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform_double();

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> bits_{};
  int left_ = 0;
};

/// The bits of a number in the opposite order: the radical inverse in base 2, in fractions of 2^32.
[[nodiscard]] constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = x >> 16 | x << 16;
  x = (x & 0x00FF00FFu) << 8 | (x & 0xFF00FF00u) >> 8;
  x = (x & 0x0F0F0F0Fu) << 4 | (x & 0xF0F0F0F0u) >> 4;
  x = (x & 0x33333333u) << 2 | (x & 0xCCCCCCCCu) >> 2;
  return (x & 0x55555555u) << 1 | (x & 0xAAAAAAAAu) >> 1;
}

/// A 64-bit value scrambled so that each input bit reaches each output bit (the finaliser of SplitMix64, Steele et al.
/// 2014).
[[nodiscard]] std::uint64_t mix_bits(std::uint64_t value);

}  // namespace isolux
