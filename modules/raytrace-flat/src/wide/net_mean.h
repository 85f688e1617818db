#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/vec.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "site_rays.h"
#include "wide/hemisphere.h"

namespace isolux::wide {

/// Mean and variance of what the rays of a site bring, the rays being points of a net.
class NetMean {
 public:
  /// Of rays [first, first + rays). What they bring is so large a share of what a site gets.
  NetMean(const SobolPoints& points, std::size_t rays, std::size_t first = 0, double share = 1.0);

  /// Sum of one value a ray, and the sum of the squared differences of neighbouring strata.
  struct Moments {
    Vec3 sum{0.0};
    Vec3 differences{0.0};
  };
  [[nodiscard]] Moments moments(std::span<const Vec3> values) const;
  /// Numbers of the rays, less the first: neighbours of this list are neighbouring strata.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

  /// Adds the light of a site with a normal to e, and its squared standard error to the variance, which counts lights
  /// as independent. The variance is that of neighbouring strata (successive differences, von Neumann 1941): plain
  /// variance / n would count the differences between far strata, which the net has removed. Rather too large still:
  /// see calibrate_variance. \pre put_darkness()
  void add(const Moments& moments, std::size_t site, SampleSet& samples) const;

 private:
  std::vector<std::uint32_t> order_;  ///< along a curve of Morton's
  double share_;
};

/// What light is added to: e = 0, of known error where there is a normal and more than one ray.
void put_darkness(SampleSet& samples, std::size_t rays);

/// Says of `samples` that radiance and variance of `lamps` are what lamps send straight there. Errors that are not
/// known are the rest's.
void tell_lamps_apart(SampleSet& samples, const SampleSet& lamps);

/// The sites with a normal whose light is found twice, to know by how much NetMean's variances are too large: all of
/// few, one of 64 of many.
[[nodiscard]] std::vector<std::size_t> choose_probes(const Sites& sites);

/// The seed of the second results.
[[nodiscard]] std::uint64_t probe_seed(std::uint64_t seed);

/// What lights samples whose sites are set, by the seed and the progress of a run. It says how many rays sites got, or
/// takes as many as it is told.
using LightSamples = std::function<void(SampleSet& samples, const Run& run, SiteRays& rays)>;

/// Lights all samples, and the probes among them once more, to calibrate the variances.
SiteRays light_and_calibrate(SampleSet& samples, const Run& run, const LightSamples& light);

}  // namespace isolux::wide
