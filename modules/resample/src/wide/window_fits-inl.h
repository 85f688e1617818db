// Linear functions fitted to the windows of samples that are side by side on a lattice, one a lane. Included once per
// instruction set.
#if defined(ISOLUX_WIDE_WINDOW_FITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOLUX_WIDE_WINDOW_FITS_INL_H_
#undef ISOLUX_WIDE_WINDOW_FITS_INL_H_
#else
#define ISOLUX_WIDE_WINDOW_FITS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "wide/denoise_kernels.h"
#include "wide/eight-inl.h"
#include "wide/lattice_samples.h"
#include "wide/row_samples-inl.h"
#include "wide/sample_vectors-inl.h"
#include "wide/window_solution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// So many lanes are solved at once, in doubles.
inline constexpr std::size_t kSolvedLanes = std::min<std::size_t>(kRowLanes, 8);

/// The windows of a lane's sample, and of the next ones along x in the lanes that follow.
template <std::size_t kChannels>
class RowWindows {
 public:
  RowWindows() = default;

  /// Of the sample at a point, and of those after it along x.
  void fit(const LatticeSamples& all, const std::array<int, 3>& point, const WindowLimits& limits,
           std::span<WindowFits> fits) {
    compare(all, point, limits);
    bool any = false;
    for (std::size_t n = 0; n < fits.size(); ++n) any |= fits[n].is_fitted = variance_[n] > limits.unseen;
    if (!any) return;
    weigh(all.stencil);
    std::array<double, kUnknowns> units;  // of the coordinates
    units.fill(1.0);
    std::fill(units.begin() + 1 + LatticeSamples::kPlaces + LatticeSamples::kNormal, units.end(), double(limits.unit));
    for (std::size_t w = 0; w < kWindowCount; ++w)
      for (std::size_t lane = 0; lane < kRowLanes; lane += kSolvedLanes)
        solve(w, lane, units, double(limits.ridge), fits);
    measure_noise(all.stencil, fits);
  }

 private:
  static constexpr std::size_t kMoments = row_start<kChannels>(kUnknowns);
  static constexpr std::size_t kWeight = kCoordinates + kChannels;

  /// Sums of one window as Solution asks for them.
  struct Sums {
    const float (*moments)[kRowLanes];
    std::size_t lane;
    const std::array<double, kUnknowns>& units;

    [[nodiscard]] HWY_INLINE Several<double, kSolvedLanes> at(std::size_t row, std::size_t column) const {
      return of(row_start<kChannels>(row) + column - row, units[row] * units[column]);
    }
    [[nodiscard]] HWY_INLINE Several<double, kSolvedLanes> light(std::size_t row, std::size_t channel) const {
      return of(row_start<kChannels>(row) + kUnknowns - row + channel, units[row]);
    }
    [[nodiscard]] HWY_INLINE Several<double, kSolvedLanes> of(std::size_t moment, double unit) const {
      return mul(load<kSolvedLanes>(moments[moment] + lane, 0.0), all<double, kSolvedLanes>(unit));
    }
  };

  /// Copies shells, nearest first, until every sample's widest window is full, and says how alike members are in light,
  /// by normals and by light itself: 0 of those that are not there or not in the widest window.
  void compare(const LatticeSamples& all, const std::array<int, 3>& point, const WindowLimits& limits) {
    const Stencil& stencil = all.stencil;
    samples_.prepare(stencil);
    samples_.copy(all, point, 0);
    samples_.begin(stencil);
    const auto none = hn::Zero(kF);
    F likenesses = none;
    F variances = none;
    F largest = none;
    F count = none;
    F far[kWindowCount] = {none, none, none};
    const auto wanted = hn::Set(kF, float(limits.counts.back()));
    const auto held = hn::Ge(hn::Load(kF, samples_.own(LatticeSamples::kVariance)), none);
    std::size_t rows = 1;
    std::size_t m = 0;
    members_.clear();
    shell_ends_.clear();
    for (const Stencil::Shell& shell : stencil.shells) {
      const auto open = hn::And(held, hn::Lt(count, wanted));
      if (hn::AllFalse(kF, open)) break;
      for (; rows < shell.rows; ++rows) samples_.copy(all, point, rows);
      const auto before = count;
      for (; m < shell.end; ++m) {
        const Stencil::Member& member = stencil.members[m];
        auto cosine = none;
        ISOLUX_UNROLL
        for (std::size_t a = LatticeSamples::kNormal; a < LatticeSamples::kOpenness; ++a)
          cosine = hn::MulAdd(samples_.number(member, a), hn::Load(kF, samples_.own(a)), cosine);
        const auto variance = samples_.number(member, LatticeSamples::kVariance);
        const auto is_there = hn::And(open, hn::Ge(variance, none));
        if (hn::AllFalse(kF, is_there)) continue;
        const auto like = hn::IfThenElseZero(is_there, like_by(cosine));
        hn::Store(like, kF, likeness_[members_.size()]);
        members_.push_back(&member);
        count = hn::Add(count, hn::IfThenElseZero(is_there, hn::Set(kF, 1.0f)));
        likenesses = hn::Add(likenesses, like);
        variances = hn::MulAdd(like, variance, variances);
        largest = hn::Max(largest, hn::IfThenElseZero(is_there, variance));
      }
      shell_ends_.push_back(members_.size());
      const auto more = hn::Gt(count, before);
      for (std::size_t w = 0; w < kWindowCount; ++w) {
        const auto reaches = hn::And(more, hn::Lt(before, hn::Set(kF, float(limits.counts[w]))));
        far[w] = hn::IfThenElse(reaches, hn::Set(kF, shell.distance), far[w]);
      }
    }
    hn::Store(largest, kF, variance_);
    for (std::size_t w = 0; w < kWindowCount; ++w) hn::Store(far[w], kF, far_[w]);
    const auto mean = hn::Div(variances, hn::Max(likenesses, hn::Set(kF, 1e-6f)));
    tell_sides(hn::Mul(mean, hn::Set(kF, limits.apart * limits.apart)));
  }

