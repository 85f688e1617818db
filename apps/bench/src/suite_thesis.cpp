#include <fmt/format.h>
#include <isolux/bake/bake.h>
#include <isolux/core/stopwatch.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/render/render.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake_target.h"
#include "stats.h"
#include "suites.h"

namespace isolux::bench {
namespace {

/// A volume of one of the thesis's sizes; `theirs` are its figures of table 5.1 by samples, kNone where it gave up.
struct ThesisVolume {
  std::string name;
  Volume volume;
  std::vector<double> theirs;
};

const std::vector<int> kSamples{100, 1000, 10000, 100000};

/// f at `size` points spread over the box: how the thesis came by its small volumes.
Volume resized(const Volume& volume, Index3 size) {
  const TrilinearField field(volume);
  Lattice lattice{.size = size, .frame = {}};
  Volume result{.values = Grid<float>(lattice), .name = volume.name};
  const Vec3 step = Vec3(volume.lattice().size - 1) / Vec3(size - 1);
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) result.values(i, j, k) = float(field.value(Vec3(i, j, k) * step));
    }
  }
  return result;
}

Volume real_or_gyroid(const SuiteContext& context, const std::string& file) {
  if (!context.data_folder.empty()) return read_volume(context.data_folder + "/" + file);
  return sample_analytic_field("gyroid", 64);
}

std::vector<ThesisVolume> volumes(const SuiteContext& context) {
  std::vector<ThesisVolume> all;
  all.push_back({"5x5x5", sample_analytic_field("torus", 5), {18, 217, 3197, 47961}});
  all.push_back({"Atom 13x13x13", sample_analytic_field("hydrogen", 13), {279, 3348, 54465, 817846}});
  all.push_back({"Engine 27x64x64",
                 resized(real_or_gyroid(context, "engine.nrrd"), {27, 64, 64}),
                 {30459, 335253, 4471965, kNone}});
  return all;
}

int rays(const SuiteContext& context) { return context.pick(4, 64, 64); }

/// Texels times samples that comparing all with all is given: a few seconds; more shows nothing new.
double affordable_work(const SuiteContext& context) { return context.pick(1e6, 3e8, 1e10); }

BakeSettings thesis_method(int samples, const SuiteContext& context) {
  BakeSettings settings = thesis_settings(std::size_t(samples));
  settings.trace.rays = rays(context);
  return settings;
}

BakeSettings same_samples(int samples, const SuiteContext& context) {
  BakeSettings settings;
  settings.samples = std::size_t(samples);
  settings.trace.rays = rays(context);
  return settings;
}

double bake_ms(const Volume& volume, const BakeSettings& settings, const SuiteContext& context) {
  const Stopwatch watch;
  (void)bake(volume, Scene{}, settings, context.stages, context.run);
  return 1e3 * watch.seconds();
}

Table total_times(const SuiteContext& context) {
  Table table{
      .id = "table-5-1",
      .title = "Table 5.1: the whole precomputation, ms",
      .columns = {"volume", "samples", "thesis", "its method here", "isolux, same samples", "isolux, a sample a texel"},
      .sentence =
          "The thesis ran on a Core 2 Duo of 2.26 GHz in 2010 and stopped after two hours; 64 rays a sample and all "
          "bounces here. "
          "Its third volume is the engine at 27x64x64 (the gyroid where no data folder is given)."};
  for (const ThesisVolume& v : volumes(context)) {
    context.say(v.name);
    BakeSettings ours;
    ours.trace.rays = rays(context);
    const double every_texel = bake_ms(v.volume, ours, context);
    for (std::size_t s = 0; s < kSamples.size(); ++s) {
      const double work = double(kSamples[s]) * double(v.volume.lattice().count());
      const bool affordable = work <= affordable_work(context);
      table.rows.push_back({v.name, double(kSamples[s]), v.theirs[s],
                            affordable ? bake_ms(v.volume, thesis_method(kSamples[s], context), context) : kNone,
                            kSamples[s] <= context.pick(100, 10000, 100000)
                                ? bake_ms(v.volume, same_samples(kSamples[s], context), context)
                                : kNone,
                            every_texel});
    }
  }
  return table;
}

Table stage_times(const SuiteContext& context) {
  Table table{.id = "table-5-2",
              .title = "Table 5.2: stages at 10,000 samples, ms",
              .columns = {"volume", "stage", "thesis", "here"},
              .sentence =
                  "Shepard's interpolation with k = 11, p = .5, Chebyshev distance: by comparing every texel with "
                  "every sample as the thesis does, and over a cell grid."};
  const std::vector<std::vector<double>> theirs{{1909, 33730, 2789026}, {32, 32, 195}};
  const Settings shepard{{"k", "11"}, {"exponent", "0.5"}, {"distance", "chebyshev"}};
  std::size_t column = 0;
  for (const ThesisVolume& v : volumes(context)) {
    const Lattice texels = voxel_lattice(v.volume.lattice());
    const auto sampler = context.stages.samplers.create("random");
    const Stopwatch sites_watch;
    Sites sites = sampler->sample(v.volume, {.texels = texels, .count = 10000}, context.run);
    table.rows.push_back(
        {v.name, std::string("sites (theirs: sample creation)"), theirs[1][column], 1e3 * sites_watch.seconds()});
    const Stopwatch trace_watch;
    const SampleSet samples = context.stages.tracers.create()
                                  ->trace(v.volume, Scene{}, std::move(sites), {.rays = rays(context)}, context.run)
                                  .samples;
    table.rows.push_back({v.name, std::string("tracing, 64 rays, all bounces"), kNone, 1e3 * trace_watch.seconds()});
    for (const char* backend : {"brute_force", "cell_grid"}) {
      const double work = 1e4 * double(v.volume.lattice().count());
      const bool affordable = std::string(backend) != "brute_force" || work <= affordable_work(context);
      const auto resampler = context.stages.resamplers.create(backend, shepard);
      const Stopwatch watch;
      if (affordable) (void)resampler->resample(v.volume, samples, texels, context.run);
      table.rows.push_back({v.name, fmt::format("Shepard's interpolation, {}", backend), theirs[0][column],
                            affordable ? Cell(1e3 * watch.seconds()) : Cell(kNone)});
    }
    ++column;
  }
  return table;
}

