#include <isolux/core/random.h>

namespace isolux {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = 0xD2511F53ull * counter[0];
    const std::uint64_t p1 = 0xCD9E8D57ull * counter[2];
    counter = {std::uint32_t(p1 >> 32) ^ counter[1] ^ key[0], std::uint32_t(p1),
               std::uint32_t(p0 >> 32) ^ counter[3] ^ key[1], std::uint32_t(p0)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream, std::uint32_t substream)
    : key_{std::uint32_t(seed), std::uint32_t(seed >> 32)},
      counter_{0, substream, std::uint32_t(stream), std::uint32_t(stream >> 32)} {}

std::uint32_t RandomStream::next_bits() {
  if (left_ == 0) {
    bits_ = philox4x32(counter_, key_);
    ++counter_[0];
    left_ = 4;
  }
  return bits_[std::size_t(4 - left_--)];
}

float RandomStream::uniform_float() { return float(next_bits() >> 8) * 0x1p-24f; }

double RandomStream::uniform_double() {
  const std::uint64_t high = next_bits() >> 5;
  const std::uint64_t low = next_bits() >> 6;
  return double(high << 26 | low) * 0x1p-53;
}

std::uint64_t mix_bits(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9ull;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EBull;
  return value ^ (value >> 31);
}

}  // namespace isolux
