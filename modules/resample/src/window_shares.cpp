#include "window_shares.h"

#include <algorithm>

namespace isolux {
namespace {

/// A site's own variance is known within this factor: on the whole it is right, but few rays that agree by chance, or
/// because of where their strata lie, say less than there is.
constexpr double kVarianceFactor = 4.0;
/// What reading between texels leaves of the noise of their own rays, which it averages (30 % of independent noise at
/// random points, less of nets), and of what a fit misses or of its noise, which neighbours share, it leaves all.
constexpr double kReadNoise = 0.25;
/// Of the noise of independent samples, what differences of means over neighbours have: these share nets.
constexpr double kSharedNets = 0.5;

}  // namespace

WindowShares window_shares(const WindowsAround& around) {
  const WindowAround& narrowest = around.windows[0];
  const double seen = (around.left - std::max(0.0, around.product)) / (1.0 - std::min(around.follows, 0.9));
  const double noise = std::clamp(seen, 0.0, kVarianceFactor * around.variance);
  const double least_missed = std::max(0.0, around.left - noise * (1.0 - 2.0 * around.follows + narrowest.noise));
  WindowShares shares{};
  double sum = 0.0;
  for (std::size_t k = 0; k <= kWindowCount; ++k) {
    double risk = kReadNoise * noise;
    if (k < kWindowCount) {
      const WindowAround& window = around.windows[k];
      const double more_missed = window.apart - kSharedNets * noise * window.noise_apart;
      risk = least_missed + std::max(0.0, more_missed) + noise * window.noise;
    }
    const double cube = (risk + kNoError) * (risk + kNoError) * (risk + kNoError);
    shares[k] = 1.0 / (cube * cube);
    sum += shares[k];
  }
  for (double& share : shares) share /= sum;
  return shares;
}

}  // namespace isolux
