#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "window_shares.h"

// What the denoiser asks of each sample, by the machine's vectors: src/denoise.cpp says what for.

namespace isolux::wide {

/// The bins around one, nearest first, as nearest() orders samples that are at the same place in their bins.
struct Stencil {
  std::vector<std::int32_t> offsets;             ///< to their place in BinnedSamples::starts
  std::vector<std::array<std::int32_t, 3>> far;  ///< how far this one and those before it reach along each axis

  /// So many of `bins`.
  static Stencil of(const std::array<int, 3>& bins, std::size_t count);
};

/// Samples in the order of bins (BinOrder). `places` go on for kPastTheEnd more, which vectors may read.
struct BinnedSamples {
  static constexpr std::size_t kPastTheEnd = 16;
  // Of a sample's look: ten coordinates, the place first, and what is fitted over them. Places are in sides of bins.
  static constexpr std::size_t kIsovalue = 3;
  static constexpr std::size_t kNormal = 4;
  static constexpr std::size_t kOpenness = 7;
  static constexpr std::size_t kCoordinates = 10;
  static constexpr std::size_t kVariance = 10;
  static constexpr std::size_t kLight = 11;

  std::array<int, 3> bins{1, 1, 1};
  std::vector<std::uint32_t> starts;
  float side = 1.0f;                         ///< of a bin, mean grid spacings
  std::array<std::vector<float>, 3> places;  ///< x, y, z again
  Stencil stencil;                           ///< where samples are at the same place in each bin, one in a bin at most
  std::size_t channels = 1;                  ///< 1 or 3
  std::vector<float> looks;                  ///< one after the other, in whole fours

  [[nodiscard]] std::size_t size() const { return looks.size() / stride(); }
  [[nodiscard]] std::size_t stride() const { return stride(channels); }
  [[nodiscard]] static constexpr std::size_t stride(std::size_t channels) { return (kLight + channels + 3) / 4 * 4; }
  [[nodiscard]] const float* look(std::size_t sample) const { return &looks[sample * stride()]; }
  [[nodiscard]] float* look(std::size_t sample) { return &looks[sample * stride()]; }
};

/// The samples nearest to one, and what a search goes on from: results do not depend on it, only the time does.
struct NearSamples {
  std::size_t count = 0;
  std::vector<std::uint32_t> samples;  ///< nearest first; those past `count` mean nothing
  float bound = 16.0f;                 ///< square of the distance that the next search begins with, sides of bins

  std::vector<std::uint32_t> candidates;  ///< scratch
  std::vector<std::int32_t> classes;      ///< of their distances
};

/// Of the windows about a sample.
struct WindowLimits {
  static constexpr std::size_t kMost = 256;

  std::array<std::size_t, kWindowCount> counts;  ///< samples, rising, at most kMost
  float apart;   ///< standard errors by which samples of one side of an edge differ at most
  float unseen;  ///< a window without a larger variance is left alone
  float ridge;   ///< in parts of the coordinates' own mean spread, pulls slopes to zero
  float unit;    ///< what normals and openness count as, mean grid spacings
};

/// Linear functions fitted to a sample's windows.
struct WindowFits {
  std::array<std::array<float, 3>, kWindowCount> light{};  ///< at the sample; `channels` of each
  float follows = 1.0f;                                    ///< the part of the sample in the narrowest's
  std::array<float, kWindowCount> noise{};        ///< variance of that light where independent samples have one of 1
  std::array<float, kWindowCount> noise_apart{};  ///< likewise, of its difference from the narrowest window's
};

struct DenoiseKernels {
  /// The `count` samples nearest to one in space, itself among them, or all; by distance in classes of a thirty-second
  /// of an octave of its square, and within a class in the order of bins.
  void (*nearest)(const BinnedSamples& all, std::size_t sample, std::size_t count, NearSamples& near);
  /// \pre `near` has the last window's, if there are so many \return false, and nothing is fitted, where all are known
  bool (*fit)(const BinnedSamples& all, std::size_t sample, const NearSamples& near, const WindowLimits& limits,
              WindowFits& fits);
};

/// For the instruction set of this machine.
[[nodiscard]] DenoiseKernels denoise_kernels(std::size_t channels);

}  // namespace isolux::wide
