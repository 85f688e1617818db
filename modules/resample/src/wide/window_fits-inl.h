// Linear functions fitted to windows of samples. Included once per instruction set.
#if defined(ISOLUX_WIDE_WINDOW_FITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_WINDOW_FITS_INL_H_
#undef ISOLUX_WIDE_WINDOW_FITS_INL_H_
#else
#define ISOLUX_WIDE_WINDOW_FITS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <utility>

#include "wide/denoise_kernels.h"
#include "wide/eight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

inline constexpr hn::CappedTag<float, 16> kF{};
using F = hn::Vec<decltype(kF)>;

/// Place, isovalue, normal, openness.
inline constexpr std::size_t kCoordinates = BinnedSamples::kCoordinates;
inline constexpr std::size_t kUnknowns = kCoordinates + 1;
/// A window for each lane, and one to spare.
using Windows = Several<double, 4>;

/// The samples of the widest window relative to the one that they are about, an array a number.
template <std::size_t kChannels>
struct Members {
  static constexpr std::size_t kMost = 256;
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
  padded = (count + 15) / 16 * 16;
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

/// Sums over the first samples: moments of the coordinates and the light by weights. `to` has a lane a window.
template <std::size_t kRow, std::size_t kChannels>
HWY_INLINE void add_row(const Members<kChannels>& members, const float* weights, std::size_t padded,
                        double* HWY_RESTRICT to) {
  constexpr std::size_t kColumns = kUnknowns - kRow;
  F sums[kColumns];
  F light[kChannels];
  ISOLUX_UNROLL
  for (std::size_t j = 0; j < kColumns; ++j) sums[j] = hn::Zero(kF);
  ISOLUX_UNROLL
  for (std::size_t c = 0; c < kChannels; ++c) light[c] = hn::Zero(kF);
  for (std::size_t n = 0; n < padded; n += hn::Lanes(kF)) {
    auto w = hn::Load(kF, weights + n);
    if constexpr (kRow == 0) {
      sums[0] = hn::Add(sums[0], w);
    } else {
      const auto own = hn::Load(kF, members.numbers[kRow - 1] + n);
      w = hn::Mul(w, own);
      sums[0] = hn::MulAdd(w, own, sums[0]);
    }
    ISOLUX_UNROLL
    for (std::size_t j = 1; j < kColumns; ++j)
      sums[j] = hn::MulAdd(w, hn::Load(kF, members.numbers[kRow + j - 1] + n), sums[j]);
    ISOLUX_UNROLL
    for (std::size_t c = 0; c < kChannels; ++c)
      light[c] = hn::MulAdd(w, hn::Load(kF, members.numbers[BinnedSamples::kLight + c] + n), light[c]);
  }
  ISOLUX_UNROLL
  for (std::size_t j = 0; j < kColumns; ++j) to[4 * j] = double(hn::GetLane(hn::SumOfLanes(kF, sums[j])));
  ISOLUX_UNROLL
  for (std::size_t c = 0; c < kChannels; ++c)
    to[4 * (kColumns + c)] = double(hn::GetLane(hn::SumOfLanes(kF, light[c])));
}

/// Where a row's moments begin: its columns from its own on, then the light's channels.
template <std::size_t kChannels>
constexpr std::size_t row_start(std::size_t row) {
  std::size_t start = 0;
  for (std::size_t r = 0; r < row; ++r) start += kUnknowns - r + kChannels;
  return start;
}

template <std::size_t kChannels>
struct Moments {
  static constexpr std::size_t kCount = row_start<kChannels>(kUnknowns);
  HWY_ALIGN double sums[kCount][4]{};  ///< a lane a window

