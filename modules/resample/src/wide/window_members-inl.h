// The samples that a window's function is fitted to, and their weights. Included once per instruction set.
#if defined(ISOLUX_WIDE_WINDOW_MEMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_WINDOW_MEMBERS_INL_H_
#undef ISOLUX_WIDE_WINDOW_MEMBERS_INL_H_
#else
#define ISOLUX_WIDE_WINDOW_MEMBERS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "wide/denoise_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr hn::CappedTag<float, 16> kF{};
using F = hn::Vec<decltype(kF)>;

/// Place, isovalue, normal, openness.
inline constexpr std::size_t kCoordinates = BinnedSamples::kCoordinates;

/// The samples of the widest window relative to the one that they are about, an array a number.
template <std::size_t kChannels>
struct Members {
  static constexpr std::size_t kMost = WindowLimits::kMost;
  static constexpr std::size_t kNumbers = BinnedSamples::stride(kChannels);

  std::size_t count = 0;
  std::size_t padded = 0;                    ///< whole vectors; the rest repeats the sample itself
  HWY_ALIGN float numbers[kNumbers][kMost];  ///< of BinnedSamples::looks
  HWY_ALIGN float likeness[kMost];           ///< of light, by normals
  HWY_ALIGN float distance[kMost];
  HWY_ALIGN float weights[kWindowCount][kMost];
  HWY_ALIGN float narrowest[kMost];  ///< influence on the narrowest window's light

  void copy(const BinnedSamples& all, std::size_t sample, const NearSamples& near, std::size_t most);
  /// \return the mean variance of like ones
  float measure(std::size_t sample, const BinnedSamples& all, const WindowLimits& limits);
};

/// Four numbers of each of four samples to four arrays.
HWY_INLINE void take_four(const float* const (&from)[4], float* to, std::size_t apart) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t n = 0; n < 4; ++n)
    for (std::size_t a = 0; a < 4; ++a) to[a * apart + n] = from[n][a];
#else
  const hn::FixedTag<float, 4> f;
  const hn::RepartitionToWide<decltype(f)> pairs;
  const auto zero = hn::LoadU(f, from[0]);
  const auto one = hn::LoadU(f, from[1]);
  const auto two = hn::LoadU(f, from[2]);
  const auto three = hn::LoadU(f, from[3]);
  const auto lower01 = hn::BitCast(pairs, hn::InterleaveLower(f, zero, one));
  const auto upper01 = hn::BitCast(pairs, hn::InterleaveUpper(f, zero, one));
  const auto lower23 = hn::BitCast(pairs, hn::InterleaveLower(f, two, three));
  const auto upper23 = hn::BitCast(pairs, hn::InterleaveUpper(f, two, three));
  hn::Store(hn::BitCast(f, hn::InterleaveLower(pairs, lower01, lower23)), f, to);
  hn::Store(hn::BitCast(f, hn::InterleaveUpper(pairs, lower01, lower23)), f, to + apart);
  hn::Store(hn::BitCast(f, hn::InterleaveLower(pairs, upper01, upper23)), f, to + 2 * apart);
  hn::Store(hn::BitCast(f, hn::InterleaveUpper(pairs, upper01, upper23)), f, to + 3 * apart);
#endif
}

template <std::size_t kChannels>
HWY_INLINE void Members<kChannels>::copy(const BinnedSamples& all, std::size_t sample, const NearSamples& near,
                                         std::size_t most) {
  count = std::min({most, near.count, kMost});
  padded = (count + 15) / 16 * 16;  // of the widest vectors, and whole fours of narrower ones
  for (std::size_t n = 0; n < padded; n += 4) {
    const float* from[4];
    for (std::size_t i = 0; i < 4; ++i) from[i] = &all.looks[(n + i < count ? near.samples[n + i] : sample) * kNumbers];
    for (std::size_t a = 0; a < kNumbers; a += 4) {
      take_four(from, &numbers[a][n], kMost);
      for (const float*& f : from) f += 4;
    }
  }
}

