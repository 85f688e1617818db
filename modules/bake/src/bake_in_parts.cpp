#include "bake_in_parts.h"

#include <isolux/core/stopwatch.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bake_parts.h"
#include "checked_stages.h"
#include "isovalue_parts.h"
#include "site_figures.h"
#include "standard_error.h"

namespace isolux {
namespace {

class PartBaker {
 public:
  PartBaker(const Volume& volume, const Scene& scene, const BakeSettings& settings, BakeResult begun,
            const Stages& stages, const Run& run)
      : volume_(volume),
        scene_(scene),
        settings_(settings),
        run_(run),
        values_(value_range(volume)),
        texels_(texel_lattice(volume.lattice(), settings)),
        all_(site_request(volume, settings, texels_, scene.outer, run)),
        sampler_(checked_sampler(settings.sampler, stages)),
        tracer_(checked_tracer(settings.tracer, stages)),
        resampler_(stages.resamplers.create(settings.resampler.name, settings.resampler.settings)),
        result_(std::move(begun)) {}

  BakeResult bake() {
    const Stopwatch parting;
    const auto count = std::size_t(std::max(settings_.isovalue_parts, 0));
    all_.values = values_;
    const std::vector<ValueRange> parts = isovalue_parts(volume_, all_, count, run_);
    result_.seconds["sites"] += parting.seconds();
    result_.sites = 0;  // where all were found before
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const auto all = double(parts.size());
      light(parts[p], part_of(run_, double(p) / all, double(p + 1) / all));
    }
    count_sites(volume_, all_, settings_, result_);
    result_.least_rays = result_.most_rays = std::uint32_t(settings_.trace.rays);
    result_.rmse_estimate = result_.noise = error_.root();
    const Stopwatch watch;
    if (settings_.wants_error_grid) result_.error = fill_unlit(told_by_bytes(std::move(errors_)), run_);
    finish_light(volume_, last_, told_by_bytes(std::move(light_)), *resampler_, settings_, run_, result_);
    result_.seconds["resample"] += watch.seconds();
    return std::move(result_);
  }

 private:
  void light(const ValueRange& isovalues, const Run& run) {
    const Stopwatch finding;
    SiteRequest request = all_;
    request.isovalues = isovalues;
    Sites sites = sampler_->sample(volume_, request, run);
    result_.seconds["sites"] += finding.seconds();
    if (sites.size() == 0) return;
    result_.sites += sites.size();
    const Stopwatch tracing;
    TraceSettings trace = settings_.trace;
    trace.nets = RayNets::kInterleaved;
    trace.values = values_;
    last_ = {};
    TraceResult traced = tracer_->trace(volume_, scene_, std::move(sites), trace, run);
    result_.seconds["trace"] += tracing.seconds();
    add(result_.counters, traced.counters);
    last_ = std::move(traced.samples);
    keep_light();
  }

  void keep_light() {
    const Stopwatch watch;
    error_.add(last_.variance);
    if (light_.values.empty()) light_ = unlit_grid(texels_, last_.channels);
    resampler_->add_part(volume_, last_, light_, run_);
    if (settings_.wants_error_grid) {
      if (errors_.values.empty()) errors_ = unlit_grid(texels_, 1);
      SampleSet errors = standard_errors(std::move(last_));
      resampler_->add_part(volume_, errors, errors_, run_);
      last_ = std::move(errors);
    }
    keep_first(kSamplesShown, last_);
    result_.seconds["resample"] += watch.seconds();
  }

  const Volume& volume_;
  const Scene& scene_;
  const BakeSettings& settings_;
  const Run& run_;
  ValueRange values_;  ///< of the volume
  Lattice texels_;
  SiteRequest all_;  ///< for all parts together
  std::unique_ptr<const SiteSampler> sampler_;
  std::unique_ptr<const FlatTracer> tracer_;
  std::unique_ptr<const Resampler> resampler_;
  BakeResult result_;
  IlluminationGrid light_;
  IlluminationGrid errors_;
  SampleSet last_;  ///< samples of the last part
  MeanVariance error_;
};

}  // namespace

bool can_bake_in_parts(const Volume& volume, const BakeSettings& settings, const Stages& stages) {
  if (settings.sampler.name != "texels" || settings.texel_sites != TexelSites::kAll ||
      settings.bounce_method != BounceMethod::kPaths)
    return false;
  // Of more sites a cell, the nets that neighbours share depend on how many there are.
  const Lattice texels = texel_lattice(volume.lattice(), settings);
  const int beyond_cells = settings.lattice == TexelLattice::kVoxels ? 1 : 0;
  for (int a = 0; a < 3; ++a)
    if (texels.size[a] > volume.lattice().size[a] - 1 + beyond_cells) return false;
  return stages.resamplers.create(settings.resampler.name, settings.resampler.settings)->takes_parts();
}

BakeResult bake_in_parts(const Volume& volume, const Scene& scene, const BakeSettings& settings, BakeResult begun,
                         const Stages& stages, const Run& run) {
  return PartBaker(volume, scene, settings, std::move(begun), stages, run).bake();
}

}  // namespace isolux
