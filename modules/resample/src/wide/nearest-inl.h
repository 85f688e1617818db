// The nearest of samples in bins. Included once per instruction set.
#if defined(ISOLUX_WIDE_NEAREST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_NEAREST_INL_H_
#undef ISOLUX_WIDE_NEAREST_INL_H_
#else
#define ISOLUX_WIDE_NEAREST_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "wide/denoise_kernels.h"
#include "wide/distance_classes.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Where a search looks: the samples within a distance of one.
struct Ball {
  const BinnedSamples& all;
  std::array<float, 3> centre;
  float bound;  ///< its square

  /// The bins along an axis that a distance reaches.
  struct Span {
    int first, last;
  };
  [[nodiscard]] Span span(std::size_t axis, float distance) const {
    const float most = float(all.bins[axis] - 1);
    // A little more than the distance, as it has been rounded.
    const float reach = distance * 1.0001f + 1e-4f;
    return {int(std::clamp(centre[axis] - reach, 0.0f, most)), int(std::clamp(centre[axis] + reach, 0.0f, most))};
  }
  /// Square of the way along an axis to a bin.
  [[nodiscard]] float gap(std::size_t axis, int bin) const {
    const float way = std::max({float(bin) - centre[axis], centre[axis] - float(bin + 1), 0.0f});
    return way * way;
  }
};

/// Writes the samples of the bins that a ball touches, with the classes of their distances, at most `last`.
HWY_INLINE std::size_t look_about(const Ball& ball, std::int32_t last, NearSamples& near) {
  const hn::CappedTag<float, 16> f;
  const hn::RebindToSigned<decltype(f)> i;
  const hn::RebindToUnsigned<decltype(f)> u;
  const std::size_t lanes = hn::Lanes(f);
  const BinnedSamples& all = ball.all;
  std::array<const float*, 3> places;
  for (std::size_t a = 0; a < 3; ++a) places[a] = all.places[a].data();
  const auto x = hn::Set(f, ball.centre[0]);
  const auto y = hn::Set(f, ball.centre[1]);
  const auto z = hn::Set(f, ball.centre[2]);
  const auto first_class = hn::Set(i, kFirstClass);
  const auto last_class = hn::Set(i, last);
  const auto from_zero = hn::Iota(u, 0u);
  std::size_t count = 0;
  const float distance = std::sqrt(ball.bound);
  const auto [k0, k1] = ball.span(2, distance);
  const auto [j0, j1] = ball.span(1, distance);
  for (int k = k0; k <= k1; ++k) {
    const float left_z = ball.bound - ball.gap(2, k);
    for (int j = j0; j <= j1; ++j) {
      const float left = left_z - ball.gap(1, j);
      if (left < 0.0f) continue;
      const auto [i0, i1] = ball.span(0, std::sqrt(left));
      const std::size_t row = (std::size_t(k) * std::size_t(all.bins[1]) + std::size_t(j)) * std::size_t(all.bins[0]);
      const std::size_t begin = all.starts[row + std::size_t(i0)];
      const std::size_t end = all.starts[row + std::size_t(i1) + 1];
      if (near.candidates.size() < count + (end - begin) + lanes) {
        near.candidates.resize(2 * (count + (end - begin) + lanes));
        near.classes.resize(near.candidates.size());
      }
      for (std::size_t e = begin; e < end; e += lanes) {
        const auto dx = hn::Sub(hn::LoadU(f, places[0] + e), x);
        const auto dy = hn::Sub(hn::LoadU(f, places[1] + e), y);
        const auto dz = hn::Sub(hn::LoadU(f, places[2] + e), z);
        const auto reach = hn::Add(hn::Mul(dx, dx), hn::Add(hn::Mul(dy, dy), hn::Mul(dz, dz)));
        const auto klass = hn::Sub(hn::ShiftRight<kClassShift>(hn::BitCast(i, reach)), first_class);
        hn::StoreU(hn::Min(hn::Max(klass, hn::Zero(i)), last_class), i, near.classes.data() + count + (e - begin));
        hn::StoreU(hn::Add(from_zero, hn::Set(u, std::uint32_t(e))), u, near.candidates.data() + count + (e - begin));
      }
      count += end - begin;
    }
  }
  return count;
}

/// Takes the stencil's samples. \return false where it leaves the box or bins are empty
inline bool take_stencil(const BinnedSamples& all, std::size_t sample, std::size_t wanted, NearSamples& near) {
  const Stencil& stencil = all.stencil;
  if (wanted > stencil.offsets.size()) return false;
  std::array<std::int32_t, 3> bin;
  for (std::size_t a = 0; a < 3; ++a) {
    bin[a] = std::int32_t(all.places[a][sample]);
    const std::int32_t far = stencil.far[wanted - 1][a];
    if (bin[a] < far || bin[a] >= all.bins[a] - far) return false;
  }
  if (near.samples.size() < wanted) near.samples.resize(wanted);
  const std::uint32_t* const here =
      &all.starts[std::size_t((bin[2] * all.bins[1] + bin[1])) * std::size_t(all.bins[0]) + std::size_t(bin[0])];
  std::uint32_t* const samples = near.samples.data();
  std::uint32_t full = 0;
  for (std::size_t n = 0; n < wanted; ++n) {
    const std::uint32_t* const there = here + stencil.offsets[n];
    samples[n] = there[0];
    full += there[1] - there[0];
  }
  near.count = wanted;
  return full == wanted;
}

inline void nearest(const BinnedSamples& all, std::size_t sample, std::size_t wanted, NearSamples& near) {
  if (!all.stencil.offsets.empty() && take_stencil(all, sample, wanted, near)) return;
  std::array<float, 3> centre;
  for (std::size_t a = 0; a < 3; ++a) centre[a] = all.places[a][sample];
  std::array<std::uint32_t, std::size_t(kClasses) + 1> starts;
  for (float bound = near.bound;; bound *= 1.5f) {
    // Samples of this class may be missing, those of lower ones are all there.
    const std::int32_t open = class_of(bound);
    const std::size_t found = look_about({.all = all, .centre = centre, .bound = bound}, open, near);
    const bool all_found = found == all.size();
    std::fill_n(starts.begin(), open + 2, 0u);
    const std::int32_t* classes = near.classes.data();
    for (std::size_t c = 0; c < found; ++c) ++starts[std::size_t(classes[c])];
    std::uint32_t sum = 0;
    std::int32_t last = 0;
    for (; last <= open; ++last) {
      const std::uint32_t here = starts[std::size_t(last)];
      starts[std::size_t(last)] = sum;
      sum += here;
      if (sum >= wanted) break;
    }
    const bool sorted = last < open || (all_found && (found <= wanted || open == kClasses - 1));
    if (!sorted) continue;
    // What lies beyond the last class goes behind it, in no order.
    last = std::min(last, open);
    starts[std::size_t(last) + 1] = sum;
    if (near.samples.size() < found) near.samples.resize(2 * found);
    std::uint32_t* samples = near.samples.data();
    for (std::size_t c = 0; c < found; ++c)
      samples[starts[std::size_t(std::min(classes[c], last + 1))]++] = near.candidates[c];
    near.count = std::min(wanted, found);
    near.bound = std::bit_cast<float>((last + kFirstClass + 2) << kClassShift);
    return;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