  /// Members whose light is apart by much more than that, squared, are no longer alike: steps of light so end a window
  /// that place and normals do not.
  void tell_sides(F apart) {
    const auto scale = hn::Div(hn::Set(kF, 1.0f / float(kChannels)), hn::Add(apart, hn::Set(kF, float(kNoError))));
    for (std::size_t m = 0; m < members_.size(); ++m) {
      auto squares = hn::Zero(kF);
      for (std::size_t c = 0; c < kChannels; ++c) {
        const auto less = samples_.relative(*members_[m], LatticeSamples::kLight + c);
        squares = hn::MulAdd(less, less, squares);
      }
      const auto side = same_side(hn::Mul(squares, scale));
      hn::Store(hn::Mul(hn::Load(kF, likeness_[m]), side), kF, likeness_[m]);
    }
  }

  /// How much the members of a shell count in a window, beside their likeness.
  [[nodiscard]] HWY_INLINE F share(const Stencil::Shell& shell, std::size_t window) const {
    const auto far = hn::Load(kF, far_[window]);
    const auto distance = hn::Set(kF, shell.distance);
    const auto fall = hn::Div(hn::Mul(distance, hn::Set(kF, 0.75f)), hn::Max(far, hn::Set(kF, 1e-6f)));
    return hn::IfThenElseZero(hn::Le(distance, far), hn::Sub(hn::Set(kF, 1.0f), fall));
  }
  /// The first that any of them are in, kWindowCount if there is none.
  [[nodiscard]] HWY_INLINE std::size_t first_window(const Stencil::Shell& shell) const {
    std::size_t window = 0;
    const auto distance = hn::Set(kF, shell.distance);
    while (window < kWindowCount && hn::AllFalse(kF, hn::Le(distance, hn::Load(kF, far_[window])))) ++window;
    return window;
  }

  /// Sums the windows' moments, shell by shell.
  void weigh(const Stencil& stencil) {
    for (auto& window : moments_)
      for (auto& moment : window) hn::Store(hn::Zero(kF), kF, moment);
    std::size_t m = 0;
    for (std::size_t s = 0; s < shell_ends_.size(); ++s) {
      const Stencil::Shell& shell = stencil.shells[s];
      std::size_t count = 0;
      for (; m < shell_ends_[s]; ++m, ++count) {
        const Stencil::Member& member = *members_[m];
        for (std::size_t a = 0; a < kCoordinates; ++a) hn::Store(samples_.coordinate(member, a), kF, shell_[count][a]);
        for (std::size_t c = 0; c < kChannels; ++c)
          hn::Store(samples_.relative(member, LatticeSamples::kLight + c), kF, shell_[count][kCoordinates + c]);
        hn::Store(hn::Load(kF, likeness_[m]), kF, shell_[count][kWeight]);
      }
      if (count > 0) add_rows(shell, count, std::make_index_sequence<kUnknowns>());
    }
  }
  template <std::size_t... kRows>
  HWY_INLINE void add_rows(const Stencil::Shell& shell, std::size_t count, std::index_sequence<kRows...> /*rows*/) {
    (add_row<kRows>(shell, count), ...);
  }
  /// Of the first members of shell_.
  template <std::size_t kRow>
  HWY_INLINE void add_row(const Stencil::Shell& shell, std::size_t count) {
    constexpr std::size_t kSums = kUnknowns - kRow + kChannels;
    F sums[kSums];
    ISOLUX_UNROLL
    for (std::size_t j = 0; j < kSums; ++j) sums[j] = hn::Zero(kF);
    for (std::size_t n = 0; n < count; ++n) {
      const auto& member = shell_[n];
      auto w = hn::Load(kF, member[kWeight]);
      if constexpr (kRow == 0) {
        sums[0] = hn::Add(sums[0], w);
      } else {
        const auto own = hn::Load(kF, member[kRow - 1]);
        w = hn::Mul(w, own);
        sums[0] = hn::MulAdd(w, own, sums[0]);
      }
      // What follows a row's own coordinate, the light last.
      ISOLUX_UNROLL
      for (std::size_t j = 1; j < kSums; ++j) sums[j] = hn::MulAdd(w, hn::Load(kF, member[kRow + j - 1]), sums[j]);
    }
    for (std::size_t w = first_window(shell); w < kWindowCount; ++w) {
      const auto part = share(shell, w);
      float(*const to)[kRowLanes] = moments_[w] + row_start<kChannels>(kRow);
      ISOLUX_UNROLL
      for (std::size_t j = 0; j < kSums; ++j) hn::Store(hn::MulAdd(part, sums[j], hn::Load(kF, to[j])), kF, to[j]);
    }
  }

