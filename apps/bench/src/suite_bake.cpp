#include <fmt/format.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "bake_target.h"
#include "suites.h"

namespace isolux::bench {
namespace {

Table figures_table() {
  Table table{.id = "all",
              .title = "All figures",
              .columns = {"scene", "method", "setting", "seconds", "rms error", "95 % from", "to"}};
  table.sentence =
      "The figures behind the pictures; seconds from a volume in memory to its texture (to the light at the vertices "
      "where one surface is lit).";
  return table;
}

/// A method as a curve: its steps, and what they are called.
struct Method {
  std::string name;
  int first;
  int last;
  std::string unit;
  std::function<std::optional<Measured>(int)> step;
};

std::vector<Method> methods(const Target& target, const SuiteContext& context) {
  const auto bake_with = [&](int rays, const std::function<void(BakeSettings&)>& change) {
    BakeSettings settings;
    settings.trace.rays = rays;
    change(settings);
    return baked(target, settings, context);
  };
  std::vector<Method> list;
  list.push_back({"isolux, presets (16, 64, 1024 rays)", 4, context.pick(4, 256, 4096), "rays",
                  [=](int rays) { return bake_with(rays, [](BakeSettings&) {}); }});
  list.push_back({"isolux, 2 texels a cell axis", 4, context.pick(4, 64, 1024), "rays", [=, &target](int rays) {
                    return bake_with(rays, [&target](BakeSettings& settings) {
                      settings.texels = (target.volume.lattice().size - 1) * 2;
                    });
                  }});
  list.push_back({"isolux, fit to 4 sites a cell", 4, context.pick(4, 64, 1024), "rays", [=](int rays) {
                    return bake_with(rays, [](BakeSettings& settings) {
                      settings.resampler.name = "fit";
                      settings.sites_a_cell = 4.0;
                    });
                  }});
  list.push_back(
      {"Challis 2010", 1000, context.pick(1000, 16000, 256000), "samples",
       [=, &target, &context](int samples) { return baked(target, thesis_settings(std::size_t(samples)), context); }});
  list.push_back({"Wyman 2006, K surfaces", 2, context.pick(2, 32, 512), "surfaces",
                  [=, &target, &context](int surfaces) { return coupled(target, surfaces, 64, context); }});
  if (target.bounces != 0) {
    list.push_back({"isolux, bounces by paths", 4, context.pick(4, 64, 1024), "rays", [=](int rays) {
                      return bake_with(rays,
                                       [](BakeSettings& settings) { settings.bounce_method = BounceMethod::kPaths; });
                    }});
    return list;
  }
  list.push_back({"Embree, ONE isosurface", 4, context.pick(4, 64, 1024), "rays",
                  [=, &target, &context](int rays) -> std::optional<Measured> {
                    const auto one = one_surface(target, rays, context);
                    return one ? std::optional(one->measured) : std::nullopt;
                  }});
  return list;
}

Plot curves(const Target& target, double seconds, const SuiteContext& context, Table& table) {
  Plot plot{.id = target.id,
            .title = fmt::format("Lighting all level sets: {}", target.title),
            .x_label = "seconds",
            .y_label = "rms error of e"};
  plot.sentence = fmt::format(
      "Error at {} points of as many level sets, read from the baked texture; along a curve rays, samples or surfaces "
      "grow fourfold as long as time allows. {}",
      target.points.size(),
      target.reference_error > 0.0
          ? fmt::format("The reference's own standard error is {:.2g}: no curve can fall below it.",
                        target.reference_error)
          : std::string("The reference is a closed form."));
  const std::vector<Method> all = methods(target, context);
  const Budget budget(seconds);
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Method& method = all[m];
    Series series{.name = method.name};
    Climb climb(budget.share(all.size() - m), 4.0);
    for (int step = method.first; step <= method.last && climb.goes_on(); step *= 4) {
      const auto measured = method.step(step);
      if (!measured) break;
      const Estimate& error = measured->error;
      series.points.push_back({measured->seconds, error.value, error.low, error.high});
      table.rows.push_back({target.title, method.name, fmt::format("{} {}", step, method.unit), measured->seconds,
                            error.value, error.low, error.high});
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// Lighting everything once against lighting surfaces one by one, 64 rays each.
void break_even(const Target& target, const SuiteContext& context, Table& table) {
  const int rays = context.pick(4, 64, 64);
  BakeSettings settings;
  settings.trace.rays = rays;
  const Measured all = baked(target, settings, context);
  const auto one = one_surface(target, rays, context);
  if (!one) return;
  table.rows.push_back({target.title, all.seconds, all.error.value, double(one->vertices), one->measured.seconds,
                        one->measured.error.value, all.seconds / one->measured.seconds});
}

/// How often faster isolux is than another method at the error that the latter reaches at best.
std::string times_to_reach(const Plot& plot, const std::string& title) {
  const Series& ours = plot.series.front();
  std::string text;
  for (const Series& other : plot.series) {
    if (other.name.rfind("isolux", 0) == 0 || other.name.rfind("Embree", 0) == 0 || other.points.empty()) continue;
    const auto& best = *std::min_element(other.points.begin(), other.points.end(),
                                         [](const PlotPoint& a, const PlotPoint& b) { return a.y < b.y; });
    const auto as_good =
        std::find_if(ours.points.begin(), ours.points.end(), [&](const PlotPoint& p) { return p.y <= best.y; });
    text += fmt::format("{}{} reaches {} in {} s", text.empty() ? "" : "; ", other.name, number_text(best.y),
                        number_text(best.x));
    if (as_good != ours.points.end())
      text += fmt::format(", isolux {} in {} s", number_text(as_good->y), number_text(as_good->x));
  }
  return fmt::format("{}: {}.", title, text);
}

/// Default bakes of whole volumes, by stage.
Table whole_bakes(const SuiteContext& context) {
  Table table{.id = "whole",
              .title = "Whole bakes at the defaults",
              .columns = {"volume", "texels", "million rays", "tracing, s", "bounces, s", "in all, s",
                          "Mrays/s of tracing", "sweeps", "error estimate"}};
  table.sentence = "One site a cell, 64 rays each, all bounces by iteration; the error is the bake's own estimate.";
  std::vector<std::string> names{fmt::format("gen:gyroid:{}", context.pick(9, 33, 65))};
  if (context.effort == Effort::kFull) names.emplace_back("gen:gyroid:129");
  if (!context.data_folder.empty() && context.effort == Effort::kFull) {
    for (const char* file : {"neghip_64x64x64_uint8.raw", "headsq_quarter.nrrd"}) names.emplace_back(file);
  }
  for (const std::string& name : names) {
    const bool is_generated = name.rfind("gen:", 0) == 0;
    const Volume volume = read_volume(is_generated ? name : context.data_folder + "/" + name);
    const Stopwatch watch;
    const BakeResult result = bake(volume, Scene{}, {}, context.stages, context.run);
    const double all = watch.seconds();
    const double mrays = 1e-6 * double(result.counters.rays);
    const auto seconds = [&](const char* stage) {
      const auto found = result.seconds.find(stage);
      return found == result.seconds.end() ? 0.0 : found->second;
    };
    table.rows.push_back({name, double(result.light.lattice.count()), mrays, seconds("trace"), seconds("bounces"), all,
                          mrays / seconds("trace"), double(result.sweeps), result.rmse_estimate});
  }
  return table;
}

/// Makes a target when its turn comes.
struct Maker {
  bool also_quick;
  std::function<Target(double seconds)> make;
};

std::vector<Maker> makers(const SuiteContext& context) {
  const int n = context.pick(9, 33, 65);
  const auto count = std::size_t(context.pick(100, 500, 4000));
  const auto file = [&context](const char* name) { return read_volume(context.data_folder + "/" + name); };
  std::vector<Maker> all;
  all.push_back({true, [=, &context](double) { return analytic_target(plane_under_ball(), n, count, context); }});
  all.push_back({true, [=, &context](double) { return analytic_target(integrating_sphere(), n, count, context); }});
  all.push_back({true, [=, &context](double seconds) {
                   return traced_target("gyroid", sample_analytic_field("gyroid", n), 0.0f, 0, count, seconds, context);
                 }});
  if (context.data_folder.empty() || context.effort == Effort::kSmoke) return all;
  all.push_back({true, [=, &context](double seconds) {
                   return traced_target("neghip", file("neghip_64x64x64_uint8.raw"), 80.0f, 0, count, seconds, context);
                 }});
  all.push_back({false, [=, &context](double seconds) {
                   Target target = traced_target("neghip-bounces", file("neghip_64x64x64_uint8.raw"), 80.0f,
                                                 kAllBounces, count / 4, seconds, context);
                   target.title = "neghip, all bounces";
                   return target;
                 }});
  all.push_back({false, [=, &context](double seconds) {
                   return traced_target("engine", file("engine.nrrd"), 110.0f, 0, count, seconds, context);
                 }});
  if (context.effort != Effort::kFull) std::erase_if(all, [](const Maker& maker) { return !maker.also_quick; });
  return all;
}

}  // namespace

SuiteReport run_bake(const SuiteContext& context) {
  SuiteReport report;
  Table table = figures_table();
  Table even{.id = "break-even",
             .title = "From how many isovalues on lighting everything is cheaper",
             .columns = {"scene", "all level sets, s", "rms error", "vertices of one", "one surface with Embree, s",
                         "rms error ", "break-even isovalues"}};
  even.sentence =
      "64 rays each. One surface means extraction, Embree's tree and rays at its vertices, compared at the vertices; "
      "past the last column's number of isovalues the bake of all level sets is the cheaper one.";
  const std::vector<Maker> all = makers(context);
  for (std::size_t i = 0; i < all.size(); ++i) {
    // As much again as for one target is kept for what comes after them.
    const double seconds = context.budget.share(all.size() + 1 - i);
    const Target target = all[i].make(0.15 * seconds);
    context.say(target.title);
    Plot plot = curves(target, 0.65 * seconds, context, table);
    report.highlights.push_back(times_to_reach(plot, target.title));
    report.figures.emplace_back(std::move(plot));
    if (target.bounces == 0) break_even(target, context, even);
  }
  report.figures.emplace_back(whole_bakes(context));
  if (!even.rows.empty()) report.figures.emplace_back(std::move(even));
  report.figures.emplace_back(std::move(table));
  return report;
}

}  // namespace isolux::bench
