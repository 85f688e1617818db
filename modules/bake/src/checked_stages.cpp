#include "checked_stages.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace isolux {
namespace {

class CheckedSampler final : public SiteSampler {
 public:
  CheckedSampler(std::unique_ptr<SiteSampler> sampler, std::string name)
      : sampler_(std::move(sampler)), name_(std::move(name)) {}

  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const override {
    Sites sites = sampler_->sample(volume, request, run);
    require_usable(sites, volume.lattice(), "sampler " + name_);
    return sites;
  }

 private:
  std::unique_ptr<const SiteSampler> sampler_;
  std::string name_;
};

class CheckedTracer final : public FlatTracer {
 public:
  CheckedTracer(std::unique_ptr<FlatTracer> tracer, std::string name)
      : tracer_(std::move(tracer)), name_(std::move(name)) {}

  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const Run& run) const override {
    const std::size_t count = sites.size();
    TraceResult result = tracer_->trace(volume, scene, std::move(sites), settings, run);
    const SampleSet& samples = result.samples;
    const bool is_one_each = (samples.channels == 1 || samples.channels == 3) && samples.size() == count &&
                             samples.radiance.size() == count * std::size_t(samples.channels) &&
                             samples.variance.size() == count && (result.rays.empty() || result.rays.size() == count) &&
                             (result.cut.empty() || result.cut.size() == count);
    if (!is_one_each)
      throw InvalidInput(fmt::format(
          "tracer {}: {} sites, of which it gave {} with {} radiances of {} channels, {} variances, {} numbers of rays "
          "and {} of paths cut off",
          name_, count, samples.size(), samples.radiance.size(), samples.channels, samples.variance.size(),
          result.rays.size(), result.cut.size()));
    const auto bad =
        std::find_if(samples.radiance.begin(), samples.radiance.end(), [](float e) { return !std::isfinite(e); });
    if (bad != samples.radiance.end())
      throw InvalidInput(
          fmt::format("tracer {}: sample {}: its radiance is {}; it must be finite; the scene's radiance, irradiance "
                      "or emission may be too large for floats",
                      name_, std::size_t(bad - samples.radiance.begin()) / std::size_t(samples.channels), *bad));
    return result;
  }

 private:
  std::unique_ptr<const FlatTracer> tracer_;
  std::string name_;
};

}  // namespace

std::unique_ptr<const SiteSampler> checked_sampler(const BackendChoice& choice, const Stages& stages) {
  return std::make_unique<const CheckedSampler>(stages.samplers.create(choice.name, choice.settings), choice.name);
}

std::unique_ptr<const FlatTracer> checked_tracer(const BackendChoice& choice, const Stages& stages) {
  return std::make_unique<const CheckedTracer>(stages.tracers.create(choice.name, choice.settings), choice.name);
}

}  // namespace isolux