template <std::size_t kChannels>
HWY_INLINE float Members<kChannels>::measure(std::size_t sample, const BinnedSamples& all, const WindowLimits& limits) {
  const float* const own = &all.looks[sample * kNumbers];
  auto likenesses = hn::Zero(kF);
  auto variances = hn::Zero(kF);
  for (std::size_t n = 0; n < padded; n += hn::Lanes(kF)) {
    const auto less_own = [&](std::size_t a) { return hn::Sub(hn::Load(kF, numbers[a] + n), hn::Set(kF, own[a])); };
    auto reach = hn::Zero(kF);
    for (std::size_t a = 0; a < BinnedSamples::kNormal; ++a) {
      const auto way = hn::Mul(less_own(a), hn::Set(kF, all.side));
      hn::Store(way, kF, numbers[a] + n);
      if (a < BinnedSamples::kIsovalue) reach = hn::MulAdd(way, way, reach);
    }
    hn::Store(hn::Sqrt(reach), kF, distance + n);
    auto cosine = hn::Zero(kF);
    for (std::size_t a = BinnedSamples::kNormal; a < BinnedSamples::kOpenness; ++a)
      cosine = hn::MulAdd(hn::Load(kF, numbers[a] + n), hn::Set(kF, own[a]), cosine);
    cosine = hn::Max(cosine, hn::Zero(kF));
    const auto like = hn::MulAdd(cosine, cosine, hn::Set(kF, 1e-6f));
    hn::Store(like, kF, likeness + n);
    for (std::size_t a = BinnedSamples::kNormal; a < kCoordinates; ++a)
      hn::Store(hn::Mul(less_own(a), hn::Set(kF, limits.unit)), kF, numbers[a] + n);
    for (std::size_t c = 0; c < kChannels; ++c)
      hn::Store(less_own(BinnedSamples::kLight + c), kF, numbers[BinnedSamples::kLight + c] + n);
    const auto counted = n + hn::Lanes(kF) <= count ? like
                         : n < count                ? hn::IfThenElseZero(hn::FirstN(kF, count - n), like)
                                                    : hn::Zero(kF);
    likenesses = hn::Add(likenesses, counted);
    variances = hn::MulAdd(counted, hn::Load(kF, numbers[BinnedSamples::kVariance] + n), variances);
  }
  return hn::GetLane(hn::SumOfLanes(kF, variances)) / hn::GetLane(hn::SumOfLanes(kF, likenesses));
}

/// The part of a member's weight that all windows share: by normals, and 1 where two samples differ by their noise at
/// most, falling to 0 where by more than `apart`, a squared difference. Steps of light so end a window that place and
/// normals do not.
template <std::size_t kChannels>
HWY_INLINE void tell_sides(Members<kChannels>& members, float apart) {
  const auto scale = hn::Set(kF, 1.0f / (apart * float(kChannels)));
  for (std::size_t n = 0; n < members.padded; n += hn::Lanes(kF)) {
    auto squares = hn::Zero(kF);
    for (std::size_t c = 0; c < kChannels; ++c) {
      const auto less = hn::Load(kF, members.numbers[BinnedSamples::kLight + c] + n);
      squares = hn::MulAdd(less, less, squares);
    }
    const auto ratio = hn::Mul(squares, scale);
    const auto side = hn::Div(hn::Set(kF, 1.0f), hn::MulAdd(hn::Mul(ratio, ratio), ratio, hn::Set(kF, 1.0f)));
    hn::Store(hn::Mul(hn::Load(kF, members.likeness + n), side), kF, members.likeness + n);
  }
}

/// Weights of the first samples in one window, falling with the distance to a quarter. \return whole vectors of them
template <std::size_t kChannels>
HWY_INLINE std::size_t weigh(Members<kChannels>& members, std::size_t window, std::size_t count) {
  const std::size_t lanes = hn::Lanes(kF);
  const std::size_t whole = count / lanes * lanes;
  const std::size_t padded = (count + lanes - 1) / lanes * lanes;
  const auto in_window = hn::FirstN(kF, count - whole);
  auto farthest = hn::Zero(kF);
  for (std::size_t n = 0; n < whole; n += lanes) farthest = hn::Max(farthest, hn::Load(kF, members.distance + n));
  if (whole < padded)
    farthest = hn::Max(farthest, hn::IfThenElseZero(in_window, hn::Load(kF, members.distance + whole)));
  const float far = hn::GetLane(hn::MaxOfLanes(kF, farthest));
  const auto fall = hn::Set(kF, far > 0.0f ? -0.75f / far : 0.0f);
  float* const weights = members.weights[window];
  for (std::size_t n = 0; n < padded; n += lanes) {
    const auto near = hn::MulAdd(fall, hn::Load(kF, members.distance + n), hn::Set(kF, 1.0f));
    hn::Store(hn::Mul(near, hn::Load(kF, members.likeness + n)), kF, weights + n);
  }
  if (whole < padded) hn::Store(hn::IfThenElseZero(in_window, hn::Load(kF, weights + whole)), kF, weights + whole);
  return padded;
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
