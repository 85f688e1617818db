// How wrong is the light at random points of isosurfaces, by scheme of sampling, resampling and reading, where one bake
// serves every isovalue? Counters: median and 80th percentile of the rms error over all isosurfaces, median of the
// absolute bias and its floor, what unbiased light would have; the time is the resampler's.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "surface_cases.h"

namespace {

using namespace isolux;
using namespace isolux::bench;

struct Case {
  Volume volume;
  std::vector<SampleSet> references;
  std::map<std::string, SampleSet> sampled;  ///< by sites and rays
};

std::vector<std::unique_ptr<Case>> make_cases() {
  std::vector<std::unique_ptr<Case>> cases;
  for (const Source& source : sources()) {
    auto c = std::make_unique<Case>();
    c->volume = busiest_block(read_volume(source.name), source.isovalues);
    for (const float h : source.isovalues) {
      std::vector<Vec3f> points = surface_points(c->volume, h, kManyPoints, 11);
      if (points.size() < kManyPoints / 4) continue;
      Sites sites = make_sites(c->volume, std::move(points), {}, {});
      c->references.push_back(trace(c->volume, std::move(sites), kReferenceRays, 1000 + c->references.size()));
    }
    cases.push_back(std::move(c));
  }
  return cases;
}

std::vector<std::unique_ptr<Case>>& cases() {
  static std::vector<std::unique_ptr<Case>> all = make_cases();
  return all;
}

struct Scheme {
  std::string sampler;
  double sites;  ///< a texel
  int rays;      ///< a site
  std::string resampler;
  Settings settings;
  double texels = 1;  ///< a cell and axis
};

const SampleSet& samples_of(Case& c, const Scheme& scheme, const Lattice& texels, RaySpread spread) {
  const std::string key = scheme.sampler + "/" + std::to_string(scheme.sites) + "/" + std::to_string(scheme.rays) +
                          "/" + std::to_string(scheme.texels) + "/" + std::to_string(int(spread));
  auto& set = c.sampled[key];
  if (set.size() == 0) {
    const auto sampler = samplers().create(scheme.sampler);
    SiteRequest request{.texels = texels};
    Sites sites = sampler->sample(c.volume, request, {.seed = 3});
    if (scheme.sites > 1) {
      // One a texel of what can be lit at all, times as many.
      request.count = std::size_t(scheme.sites * double(sites.size()));
      sites = sampler->sample(c.volume, request, {.seed = 3});
    }
    set = trace(c.volume, std::move(sites), scheme.rays, 5, spread);
  }
  return set;
}

void light_on_surface(benchmark::State& state, const Scheme& scheme) {
  const auto resampler = resamplers().create(scheme.resampler, scheme.settings);
  SurfaceErrors errors;
  std::size_t texel_count = 0;
  for (auto _ : state) {
    state.PauseTiming();
    texel_count = 0;
    errors = {};
    for (auto& c : cases()) {
      const Lattice texels = texels_of(c->volume, scheme.texels);
      const SampleSet& samples = samples_of(*c, scheme, texels, resampler->spread());
      texel_count += texels.count();
      state.ResumeTiming();
      ResampledGrid partial = resampler->resample(c->volume, samples, texels, {});
      resampler->add_detail(c->volume, samples, partial, {});
      state.PauseTiming();
      const IlluminationGrid light = fill_unlit(std::move(partial), {});
      const LightReader reader(c->volume, light);
      for (const SampleSet& reference : c->references) errors.add(reader, reference);
    }
    state.ResumeTiming();
  }
  state.counters["median"] = percentile(errors.rms, 0.5);
  state.counters["p80"] = percentile(errors.rms, 0.8);
  state.counters["bias"] = percentile(errors.bias, 0.5);
  state.counters["bias_floor"] = errors.bias_floor();
  state.counters["rays_per_cell"] = scheme.sites * scheme.rays * scheme.texels * scheme.texels * scheme.texels;
  state.counters["texels/s"] = benchmark::Counter(double(texel_count), benchmark::Counter::kIsIterationInvariantRate);
}

const Settings kThesis{{"k", "11"}, {"exponent", "0.5"}, {"distance", "chebyshev"}};
const Settings kPlain{{"near_field", "false"}};
const Settings kNoNormals{{"normals", "false"}};
const Settings kWeakSlopes{{"normals", "false"}, {"slope_prior", "0.01"}};
const Settings kValue{{"normals", "false"}, {"slopes", "false"}};
const Settings kPlainFit{{"normals", "false"}, {"slopes", "false"}, {"near_field", "false"}};
const Settings kUsual{{"k", "11"}, {"exponent", "2"}};

const int kRegistered = [] {
  const std::vector<std::pair<std::string, Scheme>> schemes{
      {"texels_64", {"texels", 1, 64, "direct", {}}},
      {"texels_128", {"texels", 1, 128, "direct", {}}},
      {"texels_16", {"texels", 1, 16, "direct", {}}},
      {"texels_16_denoised", {"texels", 1, 16, "direct", {{"denoise", "true"}}}},
      {"texels_16_denoised_blunt", {"texels", 1, 16, "direct", {{"denoise", "true"}, {"sharpen", "false"}}}},
      {"texels_16_denoised_even", {"texels", 1, 16, "direct", {{"denoise", "true"}, {"spread", "false"}}}},
      {"plain_texels_64", {"texels", 1, 64, "direct", kPlain}},
      {"plain_texels_16", {"texels", 1, 16, "direct", kPlain}},
      {"plain_texels_512", {"texels", 1, 512, "direct", kPlain}},
      {"thesis_random_64", {"random", 1, 64, "cell_grid", kThesis}},
      {"shepard_1x64", {"low_discrepancy", 1, 64, "cell_grid", kUsual}},
      {"shepard_8x64", {"low_discrepancy", 8, 64, "cell_grid", kUsual}},
      {"shepard_8x4", {"low_discrepancy", 8, 4, "cell_grid", kUsual}},
      {"shepard_chosen_1x64", {"low_discrepancy", 1, 64, "cell_grid", {}}},
      {"shepard_chosen_8x64", {"low_discrepancy", 8, 64, "cell_grid", {}}},
      {"shepard_chosen_8x4", {"low_discrepancy", 8, 4, "cell_grid", {}}},
      {"fit_plain_8x64", {"stratified", 8, 64, "fit", kPlainFit}},
      {"fit_near_field_8x64", {"stratified", 8, 64, "fit", kValue}},
      {"fit_slopes_8x64", {"stratified", 8, 64, "fit", {{"near_field", "false"}, {"normals", "false"}}}},
      {"fit_no_normals_8x64", {"stratified", 8, 64, "fit", kNoNormals}},
      {"fit_8x64", {"stratified", 8, 64, "fit", {}}},
      {"fit_8x32", {"stratified", 8, 32, "fit", {}}},
      {"fit_8x8", {"stratified", 8, 8, "fit", {}}},
      {"fit_8x2", {"stratified", 8, 2, "fit", {}}},
      {"fit_4x4", {"stratified", 4, 4, "fit", {}}},
      // Texels of 1.37 cells: 20.6 sites a texel are 8 a cell.
      {"fit_8x64_0.73_an_axis", {"stratified", 20.6, 64, "fit", {}, 0.73}},
      {"fit_16x64_0.73_an_axis", {"stratified", 41.1, 64, "fit", {}, 0.73}},
      {"fit_8x16_0.73_an_axis", {"stratified", 20.6, 16, "fit", {}, 0.73}},
      {"fit_8x8_0.73_an_axis", {"stratified", 20.6, 8, "fit", {}, 0.73}},
      {"fit_4x16_0.73_an_axis", {"stratified", 10.3, 16, "fit", {}, 0.73}},
      {"texels_64_2_an_axis", {"texels", 1, 64, "direct", {}, 2}},
      {"thesis_kdtree_64", {"random", 1, 64, "cgal_kdtree", kThesis}},
      {"fit_value_2x64_2_an_axis", {"stratified", 2, 64, "fit", kValue, 2}},
      // Sixteen and 32 sites a cell.
      {"fit_16x64_1.17_an_axis", {"stratified", 10, 64, "fit", {{"slope_prior", "0.01"}}, 1.17}},
      {"fit_32x64_1.17_an_axis", {"stratified", 20, 64, "fit", {{"slope_prior", "0.01"}}, 1.17}},
      {"fit_no_normals_16x64_1.58_an_axis", {"stratified", 4, 64, "fit", kWeakSlopes, 1.58}},
      {"fit_no_normals_32x64_1.58_an_axis", {"stratified", 8, 64, "fit", kWeakSlopes, 1.58}},
  };
  for (const auto& [name, scheme] : schemes) {
    benchmark::RegisterBenchmark(("light_on_surface/" + name).c_str(), light_on_surface, scheme)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  }
  return int(schemes.size());
}();

}  // namespace