  void solve(std::size_t window, std::size_t lane, const std::array<double, kUnknowns>& units, double ridge,
             std::span<WindowFits> fits) {
    Solution<kChannels, kSolvedLanes> solution;
    solution.solve(Sums{.moments = moments_[window], .lane = lane, .units = units}, ridge);
    for (std::size_t n = 0; n < kSolvedLanes; ++n) {
      there_[window][lane + n] = float(solution.there[n]);
      for (std::size_t a = 0; a < kCoordinates; ++a)
        slopes_[window][a][lane + n] = float(solution.slopes[a][n] * units[a + 1]);
      if (lane + n >= fits.size()) continue;
      WindowFits& fit = fits[lane + n];
      if (window == 0) fit.follows = float(std::min(1.0, solution.there[n]));
      for (std::size_t c = 0; c < kChannels; ++c)
        fit.light[window][c] = float(double(samples_.own(LatticeSamples::kLight + c)[lane + n]) + solution.light[c][n]);
    }
  }

  /// Variances of the windows' lights, and of their differences from the narrowest's.
  void measure_noise(const Stencil& stencil, std::span<WindowFits> fits) {
    F own[kWindowCount];
    F apart[kWindowCount];
    for (std::size_t w = 0; w < kWindowCount; ++w) own[w] = apart[w] = hn::Zero(kF);
    std::size_t m = 0;
    for (std::size_t s = 0; s < shell_ends_.size(); ++s) {
      const Stencil::Shell& shell = stencil.shells[s];
      const std::size_t first = first_window(shell);
      F shares[kWindowCount];
      for (std::size_t w = 0; w < kWindowCount; ++w) shares[w] = share(shell, w);
      for (; m < shell_ends_[s]; ++m) {
        F at[kCoordinates];
        ISOLUX_UNROLL
        for (std::size_t a = 0; a < kCoordinates; ++a) at[a] = samples_.coordinate(*members_[m], a);
        const auto like = hn::Load(kF, likeness_[m]);
        auto narrowest = hn::Zero(kF);
        ISOLUX_UNROLL
        for (std::size_t w = 0; w < kWindowCount; ++w) {
          if (w < first) continue;
          auto part = hn::Load(kF, there_[w]);
          ISOLUX_UNROLL
          for (std::size_t a = 0; a < kCoordinates; ++a) part = hn::MulAdd(hn::Load(kF, slopes_[w][a]), at[a], part);
          part = hn::Mul(part, hn::Mul(like, shares[w]));
          if (w == 0) narrowest = part;
          own[w] = hn::MulAdd(part, part, own[w]);
          const auto more = hn::Sub(part, narrowest);
          apart[w] = hn::MulAdd(more, more, apart[w]);
        }
      }
    }
    HWY_ALIGN std::array<float, kRowLanes> lanes;
    for (std::size_t w = 0; w < kWindowCount; ++w) {
      hn::Store(own[w], kF, lanes.data());
      for (std::size_t n = 0; n < fits.size(); ++n) fits[n].noise[w] = lanes[n];
      hn::Store(apart[w], kF, lanes.data());
      for (std::size_t n = 0; n < fits.size(); ++n) fits[n].noise_apart[w] = lanes[n];
    }
  }

  RowSamples<kChannels> samples_;
  HWY_ALIGN float variance_[kRowLanes];           ///< the largest in the widest window
  HWY_ALIGN float far_[kWindowCount][kRowLanes];  ///< how far windows reach
  std::vector<const Stencil::Member*> members_;   ///< that are there in any window, nearest first
  std::vector<std::size_t> shell_ends_;           ///< of these, for each shell that a window reaches
  HWY_ALIGN float likeness_[Stencil::kMostMembers][kRowLanes];
  HWY_ALIGN float shell_[Stencil::kLargestShell][kWeight + 1][kRowLanes];  ///< coordinates, light and likeness
  HWY_ALIGN float moments_[kWindowCount][kMoments][kRowLanes];
  HWY_ALIGN float there_[kWindowCount][kRowLanes];
  HWY_ALIGN float slopes_[kWindowCount][kCoordinates][kRowLanes];
};

template <std::size_t kChannels>
void fit_row(const LatticeSamples& all, const std::array<int, 3>& point, const WindowLimits& limits,
             std::span<WindowFits> fits) {
  static thread_local const auto windows = std::make_unique<RowWindows<kChannels>>();
  windows->fit(all, point, limits, fits);
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();
#endif