Table extraction_rates(const SuiteContext& context) {
  Table table{.id = "table-5-3",
              .title = "Table 5.3: marching cubes with normals, surfaces a second",
              .columns = {"volume", "isovalue", "thesis: triangles", "surfaces/s", "here: triangles", "surfaces/s "},
              .sentence =
                  "The thesis's figures include drawing; ours are extraction into an indexed mesh with gradient "
                  "normals, one isovalue after another."};
  struct Row {
    std::string name;
    Volume volume;
    float isovalue;
    double triangles;
    double rate;
  };
  const bool real = !context.data_folder.empty();
  std::vector<Row> rows;
  rows.push_back({"5x5x5", sample_analytic_field("torus", 5), -0.2f, 125, 60});
  rows.push_back({"Atom 13x13x13", sample_analytic_field("hydrogen", 13), 0.1f, 152, 59});
  rows.push_back({"Engine 27x64x64", resized(real_or_gyroid(context, "engine.nrrd"), {27, 64, 64}),
                  real ? 127.0f : 0.0f, 34306, 4});
  rows.push_back(
      {"NegHip 64x64x64", real_or_gyroid(context, "neghip_64x64x64_uint8.raw"), real ? 127.0f : 0.0f, 16656, 2});
  for (const Row& row : rows) {
    IsoExtractor extractor(row.volume, context.run);
    IndexedMesh mesh;
    const Estimate seconds = timed([&] { extractor.extract({.isovalue = row.isovalue}, context.run, mesh); }, 50,
                                   context.pick(0.05, 0.5, 1.0));
    table.rows.push_back(
        {row.name, double(row.isovalue), row.triangles, row.rate, double(mesh.triangles.size()), 1.0 / seconds.value});
  }
  return table;
}

Table frame_rates(const SuiteContext& context) {
  Table table{.id = "table-5-4",
              .title = "Table 5.4: frames a second, lit locally and by texture",
              .columns = {"volume", "thesis: local", "texture", "here: local", "texture "},
              .sentence =
                  "The thesis draws triangles on a graphics card of 2010; here the level set itself is cast by rays on "
                  "the processor, 256x256 pixels, "
                  "one ray a pixel. What compares is the price of the light: the ratio of the two columns."};
  struct Row {
    std::string name;
    Volume volume;
    float isovalue;
    double local;
    double texture;
  };
  const bool real = !context.data_folder.empty();
  std::vector<Row> rows;
  rows.push_back({"5x5x5", sample_analytic_field("torus", 5), -0.2f, 59, 55});
  rows.push_back({"Atom 13x13x13", sample_analytic_field("hydrogen", 13), 0.1f, 60, 59});
  rows.push_back(
      {"Engine 27x64x64", resized(real_or_gyroid(context, "engine.nrrd"), {27, 64, 64}), real ? 127.0f : 0.0f, 29, 19});
  rows.push_back(
      {"NegHip 64x64x64", real_or_gyroid(context, "neghip_64x64x64_uint8.raw"), real ? 127.0f : 0.0f, 52, 30});
  for (const Row& row : rows) {
    const Camera camera = orbit_camera(row.volume.lattice(), 30.0, 20.0, 1.0);
    const IlluminationGrid light(cell_lattice(row.volume.lattice()), 1);
    const LightReader reader(row.volume, light);
    const LightAt read = [&reader](const SurfacePoint& point) { return reader.at_index(point.index); };
    const RenderSettings settings{.width = 256, .height = 256, .supersampling = 1, .isovalue = row.isovalue};
    const auto rate = [&](const Shader& shader) {
      return 1.0 / timed([&] { (void)render(row.volume, camera, settings, shader, context.run); }, 9,
                         context.pick(0.05, 0.7, 1.5))
                       .value;
    };
    table.rows.push_back(
        {row.name, row.local, row.texture, rate(local_shader(Vec3f(0.8f))), rate(global_shader(read, {}))});
  }
  return table;
}

}  // namespace

SuiteReport run_thesis(const SuiteContext& context) {
  SuiteReport report;
  Table totals = total_times(context);
  const auto& row = totals.rows.back();
  report.highlights.push_back(fmt::format(
      "{} samples on {}: the thesis needed {} ms for {} samples, isolux {} ms for a sample at every texel.",
      number_text(std::get<double>(totals.rows[totals.rows.size() - 2][1])), std::get<std::string>(row[0]),
      number_text(std::get<double>(totals.rows[totals.rows.size() - 2][2])),
      number_text(std::get<double>(totals.rows[totals.rows.size() - 2][1])), number_text(std::get<double>(row[5]))));
  report.figures.emplace_back(std::move(totals));
  report.figures.emplace_back(stage_times(context));
  report.figures.emplace_back(extraction_rates(context));
  report.figures.emplace_back(frame_rates(context));
  return report;
}

}  // namespace isolux::bench
