// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/pack_bits.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include <cstring>

#include "wide/occupancy.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void pack(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out) {
  for (std::size_t i = 0; i < codes.size(); i += 32) {
#if HWY_TARGET == HWY_SCALAR
    std::uint32_t bits = 0;
    for (std::size_t c = 0; c < 32; ++c) bits |= std::uint32_t(codes[i + c] > index) << c;
    *out++ = bits;
#else
    const hn::CappedTag<std::uint8_t, 32> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto limit = hn::Set(d, index);
    std::uint8_t bits[8] = {};  // StoreMaskBits may write eight bytes
    for (std::size_t part = 0; part < 32; part += lanes)
      hn::StoreMaskBits(d, hn::Gt(hn::LoadU(d, codes.data() + i + part), limit), bits + part / 8);
    std::memcpy(out++, bits, 4);
#endif
  }
}

void pack_halves(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out) {
  for (std::size_t i = 0; i < codes.size(); i += 32) {
#if HWY_TARGET == HWY_SCALAR
    std::uint32_t lower = 0;
    std::uint32_t upper = 0;
    for (std::size_t c = 0; c < 32; ++c) {
      lower |= std::uint32_t((codes[i + c] & 15) > index) << c;
      upper |= std::uint32_t((codes[i + c] >> 4) > index) << c;
    }
    *out++ = lower;
    *out++ = upper;
#else
    const hn::CappedTag<std::uint8_t, 32> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto limit = hn::Set(d, index);
    // An upper half is greater if the whole byte is greater than `index` with all lower bits set.
    const auto upper_limit = hn::Set(d, std::uint8_t(index << 4 | 15));
    const auto lower_half = hn::Set(d, std::uint8_t(15));
    std::uint8_t lower[8] = {};  // StoreMaskBits may write eight bytes
    std::uint8_t upper[8] = {};
    for (std::size_t part = 0; part < 32; part += lanes) {
      const auto both = hn::LoadU(d, codes.data() + i + part);
      hn::StoreMaskBits(d, hn::Gt(hn::And(both, lower_half), limit), lower + part / 8);
      hn::StoreMaskBits(d, hn::Gt(both, upper_limit), upper + part / 8);
    }
    std::memcpy(out++, lower, 4);
    std::memcpy(out++, upper, 4);
#endif
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(pack);
HWY_EXPORT(pack_halves);

void pack_bits(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(pack)(codes, index, out);
}

void pack_half_bits(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(pack_halves)(codes, index, out);
}

}  // namespace isolux::wide
#endif
