#include <fmt/format.h>
#include <isolux/core/parallel.h>
#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string_view>
#include <utility>

#include "cell_walk.h"
#include "embree_speed.h"
#include "stats.h"
#include "suites.h"
#include "tracer_speed.h"

namespace isolux::bench {
namespace {

/// What a row of the first hits is called, behind who finds them.
constexpr const char* kFirstHit = ", first hit";

Table speed_table() {
  Table table{.id = "all",
              .title = "Speed and work",
              .columns = {"volume", "threads", "tracer", "Mrays/s", "quartile", "quartile ", "bricks/ray", "cells/ray",
                          "cubics/ray", "hits %", "of them without a search %", "setup, s"}};
  table.sentence =
      "Bricks of cells entered, cells tested and cubics solved a ray, as the tracers count them; a tracer that is "
      "asked for "
      "any hit need not solve them, nor search for a hit that a look at the inner side proves. Setting up is left out "
      "of the rates: what a tracer makes of the volume, and "
      "Embree's "
      "tree; Embree in the fastest of its calls. Rows of first hits, which reflections take, find where each ray ends; "
      "they prove nothing.";
  return table;
}

void add_row(Table& table, const std::string& volume, int threads, const std::string& name, const TracerSpeed& speed) {
  const auto rays = double(speed.counters.rays);
  table.rows.push_back({volume, double(threads), name, speed.mrays.value, speed.mrays.low, speed.mrays.high,
                        double(speed.counters.macrocells) / rays, double(speed.counters.cells) / rays,
                        double(speed.counters.cubics) / rays, 100.0 * double(speed.counters.hits) / rays,
                        100.0 * double(speed.counters.proven) / double(std::max<std::uint64_t>(1, speed.counters.hits)),
                        speed.setup_seconds});
}

/// Million rays a second.
Estimate add_peer_row(Table& table, const std::string& volume, const EmbreeSpeed& embree, RayQuestion question,
                      const Run& run, double seconds) {
  const auto [rate, call] = embree.measured(question, run, seconds);
  table.rows.push_back({volume, double(run.threads),
                        fmt::format("Embree, one isosurface, {}{}", embree_call_name(call),
                                    question == RayQuestion::kFirstHit ? kFirstHit : ""),
                        rate.value, rate.low, rate.high, kNone, kNone, kNone, kNone, kNone, embree.build_seconds()});
  return rate;
}

/// First hits of the default tracer and of Embree.
void add_first_hits(Table& table, const std::string& title, const Volume& volume, const EmbreeSpeed& embree,
                    float isovalue, const Run& run, double seconds, const SuiteContext& context) {
  add_row(table, title, run.threads, default_tracer(context) + kFirstHit,
          first_hit_speed(volume, isovalue, run, seconds, context));
  if (embree.exists()) add_peer_row(table, title, embree, RayQuestion::kFirstHit, run, seconds);
}

/// What a set of rays has to look at: a cell is tested where it reaches the isovalue of a ray that crosses it.
struct Touched {
  double constant = 0.0;   ///< part of the cells that hold no level set
  double uncrossed = 0.0;  ///< part that no ray crosses
  double untested = 0.0;   ///< part that no ray has to test
};

Touched touched_cells(const Volume& volume, std::size_t count, const SuiteContext& context) {
  const Lattice& lattice = volume.lattice();
  const Index3 n = lattice.size - 1;
  const std::size_t cells = cell_lattice(lattice).count();
  std::vector<float> low(cells);
  std::vector<float> high(cells);
  const auto number = [&](const Index3& c) { return (std::size_t(c.z) * n.y + c.y) * n.x + c.x; };
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        float least = volume.values(i, j, k);
        float most = least;
        for (int q = 1; q < 8; ++q) {
          const float v = volume.values(i + (q & 1), j + (q >> 1 & 1), k + (q >> 2));
          least = std::min(least, v);
          most = std::max(most, v);
        }
        low[number({i, j, k})] = least;
        high[number({i, j, k})] = most;
      }
    }
  }
  std::vector<std::atomic<std::uint8_t>> marks(cells);
  const Sites sites = context.stages.samplers.create("random")->sample(
      volume, {.texels = cell_lattice(lattice), .count = count}, context.run);
  (void)gather(volume, sites, {.rays = kSpeedRays}, context.run, [&](const GatheredRays& rays) {
    for (std::size_t r = 0; r < rays.sites.size() * rays.rays; ++r) {
      const std::uint32_t site = rays.sites[r / rays.rays];
      const Vec3 way(rays.index_direction[0][r], rays.index_direction[1][r], rays.index_direction[2][r]);
      walk_cells(lattice, Vec3(sites.positions[site]), way, double(rays.index_distance[r]),
                 [&](const Index3& cell, double, double) {
                   const std::size_t c = number(cell);
                   const bool tested = high[c] >= sites.isovalues[site];
                   marks[c].fetch_or(tested ? 3 : 1, std::memory_order_relaxed);
                   return true;
                 });
    }
  });
  Touched part;
  for (std::size_t c = 0; c < cells; ++c) {
    part.constant += low[c] == high[c] ? 1.0 / double(cells) : 0.0;
    part.uncrossed += marks[c] == 0 ? 1.0 / double(cells) : 0.0;
    part.untested += (marks[c] & 2u) == 0 ? 1.0 / double(cells) : 0.0;
  }
  return part;
}