  template <std::size_t... kRows>
  HWY_INLINE void add(const Members<kChannels>& members, std::size_t padded, std::size_t window,
                      std::index_sequence<kRows...> /*rows*/) {
    (add_row<kRows, kChannels>(members, members.weights[window], padded, &sums[row_start<kChannels>(kRows)][window]),
     ...);
  }
  [[nodiscard]] HWY_INLINE Windows at(std::size_t row, std::size_t column) const {
    return load<4>(sums[row_start<kChannels>(row) + column - row], 0.0);
  }
  [[nodiscard]] HWY_INLINE Windows light(std::size_t row, std::size_t channel) const {
    return load<4>(sums[row_start<kChannels>(row) + kUnknowns - row + channel], 0.0);
  }
};

/// One over those that are positive, else 0.
HWY_INLINE Windows inverse(const Windows& a) {
  Windows s;
  ISOLUX_UNROLL
  for (std::size_t p = 0; p < Windows::kParts; ++p) {
    const typename Windows::Tag d;
    const auto positive = hn::Gt(a.part[p], hn::Zero(d));
    s.part[p] =
        hn::IfThenElseZero(positive, hn::Div(hn::Set(d, 1.0), hn::IfThenElse(positive, a.part[p], hn::Set(d, 1.0))));
  }
  return s;
}

/// What the windows' functions are at the sample, and how they follow a sample for each unit of its weight: `there` of
/// one at the origin, and `slopes` for each unit of a coordinate.
template <std::size_t kChannels>
struct Solution {
  HWY_ALIGN double light[kChannels][4];  ///< less the sample's own
  HWY_ALIGN double there[4];
  HWY_ALIGN double slopes[kCoordinates][4];

