// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
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

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(pack);

void pack_bits(std::span<const std::uint8_t> codes, std::uint8_t index, std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(pack)(codes, index, out);
}

}  // namespace isolux::wide
#endif
