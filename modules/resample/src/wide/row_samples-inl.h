// The samples about those that are side by side on a lattice, one of these a lane. Included once per instruction set.
#if defined(ISOLUX_WIDE_ROW_SAMPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_ROW_SAMPLES_INL_H_
#undef ISOLUX_WIDE_ROW_SAMPLES_INL_H_
#else
#define ISOLUX_WIDE_ROW_SAMPLES_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wide/lattice_samples.h"
#include "wide/sample_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

inline constexpr std::size_t kRowLanes = hn::MaxLanes(kF);

/// The stencils of samples at points along x.
template <std::size_t kChannels>
class RowSamples {
 public:
  /// For rows of a stencil.
  void prepare(const Stencil& stencil) {
    span_ = (kRowLanes + 2 * std::size_t(stencil.reach) + kPad - 1) / kPad * kPad;
    numbers_.resize(stencil.rows.size() * kNumbers * span_ + kPad);
  }

  /// Copies the samples along a row of the stencil.
  void copy(const LatticeSamples& all, const std::array<int, 3>& point, std::size_t r) {
    static constexpr std::array<float, kNumbers> kNothing = [] {
      std::array<float, kNumbers> look{};
      look[LatticeSamples::kVariance] = -1.0f;
      return look;
    }();
    const Stencil::Row& row = all.stencil.rows[r];
    const int y = point[1] + row.y;
    const int z = point[2] + row.z;
    const bool outside = y < 0 || y >= all.size[1] || z < 0 || z >= all.size[2];
    const std::uint32_t* const samples = &all.at[outside ? 0 : all.row(y, z)];
    int x = point[0] - row.reach;
    for (std::size_t n = 0; n < kRowLanes + 2 * std::size_t(row.reach); n += 4) {
      const float* from[4];
      for (std::size_t i = 0; i < 4; ++i, ++x) {
        const bool held = !outside && x >= 0 && x < all.size[0] && samples[x] != LatticeSamples::kNone;
        from[i] = held ? all.look(samples[x]) : kNothing.data();
      }
      for (std::size_t a = 0; a < kNumbers; a += 4) {
        take_four(from, numbers(r, a) + n, span_);
        for (const float*& f : from) f += 4;
      }
    }
  }

  /// Says which samples those in the middle are. \pre the first row is copied
  void begin(const Stencil& stencil) {
    for (std::size_t a = 0; a < kNumbers; ++a) hn::Store(number(stencil.members[0], a), kF, own_[a]);
  }
  [[nodiscard]] const float* own(std::size_t a) const { return own_[a]; }

  [[nodiscard]] HWY_INLINE F number(const Stencil::Member& member, std::size_t a) const {
    return hn::LoadU(kF, numbers(member.row, a) + member.along);
  }
  [[nodiscard]] HWY_INLINE F relative(const Stencil::Member& member, std::size_t a) const {
    return hn::Sub(number(member, a), hn::Load(kF, own_[a]));
  }
  [[nodiscard]] HWY_INLINE F coordinate(const Stencil::Member& member, std::size_t a) const {
    return a < LatticeSamples::kPlaces ? hn::Set(kF, member.place[a]) : relative(member, a - LatticeSamples::kPlaces);
  }

 private:
  static constexpr std::size_t kNumbers = LatticeSamples::stride(kChannels);
  static constexpr std::size_t kPad = 16;

  /// One number of a look, along a row.
  [[nodiscard]] HWY_INLINE float* numbers(std::size_t row, std::size_t a) {
    return &numbers_[(row * kNumbers + a) * span_];
  }
  [[nodiscard]] HWY_INLINE const float* numbers(std::size_t row, std::size_t a) const {
    return &numbers_[(row * kNumbers + a) * span_];
  }

  std::size_t span_ = 0;        ///< of a row
  std::vector<float> numbers_;  ///< of looks, along each of the stencil's rows
  HWY_ALIGN float own_[kNumbers][kRowLanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
