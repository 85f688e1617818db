// How wrong is the light at random points of isosurfaces, by scheme of sampling, resampling and reading? Volumes are
// 32^3 blocks of real ones (ISOLUX_DATA names their folder; built-in fields otherwise), where their isosurfaces meet;
// the references are traced with many rays from their own random numbers. Counters: median and 80th percentile of the
// rms error over all isosurfaces, median of the absolute bias; the time is the resampler's.
#include <benchmark/benchmark.h>
#include <isolux/core/field.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/resample.h>
#include <isolux/sample_sites/site_sampler.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <tuple>

namespace {

using namespace isolux;

constexpr int kBlock = 32;            // voxels an axis
constexpr int kReferenceRays = 1024;  // noise of .01
constexpr std::size_t kPoints = 500;  // an isosurface

struct Source {
  std::string name;
  std::vector<float> isovalues;
};

std::vector<Source> sources() {
  const char* folder = std::getenv("ISOLUX_DATA");
  if (folder == nullptr) {
    return {{"gen:gyroid:32", {-0.5f, 0.0f, 0.5f}},
            {"gen:marschner-lobb:32", {0.3f, 0.5f, 0.7f}},
            {"gen:two-spheres:32", {-0.3f, -0.2f, -0.15f}}};
  }
  const std::string at = std::string(folder) + "/";
  return {{at + "neghip_64x64x64_uint8.raw", {40, 80, 150}},
          {at + "engine.nrrd", {60, 110, 180}},
          {at + "headsq_quarter.nrrd", {500, 1150, 1600}},
          {at + "stent.nrrd", {150, 300, 700}},
          {at + "fuel_64x64x64_uint8.raw", {10, 60, 120}},
          {at + "bonsai.nrrd", {40, 90, 150}},
          {at + "fetal_t2.nrrd", {120, 250, 400}},
          {at + "frog.nrrd", {40, 70, 110}},
          {at + "viscous_fingers.nrrd", {15, 30, 55}},
          {at + "brain1_anisotropic.nrrd", {150, 450, 1000}},
          {at + "blunt_fin.nrrd", {35, 60, 85}},
          {at + "hydrogen_atom_128x128x128_uint8.raw", {8, 20, 40}}};
}

bool crossed(const Volume& volume, const Index3& cell, float isovalue) {
  float low = volume.values(cell.x, cell.y, cell.z);
  float high = low;
  for (int q = 1; q < 8; ++q) {
    const float v = volume.values(cell.x + (q & 1), cell.y + (q >> 1 & 1), cell.z + (q >> 2));
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return low < isovalue && isovalue < high;
}

/// The block where the isosurfaces cross the most cells, none of them forgotten.
Volume busiest_block(const Volume& volume, const std::vector<float>& isovalues) {
  const Index3 size = glm::min(Index3(kBlock), volume.lattice().size);
  const Index3 room = volume.lattice().size - size;
  Index3 best(0);
  double most = -1.0;
  for (int z = 0; z <= room.z; z += 8)
    for (int y = 0; y <= room.y; y += 8)
      for (int x = 0; x <= room.x; x += 8) {
        double score = 0.0;
        for (const float h : isovalues) {
          int cells = 0;
          for (int k = 2; k < size.z - 2; k += 2)
            for (int j = 2; j < size.y - 2; j += 2)
              for (int i = 2; i < size.x - 2; i += 2) cells += crossed(volume, {x + i, y + j, z + k}, h) ? 1 : 0;
          score += std::sqrt(double(cells));
        }
        if (score > most) std::tie(most, best) = std::make_tuple(score, Index3(x, y, z));
      }
  Volume block = volume;
  Lattice lattice{.size = size, .frame = volume.lattice().frame};
  lattice.frame.origin = volume.lattice().frame.world(Vec3(best));
  block.values = Grid<float>(lattice);
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) block.values(i, j, k) = volume.values(best.x + i, best.y + j, best.z + k);
  return block;
}

/// Points of {f = isovalue} inside random crossed cells, found along the axis of the steepest change.
std::vector<Vec3f> surface_points(const Volume& volume, float isovalue, std::size_t count, std::uint64_t seed) {
  const TrilinearField field(volume);
  std::vector<Index3> cells;
  const Index3 size = volume.lattice().size;
  for (int k = 1; k < size.z - 2; ++k)
    for (int j = 1; j < size.y - 2; ++j)
      for (int i = 1; i < size.x - 2; ++i)
        if (crossed(volume, {i, j, k}, isovalue)) cells.emplace_back(i, j, k);
  std::vector<Vec3f> points;
  RandomStream random(seed, 0);
  for (std::size_t t = 0; t < 40 * count && points.size() < count && !cells.empty(); ++t) {
    const Index3 cell = cells[std::size_t(random.uniform_double() * double(cells.size()))];
    Vec3 p = Vec3(cell);
    for (int a = 0; a < 3; ++a) p[a] += random.uniform_double();
    const Vec3 g = field.cell_gradient(p);
    int axis = 0;
    for (int a = 1; a < 3; ++a) axis = std::fabs(g[a]) > std::fabs(g[axis]) ? a : axis;
    if (g[axis] == 0.0) continue;
    p[axis] += (double(isovalue) - field.value(p)) / g[axis];
    if (p[axis] > cell[axis] + 0.01 && p[axis] < cell[axis] + 0.99) points.emplace_back(p);
  }
  return points;
}

struct Case {
  Volume volume;
  std::vector<SampleSet> references;
  std::map<std::string, SampleSet> sampled;  ///< by sites and rays
};

SampleSet trace(const Volume& volume, Sites sites, int rays, std::uint64_t seed) {
  const Scene scene;
  return tracers()
      .create()
      ->trace(volume, scene, std::move(sites), {.rays = rays, .bounces = 0}, {.seed = seed})
      .samples;
}

std::vector<std::unique_ptr<Case>> make_cases() {
  std::vector<std::unique_ptr<Case>> cases;
  for (const Source& source : sources()) {
    auto c = std::make_unique<Case>();
    c->volume = busiest_block(read_volume(source.name), source.isovalues);
    for (const float h : source.isovalues) {
      std::vector<Vec3f> points = surface_points(c->volume, h, kPoints, 11);
      if (points.size() < kPoints / 4) continue;
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
  int sites;  ///< a texel
  int rays;   ///< a site
  std::string resampler;
  Settings settings;
  int texels = 1;  ///< a cell and axis
};

const SampleSet& samples_of(Case& c, const Scheme& scheme, const Lattice& texels) {
  const std::string key = scheme.sampler + "/" + std::to_string(scheme.sites) + "/" + std::to_string(scheme.rays) +
                          "/" + std::to_string(scheme.texels);
  auto& set = c.sampled[key];
  if (set.size() == 0) {
    const auto sampler = samplers().create(scheme.sampler);
    SiteRequest request{.texels = texels};
    Sites sites = sampler->sample(c.volume, request, {.seed = 3});
    if (scheme.sites > 1) {
      // One a texel of what can be lit at all, times as many.
      request.count = std::size_t(scheme.sites) * sites.size();
      sites = sampler->sample(c.volume, request, {.seed = 3});
    }
    set = trace(c.volume, std::move(sites), scheme.rays, 5);
  }
  return set;
}

double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[std::size_t(part * double(values.size() - 1))];
}

void light_on_surface(benchmark::State& state, const Scheme& scheme) {
  const auto resampler = resamplers().create(scheme.resampler, scheme.settings);
  std::vector<double> rms;
  std::vector<double> bias;
  std::size_t texel_count = 0;
  for (auto _ : state) {
    state.PauseTiming();
    texel_count = 0;
    rms.clear();
    bias.clear();
    for (auto& c : cases()) {
      const Index3 cells = c->volume.lattice().size - 1;
      const Lattice texels = cell_lattice(c->volume.lattice(), cells * scheme.texels);
      const SampleSet& samples = samples_of(*c, scheme, texels);
      texel_count += texels.count();
      state.ResumeTiming();
      ResampledGrid partial = resampler->resample(c->volume, samples, texels, {});
      state.PauseTiming();
      const IlluminationGrid light = fill_unlit(std::move(partial), {});
      const LightReader reader(c->volume, light);
      for (const SampleSet& reference : c->references) {
        double sum = 0.0;
        double squares = 0.0;
        for (std::size_t s = 0; s < reference.size(); ++s) {
          const double e =
              double(reader.at_index(Vec3(reference.sites.positions[s]), double(reference.sites.isovalues[s])).x) -
              double(reference.radiance[s]);
          sum += e;
          squares += e * e;
        }
        rms.push_back(std::sqrt(squares / double(reference.size())));
        bias.push_back(std::fabs(sum / double(reference.size())));
      }
    }
    state.ResumeTiming();
  }
  state.counters["median"] = percentile(rms, 0.5);
  state.counters["p80"] = percentile(rms, 0.8);
  state.counters["bias"] = percentile(bias, 0.5);
  state.counters["rays_per_cell"] = scheme.sites * scheme.rays * scheme.texels * scheme.texels * scheme.texels;
  state.counters["texels/s"] = benchmark::Counter(double(texel_count), benchmark::Counter::kIsIterationInvariantRate);
}

const Settings kThesis{{"k", "11"}, {"exponent", "0.5"}, {"distance", "chebyshev"}};

const int kRegistered = [] {
  const std::vector<std::pair<std::string, Scheme>> schemes{
      {"texels_64", {"texels", 1, 64, "direct", {}}},
      {"texels_128", {"texels", 1, 128, "direct", {}}},
      {"texels_512", {"texels", 1, 512, "direct", {}}},
      {"thesis_random_64", {"random", 1, 64, "cell_grid", kThesis}},
      {"shepard_1x64", {"low_discrepancy", 1, 64, "cell_grid", {}}},
      {"shepard_8x64", {"low_discrepancy", 8, 64, "cell_grid", {}}},
      {"fit_plain_8x64", {"stratified", 8, 64, "fit", {{"slopes", "false"}, {"near_field", "false"}}}},
      {"fit_near_field_8x64", {"stratified", 8, 64, "fit", {{"slopes", "false"}}}},
      {"fit_slopes_8x64", {"stratified", 8, 64, "fit", {{"near_field", "false"}}}},
      {"fit_8x64", {"stratified", 8, 64, "fit", {}}},
      {"fit_low_discrepancy_8x64", {"low_discrepancy", 8, 64, "fit", {}}},
      {"fit_8x32", {"stratified", 8, 32, "fit", {}}},
      {"fit_8x16", {"stratified", 8, 16, "fit", {}}},
      {"fit_8x8", {"stratified", 8, 8, "fit", {}}},
      {"fit_4x16", {"stratified", 4, 16, "fit", {}}},
      {"fit_4x4", {"stratified", 4, 4, "fit", {}}},
      {"fit_8x2", {"stratified", 8, 2, "fit", {}}},
      {"texels_64_2_an_axis", {"texels", 1, 64, "direct", {}, 2}},
      {"fit_4x32_2_an_axis", {"stratified", 4, 32, "fit", {}, 2}},
  };
  for (const auto& [name, scheme] : schemes) {
    benchmark::RegisterBenchmark(("light_on_surface/" + name).c_str(), light_on_surface, scheme)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  }
  return int(schemes.size());
}();

}  // namespace
