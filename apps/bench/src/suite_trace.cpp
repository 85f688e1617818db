#include <fmt/format.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "mesh_light.h"
#include "stats.h"
#include "suites.h"

namespace isolux::bench {
namespace {

constexpr int kRays = 64;

struct Speed {
  Estimate mrays;  ///< million rays a second: median and quartiles
  TraceCounters counters;
};

/// The ray population of flattened lighting: sites uniform in the volume, cosine rays over their hemispheres.
Speed trace_speed(const std::string& tracer_name, const Volume& volume, std::size_t count, Run run,
                  const SuiteContext& context) {
  const Sites sites = context.stages.samplers.create("random")->sample(
      volume, {.texels = cell_lattice(volume.lattice()), .count = count}, run);
  const auto tracer = context.stages.tracers.create(tracer_name);
  Speed speed;
  std::vector<double> rates;
  for (int repetition = 0; repetition < context.pick(2, 5); ++repetition) {
    const Stopwatch watch;
    const TraceResult result = tracer->trace(volume, Scene{}, sites, {.rays = kRays, .bounces = 0}, run);
    rates.push_back(1e-6 * double(result.counters.rays) / watch.seconds());
    speed.counters = result.counters;
  }
  speed.mrays = median(rates);
  return speed;
}

/// Embree on the mesh of one isosurface, which is what somebody would use who lights surfaces one by one.
Estimate embree_speed(const Volume& volume, float isovalue, std::size_t rays, const Run& run,
                      const SuiteContext& context) {
  const IsoMesh mesh = context.stages.extractors.create()->extract(volume, {.isovalue = isovalue}, run);
  const auto embree = EmbreeMesh::build(mesh);
  if (!embree || mesh.n_vertices() == 0) return {};
  const std::size_t vertices = std::min<std::size_t>(mesh.n_vertices(), rays / kRays);
  std::vector<double> rates;
  for (int repetition = 0; repetition < context.pick(2, 5); ++repetition) {
    const Stopwatch watch;
    (void)light_vertices(*embree, mesh, vertices, kRays, run);
    rates.push_back(1e-6 * double(vertices * kRays) / watch.seconds());
  }
  return median(rates);
}

void add_row(Table& table, const std::string& volume, int threads, const std::string& name, const Speed& speed) {
  const auto rays = double(speed.counters.rays);
  table.rows.push_back({volume, double(threads), name, speed.mrays.value, speed.mrays.low, speed.mrays.high,
                        double(speed.counters.macrocells) / rays, double(speed.counters.cells) / rays,
                        double(speed.counters.cubics) / rays, 100.0 * double(speed.counters.hits) / rays});
}

void add_peer_row(Table& table, const std::string& volume, int threads, const Estimate& rate) {
  table.rows.push_back({volume, double(threads), std::string("Embree, one isosurface"), rate.value, rate.low, rate.high,
                        kNone, kNone, kNone, kNone});
}

std::vector<std::string> tracer_names(const SuiteContext& context) {
  std::vector<std::string> names;
  for (const BackendInfo& info : context.stages.tracers.backends()) {
    if (info.unavailable.empty()) names.push_back(info.name);
  }
  return names;
}

/// The part of the cells that no ray can meet anything in: constant ones.
double untouchable(const Volume& volume, const SuiteContext& context) {
  const Sites sites =
      context.stages.samplers.create("texels")->sample(volume, {.texels = cell_lattice(volume.lattice())}, context.run);
  return 1.0 - double(sites.size()) / double(cell_lattice(volume.lattice()).count());
}

}  // namespace

SuiteReport run_trace(const SuiteContext& context) {
  SuiteReport report;
  Plot plot{.id = "sizes",
            .title = "Rays a second against the size of the volume (gen:gyroid)",
            .x_label = "grid points an axis",
            .y_label = "million rays a second",
            .x_axis = Axis::kLog,
            .y_axis = Axis::kLog};
  plot.sentence =
      "Cosine rays from sites uniform in the volume, each confined to its site's level set; Embree traces the "
      "triangles of "
      "one isosurface only, any hit, 16 wide. Bars are quartiles of the repetitions.";
  Table table{.id = "all",
              .title = "Speed and work",
              .columns = {"volume", "threads", "tracer", "Mrays/s", "quartile", "quartile ", "macrocells/ray",
                          "cells/ray", "cubics/ray", "hits %"},
              .sentence = "Macrocells entered, cells tested and cubics solved a ray, as the tracers count them."};
  const std::vector<int> sizes = context.full ? std::vector<int>{32, 64, 128, 256, 512} : std::vector<int>{32, 64, 128};
  const std::vector<int> threads = context.run.threads == 1 ? std::vector<int>{1} : std::vector<int>{1, 2};
  const auto count = std::size_t(context.pick(8192, 262144));
  for (const int t : threads) {
    Run run = context.run;
    run.threads = t;
    std::vector<Series> curves;
    for (const std::string& name : tracer_names(context))
      curves.push_back({fmt::format("{}, {} threads", name, t), {}});
    Series embree{.name = fmt::format("Embree, {} threads", t), .points = {}};
    for (const int n : sizes) {
      context.say(fmt::format("gyroid {}, {} threads", n, t));
      const Volume volume = sample_analytic_field("gyroid", n);
      for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::string name = tracer_names(context)[i];
        const Speed speed = trace_speed(name, volume, count, run, context);
        curves[i].points.push_back({double(n), speed.mrays.value, speed.mrays.low, speed.mrays.high});
        add_row(table, fmt::format("gyroid {}", n), t, name, speed);
      }
      const Estimate peer = embree_speed(volume, 0.0f, count * kRays, run, context);
      if (peer.value > 0.0) {
        embree.points.push_back({double(n), peer.value, peer.low, peer.high});
        add_peer_row(table, fmt::format("gyroid {}", n), t, peer);
      }
    }
    for (Series& curve : curves) plot.series.push_back(std::move(curve));
    plot.series.push_back(std::move(embree));
  }
  report.figures.emplace_back(std::move(plot));

  Table untouched{.id = "untouched",
                  .title = "What is never traced",
                  .columns = {"volume", "constant cells %"},
                  .sentence = "Cells of one value hold no level set: no site lies in them, no ray tests them."};
  if (!context.data_folder.empty()) {
    const std::vector<std::pair<std::string, float>> real{
        {"neghip_64x64x64_uint8.raw", 80.0f}, {"engine.nrrd", 110.0f}, {"bonsai.nrrd", 90.0f}};
    for (const auto& [file, isovalue] : real) {
      context.say(file);
      const Volume volume = read_volume(context.data_folder + "/" + file);
      untouched.rows.push_back({file, 100.0 * untouchable(volume, context)});
      for (const std::string& name : tracer_names(context)) {
        add_row(table, file, thread_count(context.run), name, trace_speed(name, volume, count, context.run, context));
      }
      const Estimate peer = embree_speed(volume, isovalue, count * kRays, context.run, context);
      if (peer.value > 0.0) add_peer_row(table, file, thread_count(context.run), peer);
    }
  }
  report.figures.emplace_back(std::move(table));
  if (!untouched.rows.empty()) report.figures.emplace_back(std::move(untouched));
  return report;
}

}  // namespace isolux::bench
