#pragma once

#include <array>
#include <cstddef>

namespace isolux {

inline constexpr std::size_t kWindowCount = 3;
inline constexpr double kNoError = 1e-14;  ///< a squared error: 1e-7, that of floats

/// Light fitted in windows of one width, means over the samples around one.
struct WindowAround {
  double apart = 0.0;        ///< squares of how far the fits are from those of the narrowest window
  double noise = 0.0;        ///< a fit's variance where independent samples have one of 1
  double noise_apart = 0.0;  ///< likewise, of its difference from the narrowest window's
};

struct WindowsAround {
  std::array<WindowAround, kWindowCount> windows{};  ///< narrowest first
  double left = 0.0;                                 ///< squares of what the narrowest's fits leave of the samples
  double follows = 0.0;                              ///< the part of a sample in its own fit of these
  double product = 0.0;   ///< of what the narrowest leaves of two neighbours: what it misses, without noise
  double variance = 0.0;  ///< that samples say they have
};

/// Of each window's light, and of the samples' own last; they add up to 1.
using WindowShares = std::array<double, kWindowCount + 1>;

/// By the inverse sixth powers of estimated mean squared errors. What the narrowest fit misses is what it leaves less
/// the noise (Stein, "Estimation of the mean of a multivariate normal distribution", 1981); what a wider one misses
/// more, how far it is from the narrowest less their noise (Lepski, "On a problem of adaptive estimation in Gaussian
/// white noise", 1990): two smooth lights tell that with less noise than the samples.
[[nodiscard]] WindowShares window_shares(const WindowsAround& around);

}  // namespace isolux
