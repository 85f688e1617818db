#pragma once

#include <array>
#include <cstddef>

#include "window_shares.h"

namespace isolux {

/// What the windows of one sample say of it, to be averaged over the samples around: WindowsAround's numbers.
struct WindowFindings {
  std::array<float, kWindowCount> apart{};
  std::array<float, kWindowCount> noise{1.0f, 1.0f, 1.0f};
  std::array<float, kWindowCount> noise_apart{};
  float left = 0.0f;
  float follows = 1.0f;
  float product = 0.0f;
  float variance = 0.0f;
};

/// Their weighted mean.
class MeanFindings {
 public:
  void add(float weight, const WindowFindings& found) {
    weights_ += weight;
    for (std::size_t k = 0; k < kWindowCount; ++k) {
      sums_.apart[k] += weight * found.apart[k];
      sums_.noise[k] += weight * found.noise[k];
      sums_.noise_apart[k] += weight * found.noise_apart[k];
    }
    sums_.left += weight * found.left;
    sums_.follows += weight * found.follows;
    sums_.product += weight * found.product;
    sums_.variance += weight * found.variance;
  }

  [[nodiscard]] WindowsAround mean() const {
    const double part = 1.0 / double(weights_);
    WindowsAround around{.left = part * double(sums_.left),
                         .follows = part * double(sums_.follows),
                         .product = part * double(sums_.product),
                         .variance = part * double(sums_.variance)};
    for (std::size_t k = 0; k < kWindowCount; ++k) {
      around.windows[k] = {.apart = part * double(sums_.apart[k]),
                           .noise = part * double(sums_.noise[k]),
                           .noise_apart = part * double(sums_.noise_apart[k])};
    }
    return around;
  }

 private:
  WindowFindings sums_{.noise = {}, .follows = 0.0f};
  float weights_ = 0.0f;
};

}  // namespace isolux
