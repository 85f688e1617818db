// How wrong is light with all its reflections, iterated on kept rays or followed by paths, at random points of
// isosurfaces, and what does it take? Counters: bias and rms error over all isosurfaces of a volume, seconds of
// tracing, of bounces and of resampling. The time is the whole bake's. References are paths as well, in two halves: the
// mean product of the differences from both is the squared error without their noise.
#include <benchmark/benchmark.h>
#include <isolux/bake.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "surface_cases.h"

namespace {

using namespace isolux;
using namespace isolux::bench;

constexpr int kPaths = 1024;  // a half

struct Case {
  std::string name;
  Volume volume;
  Scene scene;
  std::vector<float> isovalues;
  std::array<SampleSet, 2> half{};
};

Scene lit(bool half_sky) {
  Scene scene;
  if (half_sky) scene.environment = SkyEnvironment{.ground = Vec3f(0.0f)};
  return scene;
}

void add_references(Case& c) {
  std::vector<Vec3f> points;
  for (const float h : c.isovalues) {
    const std::vector<Vec3f> more = surface_points(c.volume, h, 4 * kPoints, 11);
    points.insert(points.end(), more.begin(), more.end());
  }
  const Sites sites = make_sites(c.volume, std::move(points), {}, {});
  for (std::uint64_t i = 0; i < 2; ++i)
    c.half[i] = tracers().create()->trace(c.volume, c.scene, sites, {.rays = kPaths}, {.seed = 1000 + i}).samples;
}

std::vector<std::unique_ptr<Case>> make_cases() {
  std::vector<std::unique_ptr<Case>> cases;
  const auto add = [&](Case c) { cases.push_back(std::make_unique<Case>(std::move(c))); };
  add({"cavity", read_volume("gen:cavity:48"), lit(false), {0.55f, 0.6f, 0.65f}});
  add({"two-spheres", read_volume("gen:two-spheres:48"), lit(true), {-0.3f, -0.2f, -0.15f}});
  add({"gyroid", read_volume("gen:gyroid:64"), lit(true), {-0.5f, 0.0f, 0.5f}});
  if (const char* folder = std::getenv("ISOLUX_DATA")) {
    const std::string at = std::string(folder) + "/";
    add({"neghip", read_volume(at + "neghip_64x64x64_uint8.raw"), lit(true), {40, 80, 150}});
    const std::vector<float> engine{60, 110, 180};
    add({"engine", busiest_block(read_volume(at + "engine.nrrd"), engine), lit(true), engine});
  }
  return cases;
}

struct Scheme {
  std::string name;
  std::string resampler;
  int rays;
  int bounces;
  BounceMethod method;
};

void reflected_light(benchmark::State& state, Case& c, const Scheme& scheme) {
  BakeSettings settings;
  settings.resampler.name = scheme.resampler;
  settings.trace = {.rays = scheme.rays, .bounces = scheme.bounces};
  settings.bounce_method = scheme.method;
  const Stages stages = builtin_stages();
  std::optional<BakeResult> result;
  for (auto _ : state) result = bake(c.volume, c.scene, settings, stages, {.seed = 5, .threads = 1});
  state.counters["trace"] = result->seconds["trace"];
  state.counters["bounces"] = result->seconds["bounces"];
  state.counters["resample"] = result->seconds["resample"];
  state.counters["sweeps"] = result->sweeps;
  state.counters["estimate"] = result->rmse_estimate;
  if (scheme.bounces == 0) return;
  if (c.half[0].size() == 0) add_references(c);
  const LightReader reader(c.volume, result->light);
  double bias = 0.0;
  double squares = 0.0;
  double mean = 0.0;
  const std::size_t count = c.half[0].size();
  for (std::size_t s = 0; s < count; ++s) {
    const Sites& sites = c.half[0].sites;
    const double e = double(reader.at_index(Vec3(sites.positions[s]), double(sites.isovalues[s])).x);
    const double a = e - double(c.half[0].radiance[s]);
    const double b = e - double(c.half[1].radiance[s]);
    bias += 0.5 * (a + b);
    squares += a * b;
    mean += e;
  }
  state.counters["bias"] = bias / double(count);
  state.counters["mean"] = mean / double(count);
  state.counters["rms"] = std::sqrt(std::max(0.0, squares / double(count)));
}

const int kRegistered = [] {
  static const std::vector<std::unique_ptr<Case>> cases = make_cases();
  const std::vector<Scheme> schemes{
      {"direct_64_iterated", "direct", 64, kAllBounces, BounceMethod::kIterated},
      {"fit_8x8_none", "fit", 8, 0, BounceMethod::kPaths},
      {"fit_8x8_paths", "fit", 8, kAllBounces, BounceMethod::kPaths},
      {"fit_8x8_iterated", "fit", 8, kAllBounces, BounceMethod::kIterated},
      {"fit_8x64_none", "fit", 64, 0, BounceMethod::kPaths},
      {"fit_8x64_paths", "fit", 64, kAllBounces, BounceMethod::kPaths},
      {"fit_8x64_iterated", "fit", 64, kAllBounces, BounceMethod::kIterated},
  };
  for (const auto& c : cases) {
    for (const Scheme& scheme : schemes) {
      benchmark::RegisterBenchmark(("reflected_light/" + c->name + "/" + scheme.name).c_str(),
                                   [&c, scheme](benchmark::State& state) { reflected_light(state, *c, scheme); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
  return int(cases.size());
}();

}  // namespace
