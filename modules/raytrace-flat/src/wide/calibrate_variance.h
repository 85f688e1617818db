#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace isolux::wide {

/// Scales the variances of `samples` so that on the probes they add up to what the difference of two results with
/// independent random numbers shows. `again` holds the second results of `probes`. Where sites have different numbers
/// of rays (one a site; empty: all the same), those of a number with enough probes have a scale of their own.
void calibrate_variance(SampleSet& samples, std::span<const std::size_t> probes, const SampleSet& again,
                        std::span<const std::uint32_t> rays = {});

/// The same where sites got their rays by what their own earlier rays said: those whose rays hardly differ may have
/// been lucky, and were left alone for it. Of as many rays they all have the variance that their probes show; only the
/// others' are scaled. \throw Cancelled
void calibrate_variance_of_chosen(SampleSet& samples, std::span<const std::size_t> probes, const SampleSet& again,
                                  std::span<const std::uint32_t> rays, const Run& run);

}  // namespace isolux::wide
