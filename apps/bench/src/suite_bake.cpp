#include <fmt/format.h>
#include <isolux/bake/bake.h>
#include <isolux/bake/light_points.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh_light.h"
#include "stats.h"
#include "suites.h"
#include "truths.h"

namespace isolux::bench {
namespace {

/// A lit volume, and e at points of many of its level sets.
struct Target {
  std::string id;
  std::string title;
  Volume volume;
  Scene scene{};
  int bounces = 0;
  std::optional<ValueRange> isovalues{};
  std::vector<Vec3f> points{};   ///< world
  std::vector<double> e{};       ///< at the points
  double reference_error = 0.0;  ///< standard error of e itself; 0 for closed forms
  float isovalue = 0.0f;         ///< of the one surface that peers light
};

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

/// A volume without closed form against many rays of another seed.
Target traced_target(const std::string& id, const Volume& volume, float isovalue, std::size_t count,
                     const SuiteContext& context) {
  Target target{.id = id, .title = id, .volume = volume, .isovalue = isovalue};
  Run run = context.run;
  run.seed += 1000;
  const Sites sites = context.stages.samplers.create("random")->sample(
      volume, {.texels = cell_lattice(volume.lattice()), .count = count}, run);
  for (const Vec3f& p : sites.positions) target.points.emplace_back(volume.lattice().frame.world(Vec3(p)));
  const PointLight light =
      light_points(volume, target.scene, target.points, {.rays = context.pick(512, 8192), .bounces = 0},
                   {.name = "scalar", .settings = {}}, context.stages, run);
  for (const Vec3f& e : light.radiance) target.e.push_back(double(e.x));
  target.reference_error = light.rmse_estimate;
  return target;
}

Estimate error_of(const IlluminationGrid& light, const Target& target, const SuiteContext& context) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    errors.push_back(double(light.at_world(Vec3(target.points[i])).x) - target.e[i]);
  }
  return rms_interval(errors, context.run.seed);
}

struct Measured {
  double seconds = 0.0;
  Estimate error;
};

Measured baked(const Target& target, BakeSettings settings, const SuiteContext& context) {
  settings.trace.bounces = target.bounces;
  settings.isovalues = target.isovalues;
  const Stopwatch watch;
  const BakeResult result = bake(target.volume, target.scene, settings, context.stages, context.run);
  const double seconds = watch.seconds();
  return {.seconds = seconds, .error = error_of(result.light, target, context)};
}