void add_touched(Table& table, const std::string& name, const Volume& volume, const SuiteContext& context) {
  const std::size_t sites =
      std::min<std::size_t>(cell_lattice(volume.lattice()).count() / 64, context.pick(500, 20000, 100000));
  const Touched part = touched_cells(volume, sites, context);
  table.rows.push_back(
      {name, double(sites * kSpeedRays), 100.0 * part.constant, 100.0 * part.uncrossed, 100.0 * part.untested});
}

/// The figures of the suite as they grow.
struct TraceFigures {
  Plot sizes{.id = "sizes",
             .title = "Rays a second against the size of the volume (gen:gyroid)",
             .x_label = "grid points an axis",
             .y_label = "million rays a second"};
  Plot work{.id = "work",
            .title = "Work of a ray against the size of the volume (gen:gyroid)",
            .x_label = "grid points an axis",
            .y_label = "cells tested a ray"};
  Table all = speed_table();
  Table untouched{.id = "untouched",
                  .title = "What is never touched",
                  .columns = {"volume", "rays", "constant cells %", "cells that no ray crosses %",
                              "cells that no ray has to test %"}};
};

void measure_sizes(const SuiteContext& context, TraceFigures& figures) {
  const auto sizes = context.pick<std::vector<int>>({17}, {32, 64, 128}, {32, 64, 128, 256, 512});
  const std::vector<int> threads = context.run.threads == 1 ? std::vector<int>{1} : std::vector<int>{1, 2};
  const std::vector<std::string> names = tracer_names(context);
  std::vector<Series> rates(threads.size() * (names.size() + 1));
  std::vector<Series> work(names.size());
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    const int n = sizes[s];
    context.say(fmt::format("gyroid {}", n));
    const std::string title = fmt::format("gyroid {}", n);
    const Volume volume = sample_analytic_field("gyroid", n);
    const EmbreeSpeed embree(volume, 0.0f, context);
    for (std::size_t t = 0; t < threads.size(); ++t) {
      Run run = context.run;
      run.threads = threads[t];
      const std::size_t pieces = names.size() + (threads[t] == 1 ? 3 : 1);
      const double seconds = context.budget.share((sizes.size() - s) * threads.size() - t) / double(pieces);
      for (std::size_t i = 0; i <= names.size(); ++i) {
        Series& series = rates[t * (names.size() + 1) + i];
        Estimate rate;
        if (i < names.size()) {
          const TracerSpeed speed = tracer_speed(names[i], volume, 0.0f, run, seconds, context);
          add_row(figures.all, title, threads[t], names[i], speed);
          rate = speed.mrays;
          work[i].name = names[i];
          if (t == 0) work[i].points.push_back({double(n), double(speed.counters.cells) / double(speed.counters.rays)});
        } else if (embree.exists()) {
          rate = add_peer_row(figures.all, title, embree, RayQuestion::kAnyHit, run, seconds);
        }
        series.name = fmt::format("{}, {} thread{}", i < names.size() ? names[i] : "Embree, one isosurface", threads[t],
                                  threads[t] > 1 ? "s" : "");
        if (rate.value > 0.0) series.points.push_back({double(n), rate.value, rate.low, rate.high});
      }
      if (threads[t] == 1) add_first_hits(figures.all, title, volume, embree, 0.0f, run, seconds, context);
    }
    if (n <= 128) add_touched(figures.untouched, title, volume, context);
  }
  figures.sizes.series = std::move(rates);
  figures.work.series = std::move(work);
}

