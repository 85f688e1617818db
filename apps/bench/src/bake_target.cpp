#include "bake_target.h"

#include <isolux/bake/light_points.h>
#include <isolux/core/stopwatch.h>
#include <isolux/resample/fill_unlit.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/analytic_fields.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh_light.h"
#include "tracer_speed.h"

namespace isolux::bench {
namespace {

/// Settings of k for a search among samples that lie on few surfaces, far from most texels: a tree finds them, a grid
/// would search emptiness.
std::unique_ptr<Resampler> sparse_resampler(const SuiteContext& context) {
  const auto backends = context.stages.resamplers.backends();
  const bool has_tree = std::any_of(backends.begin(), backends.end(), [](const BackendInfo& info) {
    return info.name == "cgal_kdtree" && info.unavailable.empty();
  });
  return context.stages.resamplers.create(has_tree ? "cgal_kdtree" : "cell_grid", {{"k", "4"}, {"exponent", "2"}});
}

PointLight judge_light(const Target& target, const std::vector<Vec3f>& points, int rays, const SuiteContext& context,
                       const Run& run) {
  return light_points(target.volume, target.scene, points, {.rays = rays, .bounces = target.bounces},
                      {.name = "scalar", .settings = {}}, context.stages, run);
}

}  // namespace

Target analytic_target(const Truth& truth, int n, std::size_t count, const SuiteContext& context) {
  Target target{.id = truth.field,
                .title = truth.name,
                .volume = sample_analytic_field(truth.field, n),
                .scene = truth.scene,
                .bounces = truth.bounces,
                .isovalues = truth.isovalues};
  const Sites sites = known_sites(truth, target.volume, "low_discrepancy", count, context);
  for (const Vec3f& p : sites.positions) {
    const Vec3 world = target.volume.lattice().frame.world(Vec3(p));
    target.points.emplace_back(world);
    target.e.push_back(truth.e(world).value());
  }
  target.isovalue = 0.5f * (truth.isovalues->low + truth.isovalues->high);
  return target;
}

Target traced_target(const std::string& id, Volume volume, float isovalue, int bounces, std::size_t count,
                     double seconds, const SuiteContext& context) {
  Target target{.id = id, .title = id, .volume = std::move(volume), .bounces = bounces, .isovalue = isovalue};
  Run run = context.run;
  run.seed += 1000;
  const Sites sites = context.stages.samplers.create("random")->sample(
      target.volume, {.texels = cell_lattice(target.volume.lattice()), .count = count}, run);
  for (const Vec3f& p : sites.positions) target.points.emplace_back(target.volume.lattice().frame.world(Vec3(p)));
  // Powers of two from 256 up to what fits, so that the reference seldom depends on the machine.
  int rays = 16;
  const Stopwatch watch;
  (void)judge_light(target, target.points, rays, context, run);
  const auto fitting = double(grown(std::size_t(rays), watch.seconds(), seconds));
  rays = int(std::clamp(std::exp2(std::floor(std::log2(fitting))), 256.0, 8192.0));
  if (context.effort == Effort::kSmoke) rays = 64;
  const PointLight light = judge_light(target, target.points, rays, context, run);
  for (const Vec3f& e : light.radiance) target.e.push_back(double(e.x));
  target.reference_error = light.rmse_estimate;
  return target;
}

Estimate error_of(const IlluminationGrid& light, const Target& target, const SuiteContext& context) {
  const LightReader reader(target.volume, light);
  std::vector<double> errors;
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    errors.push_back(double(reader.at_world(Vec3(target.points[i])).x) - target.e[i]);
  }
  return rms_interval(errors, context.run.seed);
}

Measured baked(const Target& target, BakeSettings settings, const SuiteContext& context) {
  settings.trace.bounces = target.bounces;
  settings.isovalues = target.isovalues;
  const Stopwatch watch;
  const BakeResult result = bake(target.volume, target.scene, settings, context.stages, context.run);
  const double seconds = watch.seconds();
  return {.seconds = seconds, .error = error_of(result.light, target, context)};
}

BakeSettings thesis_settings(std::size_t samples) {
  BakeSettings settings;
  settings.sampler = {.name = "random", .settings = {}};
  settings.resampler = {.name = "brute_force",
                        .settings = {{"k", "11"}, {"exponent", "0.5"}, {"distance", "chebyshev"}}};
  settings.lattice = TexelLattice::kVoxels;
  settings.samples = samples;
  return settings;
}

Measured coupled(const Target& target, int surfaces, int rays, const SuiteContext& context) {
  const Stopwatch watch;
  const Lattice& lattice = target.volume.lattice();
  const ValueRange range = target.isovalues.value_or(value_range(target.volume));
  const auto extractor = context.stages.extractors.create();
  const SiteRequest request{.texels = cell_lattice(lattice), .outer = target.scene.outer};
  std::vector<Vec3f> positions;
  for (int s = 0; s < surfaces; ++s) {
    const float isovalue = range.low + (range.high - range.low) * (float(s) + 0.5f) / float(surfaces);
    const IsoMesh mesh =
        extractor->extract(target.volume, {.isovalue = isovalue, .outer = target.scene.outer}, context.run);
    for (const auto vertex : mesh.vertices()) {
      const auto& p = mesh.point(vertex);
      positions.emplace_back(lattice.frame.index(Vec3(p[0], p[1], p[2])));
    }
  }
  Sites sites = make_sites(target.volume, std::move(positions), request, context.run);
  const SampleSet samples =
      context.stages.tracers.create()
          ->trace(target.volume, target.scene, std::move(sites), {.rays = rays, .bounces = target.bounces}, context.run)
          .samples;
  const IlluminationGrid light =
      fill_unlit(sparse_resampler(context)->resample(target.volume, samples, request.texels, context.run), context.run);
  const double seconds = watch.seconds();
  return {.seconds = seconds, .error = error_of(light, target, context)};
}

std::optional<OneSurface> one_surface(const Target& target, int rays, const SuiteContext& context) {
  const Stopwatch watch;
  const IsoMesh mesh =
      context.stages.extractors.create()->extract(target.volume, {.isovalue = target.isovalue}, context.run);
  if (mesh.n_vertices() == 0) return std::nullopt;
  const auto embree = EmbreeMesh::build(mesh);
  if (!embree) return std::nullopt;
  const std::vector<float> light = light_vertices(*embree, EmbreeCall::kPacketsOf8, RayQuestion::kAnyHit, mesh,
                                                  mesh.n_vertices(), rays, context.run);
  OneSurface result{.vertices = mesh.n_vertices(), .measured = {.seconds = watch.seconds(), .error = {}}};

  // The level set's own light at some vertices.
  std::vector<Vec3f> points;
  std::vector<double> errors;
  const std::size_t step = std::max<std::size_t>(1, light.size() / std::size_t(context.pick(100, 300, 1000)));
  for (std::size_t v = 0; v < light.size(); v += step) {
    const auto& p = mesh.point(mesh.vertex_handle(unsigned(v)));
    points.emplace_back(p[0], p[1], p[2]);
    errors.push_back(double(light[v]));
  }
  const PointLight exact = judge_light(target, points, 1024, context, context.run);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= double(exact.radiance[i].x);
  result.measured.error = rms_interval(errors, context.run.seed);
  return result;
}

}  // namespace isolux::bench