  HWY_INLINE void solve(const Moments<kChannels>& moments, double ridge);
};

/// Lancaster & Salkauskas, "Surfaces generated by moving least squares methods", 1981, of degree one. Slopes are
/// eliminated first, so that what is left is the value's own equation; the light is taken relative to its mean.
template <std::size_t kChannels>
HWY_INLINE void Solution<kChannels>::solve(const Moments<kChannels>& moments, double ridge) {
  constexpr std::size_t kSlopes = kCoordinates;
  Windows a[kUnknowns][kUnknowns];  // lower triangle; the value last
  Windows b[kUnknowns][kChannels];
  const Windows total = moments.at(0, 0);
  const Windows per_total = inverse(total);
  auto held = all<double, 4>(0.0);
  for (std::size_t i = 0; i < kSlopes; ++i) held = add(held, moments.at(i + 1, i + 1));
  held = mul_add(held, all<double, 4>(ridge / double(kSlopes)), mul(total, all<double, 4>(1e-30)));
  Windows mean[kChannels];
  for (std::size_t c = 0; c < kChannels; ++c) {
    mean[c] = mul(moments.light(0, c), per_total);
    b[kSlopes][c] = all<double, 4>(0.0);
  }
  for (std::size_t i = 0; i < kSlopes; ++i) {
    for (std::size_t j = 0; j <= i; ++j) a[i][j] = moments.at(j + 1, i + 1);
    a[i][i] = add(a[i][i], held);
    a[kSlopes][i] = moments.at(0, i + 1);
    for (std::size_t c = 0; c < kChannels; ++c) b[i][c] = sub(moments.light(i + 1, c), mul(a[kSlopes][i], mean[c]));
  }
  a[kSlopes][kSlopes] = total;
  Windows inverses[kSlopes];
  for (std::size_t p = 0; p < kSlopes; ++p) {
    // Positive by the ridge, unless every sample sits at the origin.
    inverses[p] = inverse(a[p][p]);
    for (std::size_t i = p + 1; i < kUnknowns; ++i) {
      const Windows factor = mul(a[i][p], inverses[p]);
      for (std::size_t j = p + 1; j <= i; ++j) a[i][j] = sub(a[i][j], mul(factor, a[j][p]));
      for (std::size_t c = 0; c < kChannels; ++c) b[i][c] = sub(b[i][c], mul(factor, b[p][c]));
    }
  }
  Windows value;
  Windows sound;  // 1, or 0 where the samples do not tell slopes: the mean is left
  for (std::size_t p = 0; p < Windows::kParts; ++p) {
    const typename Windows::Tag d;
    const auto pivot = a[kSlopes][kSlopes].part[p];
    const auto tells = hn::Gt(pivot, hn::Mul(total.part[p], hn::Set(d, 1e-6)));
    sound.part[p] = hn::IfThenElseZero(tells, hn::Set(d, 1.0));
    value.part[p] = hn::IfThenElse(tells, pivot, total.part[p]);
  }
  const Windows follows = inverse(value);
  store(follows, there);
  for (std::size_t c = 0; c < kChannels; ++c) store(mul_add(mul(b[kSlopes][c], follows), sound, mean[c]), light[c]);
  // The matrix's inverse times the value's unit vector, of which elimination has left the last row alone.
  Windows turned[kSlopes];
  for (std::size_t p = kSlopes; p-- > 0;) {
    Windows sum = mul(a[kSlopes][p], follows);
    for (std::size_t j = p + 1; j < kSlopes; ++j) sum = mul_add(a[j][p], turned[j], sum);
    turned[p] = mul(sub(all<double, 4>(0.0), mul(sum, inverses[p])), sound);
    store(turned[p], slopes[p]);
  }
}

/// Variance of two windows' lights where independent samples have one of 1: this one's, and of its difference from the
/// narrowest.
struct Noise {
  float own, apart;
};

template <std::size_t kChannels>
HWY_INLINE Noise noise_of(Members<kChannels>& members, std::size_t padded, const Solution<kChannels>& solution,
                          std::size_t window) {
  F slopes[kCoordinates];
  ISOLUX_UNROLL
  for (std::size_t a = 0; a < kCoordinates; ++a) slopes[a] = hn::Set(kF, float(solution.slopes[a][window]));
  const auto there = hn::Set(kF, float(solution.there[window]));
  auto own = hn::Zero(kF);
  auto apart = hn::Zero(kF);
  for (std::size_t n = 0; n < padded; n += hn::Lanes(kF)) {
    auto part = there;
    ISOLUX_UNROLL
    for (std::size_t a = 0; a < kCoordinates; ++a)
      part = hn::MulAdd(slopes[a], hn::Load(kF, members.numbers[a] + n), part);
    part = hn::Mul(part, hn::Load(kF, members.weights[window] + n));
    if (window == 0) hn::Store(part, kF, members.narrowest + n);
    own = hn::MulAdd(part, part, own);
    const auto more = hn::Sub(part, hn::Load(kF, members.narrowest + n));
    apart = hn::MulAdd(more, more, apart);
  }
  return {hn::GetLane(hn::SumOfLanes(kF, own)), hn::GetLane(hn::SumOfLanes(kF, apart))};
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

template <std::size_t kChannels>
bool fit(const BinnedSamples& all, std::size_t sample, const NearSamples& near, const WindowLimits& limits,
         WindowFits& fits) {
  static thread_local Members<kChannels> members;
  members.copy(all, sample, near, limits.counts.back());
  const float* const variances = members.numbers[BinnedSamples::kVariance];
  if (std::all_of(variances, variances + members.count, [&](float v) { return v <= limits.unseen; })) return false;
  const float variance = members.measure(sample, all, limits);
  tell_sides(members, limits.apart * limits.apart * variance + float(kNoError));

  static thread_local Moments<kChannels> moments;  // the lane to spare stays 0
  std::array<std::size_t, kWindowCount> padded;
  for (std::size_t w = 0; w < kWindowCount; ++w) {
    padded[w] = weigh(members, w, std::min(limits.counts[w], members.count));
    moments.add(members, padded[w], w, std::make_index_sequence<kUnknowns>());
  }
  std::fill_n(members.narrowest, members.padded, 0.0f);
  Solution<kChannels> solution;
  solution.solve(moments, double(limits.ridge));
  const float* const own = &all.looks[sample * members.kNumbers + BinnedSamples::kLight];
  for (std::size_t w = 0; w < kWindowCount; ++w) {
    for (std::size_t c = 0; c < kChannels; ++c) fits.light[w][c] = float(double(own[c]) + solution.light[c][w]);
    const Noise noise = noise_of(members, padded[w], solution, w);
    fits.noise[w] = noise.own;
    fits.noise_apart[w] = noise.apart;
  }
  fits.follows = float(std::min(1.0, solution.there[0]));
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