void measure_real(const SuiteContext& context, TraceFigures& figures) {
  const std::vector<std::pair<std::string, float>> real{
      {"neghip_64x64x64_uint8.raw", 80.0f}, {"engine.nrrd", 110.0f}, {"bonsai.nrrd", 90.0f}};
  const std::vector<std::string> names = tracer_names(context);
  const std::size_t count = context.effort == Effort::kFull ? real.size() : 1;
  Run run = context.run;
  run.threads = 1;
  for (std::size_t v = 0; v < count; ++v) {
    const auto& [file, isovalue] = real[v];
    context.say(file);
    // A fifth of all for all of them, before the sizes, which take as long as they take.
    const double seconds = context.budget.share(5 * count - v) / double(names.size() + 3);
    const Volume volume = read_volume(context.data_folder + "/" + file);
    for (const std::string& name : names)
      add_row(figures.all, file, run.threads, name, tracer_speed(name, volume, isovalue, run, seconds, context));
    const EmbreeSpeed embree(volume, isovalue, context);
    if (embree.exists()) add_peer_row(figures.all, file, embree, RayQuestion::kAnyHit, run, seconds);
    add_first_hits(figures.all, file, volume, embree, isovalue, run, seconds, context);
    add_touched(figures.untouched, file, volume, context);
  }
}

/// A tracer's speed over Embree's, least and most over the rows of one thread whose tracers' names end alike: `of` is
/// the one's, `asked` what both names end with.
std::pair<double, double> beside_embree(const Table& table, const std::string& of, std::string_view asked) {
  std::pair<double, double> found{1e30, 0.0};
  double ours = 0.0;
  for (const auto& row : table.rows) {
    const auto& name = std::get<std::string>(row[2]);
    if (std::get<double>(row[1]) != 1.0) continue;
    if (name == fmt::format("{}{}", of, asked)) ours = std::get<double>(row[3]);
    if (!name.starts_with("Embree") || name.ends_with(kFirstHit) != (asked == kFirstHit)) continue;
    const double ratio = ours / std::get<double>(row[3]);
    found = {std::min(found.first, ratio), std::max(found.second, ratio)};
  }
  return found;
}

std::string said_beside_embree(const Table& table, const std::string& tracer) {
  const auto [least, most] = beside_embree(table, tracer, "");
  if (most == 0.0) return "Embree is not in this build: no comparison.";
  const auto [least_first, most_first] = beside_embree(table, tracer, kFirstHit);
  return fmt::format(
      "On one thread the tracer `{}` does {:.2g} to {:.2g} times as many rays a second, on all level sets at once, as "
      "Embree does on the triangles of one isosurface; {:.2g} to {:.2g} times as many where both are asked for the "
      "first hit.",
      tracer, least, most, least_first, most_first);
}

}  // namespace

SuiteReport run_trace(const SuiteContext& context) {
  SuiteReport report;
  TraceFigures figures;
  figures.sizes.sentence =
      "Cosine rays from sites uniform in the volume, one a cell, each confined to its site's level set (where a whole "
      "bake takes too long, the isovalues nearest to 0); Embree traces the triangles of the isosurface 0, any hit. "
      "Bars "
      "are quartiles of the repetitions.";
  figures.work.sentence =
      "How many cells a ray has to look at; a ray that skipped nothing would cross a part of the volume that grows "
      "with "
      "its size (suite faults).";
  figures.untouched.sentence =
      "Cells of one value hold no level set; a cell has to be tested where it reaches the isovalue of a ray that "
      "crosses "
      "it. 64 rays from one site for every 64 cells or fewer.";
  if (!context.data_folder.empty() && context.effort != Effort::kSmoke) measure_real(context, figures);
  measure_sizes(context, figures);
  report.highlights.push_back(said_beside_embree(figures.all, default_tracer(context)));
  report.figures.emplace_back(std::move(figures.sizes));
  report.figures.emplace_back(std::move(figures.work));
  report.figures.emplace_back(std::move(figures.all));
  report.figures.emplace_back(std::move(figures.untouched));
  return report;
}

}  // namespace isolux::bench
