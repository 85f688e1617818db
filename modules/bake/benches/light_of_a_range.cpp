// How wrong is the light of a known range of isovalues, a tenth of the volume's, or of a known isovalue, each baked by
// itself? References lie on three isosurfaces of a range, on the one otherwise. Counters as in light_on_surface, and
// what the light takes in bricks of four texels an axis with a shared border: numbers stored a voxel of the whole
// volume, median and 80th percentile over the bakes.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "sites_by_need.h"
#include "surface_cases.h"

namespace {

using namespace isolux;
using namespace isolux::bench;

struct Case {
  std::shared_ptr<const Volume> whole;
  std::shared_ptr<const Volume> block;
  ValueRange range;
  std::vector<SampleSet> references;
};

/// One bake an isosurface of every volume, `width` of the whole range of values wide.
std::vector<Case> make_cases(float width) {
  std::vector<Case> cases;
  for (const Source& source : sources()) {
    const auto whole = std::make_shared<const Volume>(read_volume(source.name));
    const auto block = std::make_shared<const Volume>(busiest_block(*whole, source.isovalues));
    const ValueRange all = value_range(*whole);
    const float half = 0.5f * width * (all.high - all.low);
    for (const float h : source.isovalues) {
      Case c{.whole = whole, .block = block, .range = {h - half, h + half}, .references = {}};
      std::vector<float> levels{h};
      if (half > 0.0f) levels = {h - 0.8f * half, h, h + 0.8f * half};
      for (const float level : levels) {
        std::vector<Vec3f> points = surface_points(*block, level, kPoints, 11);
        if (points.size() < kPoints / 4) continue;
        Sites sites = make_sites(*block, std::move(points), {}, {});
        c.references.push_back(trace(*block, std::move(sites), kReferenceRays, 1000 + c.references.size()));
      }
      if (!c.references.empty()) cases.push_back(std::move(c));
    }
  }
  return cases;
}

const std::vector<Case>& cases(float width) {
  static std::map<float, std::vector<Case>> all;
  const auto it = all.find(width);
  return it != all.end() ? it->second : all.emplace(width, make_cases(width)).first->second;
}

struct Scheme {
  float width;  ///< of the range, in parts of the volume's
  std::string sampler;
  double sites;  ///< a crossed cell
  int rays;
  double texels;  ///< a cell and axis
  Settings settings;
  bool by_need = false;  ///< half of the sites where the others say that light changes
};

SampleSet samples_of(const Case& c, const Scheme& scheme, const Lattice& texels) {
  const auto sampler = samplers().create(scheme.sampler);
  SiteRequest request{.texels = texels, .per_texel = scheme.sites / std::pow(scheme.texels, 3), .isovalues = c.range};
  if (scheme.by_need) request.per_texel *= 0.5;
  SampleSet samples = trace(*c.block, sampler->sample(*c.block, request, {.seed = 3}), scheme.rays, 5);
  if (!scheme.by_need) return samples;
  request.count = 4 * samples.size();
  const Sites candidates = sampler->sample(*c.block, request, {.seed = 4});
  Sites more = sites_by_need(*c.block, samples, candidates, samples.size(), {.seed = 4});
  append_samples(samples, trace(*c.block, std::move(more), scheme.rays, 6));
  return samples;
}

/// Numbers in the bricks of the whole volume that the range needs, page table included, a voxel.
double stored_a_voxel(const Case& c, const Scheme& scheme) {
  IlluminationGrid light(texels_of(*c.whole, scheme.texels), 1);
  if (scheme.settings.count("slopes") == 0) light.detail.slopes = light.values;
  if (scheme.settings.count("normals") == 0) light.detail.normal_slopes.fill(light.values);
  return double(make_light_bricks(*c.whole, light, c.range).stored()) / double(c.whole->lattice().count());
}

void light_of_a_range(benchmark::State& state, const Scheme& scheme) {
  const auto resampler = resamplers().create("fit", scheme.settings);
  SurfaceErrors errors;
  std::vector<double> stored;
  for (auto _ : state) {
    errors = {};
    stored.clear();
    state.PauseTiming();
    for (const Case& c : cases(scheme.width)) {
      const Lattice texels = texels_of(*c.block, scheme.texels);
      const SampleSet samples = samples_of(c, scheme, texels);
      if (samples.size() == 0) continue;
      state.ResumeTiming();
      ResampledGrid partial = resampler->resample(*c.block, samples, texels, {});
      state.PauseTiming();
      const IlluminationGrid light = fill_unlit(std::move(partial), {});
      const LightReader reader(*c.block, light);
      SampleSet pooled;
      for (const SampleSet& reference : c.references) append(pooled, reference);
      errors.add(reader, pooled);
      stored.push_back(stored_a_voxel(c, scheme));
    }
    state.ResumeTiming();
  }
  state.counters["median"] = percentile(errors.rms, 0.5);
  state.counters["p80"] = percentile(errors.rms, 0.8);
  state.counters["bias"] = percentile(errors.bias, 0.5);
  state.counters["a_voxel"] = percentile(stored, 0.5);
  state.counters["a_voxel_p80"] = percentile(stored, 0.8);
}

const int kRegistered = [] {
  const Settings weak{{"slope_prior", "0.01"}};
  const Settings sloped{{"normals", "false"}, {"slope_prior", "0.01"}};
  const Settings value{{"slopes", "false"}, {"normals", "false"}};
  const Settings turned{{"slopes", "false"}};
  const Settings plain{{"slopes", "false"}, {"normals", "false"}, {"near_field", "false"}};
  const std::vector<std::pair<std::string, Scheme>> schemes{
      {"range/stratified_4x64", {0.1f, "stratified", 4, 64, 0.8, weak}},
      {"range/4x64", {0.1f, "level_sets", 4, 64, 0.8, weak}},
      {"range/8x64", {0.1f, "level_sets", 8, 64, 0.8, weak}},
      {"range/16x64", {0.1f, "level_sets", 16, 64, 0.8, weak}},
      {"range/32x32", {0.1f, "level_sets", 32, 32, 0.8, weak}},
      {"range/24x64", {0.1f, "level_sets", 24, 64, 0.8, weak}},
      {"range/32x64", {0.1f, "level_sets", 32, 64, 0.8, weak}},
      {"range/32x128", {0.1f, "level_sets", 32, 128, 0.8, weak}},
      {"range/16x64_1", {0.1f, "level_sets", 16, 64, 1, weak}},
      {"range/8x64_need", {0.1f, "level_sets", 8, 64, 0.8, weak, true}},
      {"range/16x64_need", {0.1f, "level_sets", 16, 64, 0.8, weak, true}},
      {"range/16x64_1.15_no_normals", {0.1f, "level_sets", 16, 64, 1.15, sloped}},
      {"range/16x64_1.15_no_normals_need", {0.1f, "level_sets", 16, 64, 1.15, sloped, true}},
      {"range/8x64_2_an_axis_value", {0.1f, "level_sets", 8, 64, 2, value}},
      {"one/4x64", {0.0f, "level_sets", 4, 64, 0.97, turned}},
      {"one/8x64", {0.0f, "level_sets", 8, 64, 0.97, turned}},
      {"one/16x64", {0.0f, "level_sets", 16, 64, 0.97, turned}},
      {"one/16x64_1.3", {0.0f, "level_sets", 16, 64, 1.3, turned}},
      {"one/16x64_1.7_value", {0.0f, "level_sets", 16, 64, 1.7, value}},
      {"one/4x64_plain", {0.0f, "level_sets", 4, 64, 1, plain}},
  };
  for (const auto& [name, scheme] : schemes) {
    benchmark::RegisterBenchmark(("light_of_a_range/" + name).c_str(), light_of_a_range, scheme)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  }
  return int(schemes.size());
}();

}  // namespace