/// Wyman, Parker, Shirley & Hansen 2006, "Interactive display of isosurfaces with global illumination": some
/// isosurfaces are extracted and lit at their vertices, and the light is spread over the volume from there.
Measured coupled(const Target& target, int surfaces, int rays, const SuiteContext& context) {
  const Stopwatch watch;
  const ValueRange range = target.isovalues.value_or(value_range(target.volume));
  SampleSet samples;
  const auto extractor = context.stages.extractors.create();
  const auto tracer = context.stages.tracers.create();
  const SiteRequest request{.texels = cell_lattice(target.volume.lattice()), .outer = target.scene.outer};
  std::vector<Vec3f> positions;
  for (int s = 0; s < surfaces; ++s) {
    const float isovalue = range.low + (range.high - range.low) * (float(s) + 0.5f) / float(surfaces);
    const IsoMesh mesh =
        extractor->extract(target.volume, {.isovalue = isovalue, .outer = target.scene.outer}, context.run);
    for (const auto vertex : mesh.vertices()) {
      const auto& p = mesh.point(vertex);
      positions.emplace_back(target.volume.lattice().frame.index(Vec3(p[0], p[1], p[2])));
    }
  }
  Sites sites = make_sites(target.volume, std::move(positions), request, context.run);
  samples =
      tracer
          ->trace(target.volume, target.scene, std::move(sites), {.rays = rays, .bounces = target.bounces}, context.run)
          .samples;
  // Samples lie on few surfaces, far from most texels: a tree finds them, a grid searches emptiness.
  const auto backends = context.stages.resamplers.backends();
  const bool has_tree = std::any_of(backends.begin(), backends.end(), [](const BackendInfo& info) {
    return info.name == "cgal_kdtree" && info.unavailable.empty();
  });
  ResampledGrid partial = context.stages.resamplers.create(has_tree ? "cgal_kdtree" : "cell_grid", {{"k", "4"}})
                              ->resample(target.volume, samples, request.texels, context.run);
  const double seconds = watch.seconds();
  return {.seconds = seconds, .error = error_of(partial.grid, target, context)};
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

void add(Table& table, Series& series, const Target& target, const std::string& setting, const Measured& measured) {
  series.points.push_back({measured.seconds, measured.error.value, measured.error.low, measured.error.high});
  table.rows.push_back({target.title, series.name, setting, measured.seconds, measured.error.value, measured.error.low,
                        measured.error.high});
}

Plot curves(const Target& target, const SuiteContext& context, Table& table) {
  Plot plot{.id = target.id,
            .title = fmt::format("Lighting all level sets: {}", target.title),
            .x_label = "seconds",
            .y_label = "rms error of e"};
  plot.sentence = fmt::format(
      "Error at {} points of as many level sets, read from the baked texture; along a curve rays, samples or surfaces "
      "grow "
      "fourfold. {}",
      target.points.size(),
      target.reference_error > 0.0
          ? fmt::format("The reference's own standard error is {:.2g}.", target.reference_error)
          : std::string("The reference is a closed form."));
  Series ours{.name = "isolux", .points = {}};
  Series fine{.name = "isolux, 2 texels a cell axis", .points = {}};
  for (int rays = 4; rays <= context.pick(64, 1024); rays *= 4) {
    BakeSettings settings;
    settings.trace.rays = rays;
    add(table, ours, target, fmt::format("{} rays", rays), baked(target, settings, context));
    if (rays > context.pick(4, 256)) continue;
    settings.texels = (target.volume.lattice().size - 1) * 2;
    add(table, fine, target, fmt::format("{} rays", rays), baked(target, settings, context));
  }
  Series thesis{.name = "Challis 2010", .points = {}};
  for (int samples = 1000; samples <= context.pick(4000, 64000); samples *= 4) {
    add(table, thesis, target, fmt::format("{} samples", samples),
        baked(target, thesis_settings(std::size_t(samples)), context));
  }
  Series wyman{.name = "Wyman 2006, K surfaces", .points = {}};
  for (int surfaces = 2; surfaces <= context.pick(32, 128); surfaces *= 4) {
    add(table, wyman, target, fmt::format("K = {}", surfaces), coupled(target, surfaces, 64, context));
  }
  plot.series = {std::move(ours), std::move(fine), std::move(thesis), std::move(wyman)};
  return plot;
}

/// Lighting everything once against lighting surfaces one by one.
void break_even(const Target& target, const SuiteContext& context, Table& table) {
  constexpr int kRays = 64;
  BakeSettings settings;
  settings.trace.rays = kRays;
  const Measured all = baked(target, settings, context);
  const Stopwatch watch;
  const IsoMesh mesh =
      context.stages.extractors.create()->extract(target.volume, {.isovalue = target.isovalue}, context.run);
  const auto embree = EmbreeMesh::build(mesh);
  if (!embree || mesh.n_vertices() == 0) return;
  const std::vector<float> light = light_vertices(*embree, mesh, mesh.n_vertices(), kRays, context.run);
  const double one = watch.seconds();

  // The mesh's own light at some vertices against the level set's.
  std::vector<Vec3f> points;
  std::vector<double> found;
  const std::size_t step = std::max<std::size_t>(1, light.size() / 1000);
  for (std::size_t v = 0; v < light.size(); v += step) {
    const auto& p = mesh.point(mesh.vertex_handle(unsigned(v)));
    points.emplace_back(p[0], p[1], p[2]);
    found.push_back(double(light[v]));
  }
  const PointLight exact = light_points(target.volume, target.scene, points, {.rays = 1024, .bounces = 0},
                                        {.name = "scalar", .settings = {}}, context.stages, context.run);
  for (std::size_t i = 0; i < found.size(); ++i) found[i] -= double(exact.radiance[i].x);
  table.rows.push_back(
      {target.title, all.seconds, all.error.value, double(mesh.n_vertices()), one, rms(found), all.seconds / one});
}

}  // namespace

SuiteReport run_bake(const SuiteContext& context) {
  SuiteReport report;
  Table table{.id = "all",
              .title = "All figures",
              .columns = {"scene", "method", "setting", "seconds", "rms error", "95 % from", "to"},
              .sentence = "The figures behind the pictures; seconds from a volume in memory to its texture."};
  Table even{.id = "break-even",
             .title = "From how many isovalues on lighting everything is cheaper",
             .columns = {"scene", "all level sets, s", "rms error", "vertices of one", "one surface with Embree, s",
                         "rms error ", "break-even isovalues"},
             .sentence =
                 "64 rays each. One surface means extraction, Embree's tree and rays at its vertices, compared at the "
                 "vertices; past the last column's number of isovalues the bake of all level sets is the cheaper one."};
  const int n = context.pick(25, 65);
  const auto count = std::size_t(context.pick(500, 4000));
  std::vector<Target> targets;
  targets.push_back(analytic_target(plane_under_ball(), n, count, context));
  targets.push_back(analytic_target(integrating_sphere(), n, count, context));
  targets.push_back(traced_target("gyroid", sample_analytic_field("gyroid", n), 0.0f, count, context));
  if (!context.data_folder.empty()) {
    targets.push_back(traced_target("neghip", read_volume(context.data_folder + "/neghip_64x64x64_uint8.raw"), 80.0f,
                                    count, context));
    if (context.full) {
      targets.push_back(
          traced_target("engine", read_volume(context.data_folder + "/engine.nrrd"), 110.0f, count, context));
    }
  }
  for (const Target& target : targets) {
    context.say(target.title);
    report.figures.emplace_back(curves(target, context, table));
    if (target.bounces == 0) break_even(target, context, even);
  }
  if (!even.rows.empty()) report.figures.emplace_back(std::move(even));
  report.figures.emplace_back(std::move(table));
  return report;
}

}  // namespace isolux::bench
