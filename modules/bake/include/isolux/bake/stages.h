#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/resample/resampler.h>
#include <isolux/sample_sites/site_sampler.h>
#include <isolux/volume_io/volume_reader.h>

namespace isolux {

/// Every stage's backends. A program adds its own to the registries before it passes them on.
struct Stages {
  Registry<VolumeReader> readers;
  Registry<Extractor> extractors;
  Registry<SiteSampler> samplers;
  Registry<FlatTracer> tracers;
  Registry<Resampler> resamplers;
};

/// The backends of this build.
[[nodiscard]] Stages builtin_stages();

}  // namespace isolux
