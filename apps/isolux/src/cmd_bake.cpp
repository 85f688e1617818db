#include <fmt/format.h>
#include <isolux/bake/choose_texels.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/memory_foreseen.h>
#include <isolux/core/machine_memory.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "bake_command.h"
#include "commands.h"
#include "memory.h"
#include "usage.h"
#include "volume_options.h"

namespace isolux {
namespace {

/// What --texels auto lets the texels be wrong by: a little less than one a cell is on real volumes.
constexpr double kTexelError = 0.05;
/// How much larger than asked an error may be without a word.
constexpr double kNear = 1.05;

void report_bake(const BakeResult& result, Session& session) {
  const Lattice& texels = result.light.lattice;
  auto& report = session.report;
  report["rays"] = result.counters.rays;
  report["hits"] = result.counters.hits;
  report["macrocells"] = result.counters.macrocells;
  report["cells"] = result.counters.cells;
  report["cubics"] = result.counters.cubics;
  report["sites"] = result.sites;
  report["rays_a_site"] = {{"least", result.least_rays}, {"most", result.most_rays}};
  report["skipped"] = result.skipped;
  report["skipped"]["searches_for_hits"] = result.counters.proven;
  report["skipped"]["rays_to_suns"] = result.counters.known;
  if (result.seconds_beyond_time > 0.0) report["seconds_beyond_time"] = result.seconds_beyond_time;
  report["link_bytes"] = result.link_bytes;
  report["texels"] = texels.count();
  report["texel_dims"] = {texels.size.x, texels.size.y, texels.size.z};
  report["sweeps"] = result.sweeps;
  report["unlit_texels"] = result.unlit_texels;
  report["rmse_estimate"] = result.rmse_estimate;
  report["noise"] = result.noise;
  report["reading_error"] = result.reading_error;
  for (std::size_t i = 0; i < result.sides.size(); ++i) {
    const SideFigures& side = result.sides[i];
    report["sides"][i == 0 ? "outer" : "inner"] = {
        {"sites", side.sites}, {"rays", side.rays}, {"rmse_estimate", side.rmse_estimate}};
  }
}

/// What was done otherwise than asked, and why.
void say_what_was_done(const BakeResult& result, const Session& session) {
  if (const auto it = result.skipped.find("links_beyond_memory"); it != result.skipped.end()) {
    const char* instead =
        result.sweeps == 0 ? "reflections are followed by paths" : "they are traced for the last reflection alone";
    session.say(fmt::format("{} rays are too many to keep: {}", it->second, instead));
  }
  if (result.skipped.contains("sweeps_beyond_limit"))
    session.warn(
        "reflections have not settled: light that hardly fades, as of an albedo near 1 in a closed space, may be far "
        "off");
  if (const auto it = result.skipped.find("paths_cut"); it != result.skipped.end())
    session.warn(
        fmt::format("{} paths were cut off after the most reflections (tracer.longest_path): behind narrow ways out of "
                    "white surfaces the light may be too dark; --bounce-method iterated knows no such limit",
                    it->second));
  if (const auto it = result.skipped.find("places_unjudged"); it != result.skipped.end())
    session.warn(fmt::format(
        "{} of the places that the error is judged by lie in pockets that hardly any path leaves, of nearly "
        "white surfaces: how wrong the light of such pockets is nobody knows",
        it->second));
  if (result.seconds_beyond_time > 0.0)
    session.warn(
        fmt::format("--time {} is exceeded by {:.2g} s: {} rays of each of {} sites took so long; fewer texels "
                    "(--texels-a-cell), --bounces 0 or an --iso-range take less",
                    result.settings.target_seconds, result.seconds_beyond_time, result.least_rays, result.sites));
  if (result.skipped.contains("reading_beyond_error"))
    session.say(
        "read from texels, reflections would be wrong by more than the error asked: they are followed by paths");
  if (result.skipped.contains("rounds_beyond_memory"))
    session.warn("the error asked is not reached: more rays than can be kept; --bounce-method paths needs no memory");
}

/// Of texels made of several sites.
const char* what_takes_errors_away(const BakeSettings& settings) {
  if (settings.sampler.name == "texels") return "texels that are not denoised do";
  if (settings.isovalues) return "light traced at the vertices is exact (extract --exact-light)";
  if (settings.resampler.name == "fit") return "more texels do (--texels-a-cell)";
  return "more --samples, or the default's one site at each texel, do";
}

/// Small volumes and rough light can end above what was asked.
void say_of_error(const BakeResult& result, double asked, const Session& session) {
  double error = result.rmse_estimate;  // which is asked of each side
  for (const SideFigures& side : result.sides) error = std::max(error, side.rmse_estimate);
  if (!(asked > 0.0 && error > kNear * asked)) return;
  std::string why;
  const double reading = result.reading_error / error;
  if (result.skipped.contains("error_beyond_rays") && reading * reading < 0.5)
    why = fmt::format("; more rays would hardly take any away, but {}", what_takes_errors_away(result.settings));
  else if (result.reading_error > 0.0)
    why = fmt::format(
        "; reading reflections from texels is wrong by about {:.4f}, which more texels or --bounce-method paths take "
        "away",
        result.reading_error);
  else if (result.noise > 0.0 && result.noise <= kNear * asked)
    why = "; the noise of its rays is less than asked, and the rest may be that of the paths that judge it";
  session.warn(fmt::format("the error asked is not reached: about {:.4f} of {}{}", error, asked, why));
}

/// --texels auto
void choose_size(const BakeOptions& options, const Volume& volume, const Scene& scene, BakeSettings& settings,
                 Session& session) {
  const double target = options.rmse > 0.0 ? options.rmse : kTexelError;
  const TexelChoice chosen = session.timed(
      "texels", [&] { return choose_texels(volume, scene, settings, target, session.stages, session.run); });
  settings.texels = chosen.texels;
  session.report["texel_error"] = chosen.error;
  const std::string texels = fmt::format("{}x{}x{} texels", chosen.texels.x, chosen.texels.y, chosen.texels.z);
  if (options.rmse > 0.0 && chosen.error > kNear * target)
    session.warn(fmt::format(
        "the error asked is not reached: light is wrong by about {:.4f} of {} between {}, the best of up to two a cell "
        "and axis; --texels or --texels-a-cell takes more",
        chosen.error, target, texels));
  else
    session.say(fmt::format("{}, wrong by about {:.3f} between them ({} {})", texels, chosen.error,
                            options.rmse > 0.0 ? "asked" : "sought", target));
}

/// Says beforehand what the system would say after minutes, by killing the program.
void foresee_memory(const BakeOptions& options, const Volume& volume, const Scene& scene, const BakeSettings& settings,
                    Session& session) {
  const double bytes = memory_foreseen(volume, scene, settings, session.stages);
  session.report["memory_bytes_foreseen"] = std::uint64_t(bytes + double(sizeof(float) * volume.lattice().count()));
  const double left = free_memory();
  if (bytes < left) return;
  std::string less = "fewer texels (--texels-a-cell)";
  if (settings.lattice == TexelLattice::kVoxels) less = "--lattice cells and fewer texels (--texels-a-cell)";
  if (options.samples > 0)
    less = "fewer --samples";
  else if (settings.resampler.name == "fit")
    less = "--resampler direct";
  if (iterates(settings) && settings.trace.bounces != 0) less += ", --bounce-method paths";
  if (!settings.isovalues && options.samples == 0) less += " or an --iso-range";
  session.warn(
      fmt::format("this takes about {:.1f} GB of memory beside the volume, and {:.1f} GB are free: {} take less",
                  bytes * 1e-9, left * 1e-9, less));
}

/// What a bake takes memory for, and by which words it takes less.
std::string wanted(const BakeOptions& options, const Volume& volume, const BakeSettings& settings) {
  const Index3 texels = texel_lattice(volume.lattice(), settings).size;
  const std::string grid = fmt::format("{}x{}x{} texels", texels.x, texels.y, texels.z);
  if (options.samples > 0) return fmt::format("{} --samples and {}", options.samples, grid);
  return grid + " and their sites: fewer (--texels, --texels-a-cell), --rays or an --iso-range take less";
}

/// \throw UsageError before any work is done for a light under another format's name
void require_light_name(const std::string& option, const std::string& path) {
  constexpr std::array kOthers{".nhdr", ".nii", ".gz",   ".mha", ".mhd", ".mrc", ".map", ".ccp4", ".vtk",
                               ".vti",  ".tif", ".tiff", ".dcm", ".raw", ".npy", ".ply", ".obj",  ".stl",
                               ".off",  ".glb", ".png",  ".jpg", ".exr", ".hdr", ".csv", ".json"};
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (std::find(kOthers.begin(), kOthers.end(), extension) != kOthers.end())
    throw UsageError(fmt::format("{}: {}: light is written as .nrrd, header and data in one", option, path));
}

void run_bake(const BakeOptions& options, Session& session) {
  require_light_name("--output", options.output);
  require_light_name("--error-grid", options.error_grid);
  BakeSettings settings = bake_settings(options, session.stages);
  const Volume volume = options.volume.read(session);
  if (is_in_sigmas(options.iso_range))
    settings = bake_settings(options, session.stages, value_moments(volume.values.values()));
  const Scene scene = session.timed("read", [&] { return options.trace.scene(); });
  if (options.chooses_texels()) choose_size(options, volume, scene, settings, session);
  foresee_memory(options, volume, scene, settings, session);
  BakeResult result = with_memory_for(wanted(options, volume, settings),
                                      [&] { return bake(volume, scene, settings, session.stages, session.run); });
  for (const auto& [stage, seconds] : result.seconds) session.add_seconds(stage, seconds);
  const double trace_seconds = std::max(result.seconds["trace"], 1e-9);
  report_bake(result, session);
  say_what_was_done(result, session);
  say_of_error(result, options.rmse, session);
  session.report["rays_per_second"] = double(result.counters.rays) / trace_seconds;
  const bool known = !std::isnan(result.rmse_estimate);
  session.say(fmt::format(
      "{} texels{} from {} sites, {:.1f} million rays in {:.1f} s ({:.2f} million a second), error {}",
      result.light.lattice.count(), result.sides.empty() ? "" : " of both sides", result.sites,
      double(result.counters.rays) * 1e-6, trace_seconds, double(result.counters.rays) * 1e-6 / trace_seconds,
      known ? fmt::format("about {:.4f}", result.rmse_estimate) : "unknown: one ray a site tells nothing about it"));
  session.timed("write", [&] {
    if (!options.error_grid.empty()) {
      write_light(make_error_file(result, volume, scene, session.run), options.error_grid, volume.space,
                  {.compress = options.compress});
    }
    const LightFile light = make_light_file(std::move(result), volume, scene, session.run);
    session.report["settings"] = nlohmann::json::parse(light.metadata.at("isolux.settings"));
    write_light(light, options.output, volume.space, {.compress = options.compress});
  });
}

}  // namespace

void add_bake_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("bake", "Light all level sets of a volume at once");
  const auto options = std::make_shared<BakeOptions>();
  options->volume.add_to(command, session);
  session.writes(
      command.add_option("-o,--output", options->output, "the light to write")->required()->type_name("LIGHT.nrrd"));
  options->trace.add_to(command, session, "a site");
  command
      .add_option("--iso-range", options->iso_range,
                  "light only these level sets: LO:HI, or H:H for one, each a number or standard deviations above the "
                  "mean, such "
                  "as 2.5sigma; with --resampler fit more accurately than all at once")
      ->type_name("LO:HI");
  command
      .add_option("--texels", options->texels,
                  "size of the light's grid (default: one texel a cell); auto: the fewest that are wrong by no more "
                  "than --rmse "
                  "(default .05) between them")
      ->type_name("NXxNYxNZ|auto");
  CLI::Option* texels = command.get_option("--texels");
  command
      .add_option(
          "--texels-a-cell", options->texels_a_cell,
          "texels a cell on each axis, 1.5 too (default 1; with --resampler fit .73, .97 for one isovalue, .8 for a "
          "range): with the fit 1.17 is better light, 1.58 the best, for two and a half times the rays of 1.17")
      ->check(number_within(0.125, 8.0))
      ->excludes(texels)
      ->type_name("N");
  command.add_option("--lattice", options->lattice, "texels at the cell centres (default) or at the voxels")
      ->check(CLI::IsMember({"cells", "voxels"}));
  command
      .add_option(
          "--bounce-method", options->bounce_method,
          "iterated: trace once, keep the hits and iterate on the grid (default of resamplers direct and fit, unless "
          "--tracer, --set tracer... or scattered --sites need is given); paths: unbiased")
      ->check(CLI::IsMember({"iterated", "paths"}));
  command
      .add_option("--rmse", options->rmse,
                  "error wanted: spends rays where they take away most error until it is reached")
      ->check(above_zero())
      ->type_name("TARGET");
  command
      .add_option("--sites", options->sites,
                  "all (default), or need: with --rmse few texels, the others being predicted; of scattered sites "
                  "(--resampler fit) half where the others say that light changes")
      ->check(CLI::IsMember({"all", "need"}));
  command
      .add_option("--time", options->time,
                  "seconds to spend on rays and bounces; with --rmse: at most. Four rays a site are traced, however "
                  "long they take")
      ->check(above_zero())
      ->type_name("SECONDS");
  session.writes(
      command.add_option("--error-grid", options->error_grid, "write the estimated standard error at each texel")
          ->type_name("FILE.nrrd"));
  command.add_option("--samples", options->samples, "number of scattered sites (default: one at each texel)")
      ->transform(whole_number(1, std::uint64_t(1) << 40))
      ->type_name("N");
  command.add_option("--sampler", options->sampler, "sampler backend")->type_name("NAME");
  command.add_option("--resampler", options->resampler, "resampler backend")->type_name("NAME");
  command
      .add_option("--set", options->set,
                  "an option of a backend: sampler.KEY=VALUE, tracer.KEY=VALUE or resampler.KEY=VALUE")
      ->check(key_and_value())
      ->type_name("stage.key=value");
  command.add_flag("--compress", options->compress,
                   "gzip the light (--iso-range with --resampler fit leaves most of it empty)");
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_bake(*options, session); }); });
}

}  // namespace isolux
