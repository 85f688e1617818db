#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "wide/lattice_samples.h"
#include "window_shares.h"

// What the denoiser asks of each sample, by the machine's vectors: src/denoise.cpp says what for.

namespace isolux::wide {

/// Of the windows about a sample: the nearest shells of the stencil, until there are so many samples in them.
struct WindowLimits {
  std::array<std::size_t, kWindowCount> counts;  ///< samples, rising
  float apart;   ///< standard errors by which samples of one side of an edge differ at most
  float unseen;  ///< a window without a larger variance is left alone
  float ridge;   ///< in parts of the coordinates' own mean spread, pulls slopes to zero
  float unit;    ///< what normals and openness count as, in the stencil's unit of length
};

/// Linear functions fitted to a sample's windows.
struct WindowFits {
  bool is_fitted = false;  ///< else the noise is not to be seen, and there is nothing else
  std::array<std::array<float, 3>, kWindowCount> light{};  ///< at the sample; `channels` of each
  float follows = 1.0f;                                    ///< the part of the sample in the narrowest's
  std::array<float, kWindowCount> noise{};        ///< variance of that light where independent samples have one of 1
  std::array<float, kWindowCount> noise_apart{};  ///< likewise, of its difference from the narrowest window's
};

struct DenoiseKernels {
  static constexpr std::size_t kMostLanes = 16;

  /// Fits the windows of the sample at a point and of those at the points after it along x, at most `lanes`; where
  /// there is none its fits mean nothing.
  void (*fit_row)(const LatticeSamples& all, const std::array<int, 3>& point, const WindowLimits& limits,
                  std::span<WindowFits> fits);
  std::size_t lanes;
};

/// For the instruction set of this machine.
[[nodiscard]] DenoiseKernels denoise_kernels(std::size_t channels);

}  // namespace isolux::wide
