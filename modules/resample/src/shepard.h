#pragma once

#include <isolux/core/options.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <span>
#include <vector>

#include "metric.h"
#include "neighbours.h"

namespace isolux {

/// What Shepard's interpolation (Shepard, "A two-dimensional interpolation function for irregularly-spaced data", ACM
/// 1968) is given, the same for every backend that computes it.
struct ShepardOptions {
  static constexpr int kFromSamples = -1;  ///< chosen_by_samples() fills it in, as any exponent below 0

  int k = kFromSamples;
  double exponent = kFromSamples;
  Distance distance = Distance::kEuclidean;
  double radius = 0.0;
  double isovalue_length = 0.0;

  void describe(OptionVisitor& option);
};

/// Samples and texels in the space that their distances are measured in.
class ShepardSpace {
 public:
  /// \pre nothing is kFromSamples \throw InvalidInput if k and radius are both 0, or the samples do not suit.
  ShepardSpace(const Volume& volume, const SampleSet& samples, const ShepardOptions& options);

  /// \pre `index` (index space) as a float is where a sample at the same place has it, so that they meet exactly.
  [[nodiscard]] Point point(const Vec3f& index, float isovalue) const;
  [[nodiscard]] std::span<const Point> samples() const { return samples_; }
  /// The far corner of the box; the near one is at 0.
  [[nodiscard]] Point far_corner() const { return far_corner_; }
  [[nodiscard]] bool uses_isovalues() const { return isovalue_scale_ > 0.0; }
  [[nodiscard]] const NeighbourLimits& limits() const { return limits_; }

 private:
  Vec3 scale_{1.0};
  double isovalue_scale_ = 0.0;
  Point far_corner_{};
  NeighbourLimits limits_;
  std::vector<Point> samples_;
};

/// Shepard's weights over the neighbours of one texel.
class ShepardBlend {
 public:
  ShepardBlend(const SampleSet& samples, const ShepardOptions& options);

  /// Writes `channels` values. \pre neighbours sorted, at least one. Samples at the texel itself give their mean.
  void operator()(std::span<const Neighbour> neighbours, float* texel) const;

 private:
  [[nodiscard]] double weight(double reach_ratio) const;

  const SampleSet& samples_;
  double power_;        ///< of the ratio of reaches
  int quarter_powers_;  ///< 4 power_ where that is a small whole number, else -1
};

}  // namespace isolux
