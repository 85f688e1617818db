// isolux-view: the interactive window. `isolux view` starts it with the arguments that it was given.
#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/scene_file.h>
#include <isolux/bake/version.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/texture_uploader.h>
#include <isolux/volume_io/read.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "app/app.h"
#include "app/window.h"
#include "bake_options.h"
#include "isovalue_option.h"
#include "light_options.h"
#include "parse.h"
#include "program.h"
#include "registry_json.h"
#include "scene_files.h"
#include "session.h"
#include "usage.h"
#include "volume_options.h"

namespace {

using namespace isolux;

/// What X11 and the drivers take.
constexpr int kLargestWindow = 16384;

/// Without an extension it may be a pipe, as for isolux render. \throw UsageError
void require_png(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (!extension.empty() && extension != ".png")
    throw UsageError(fmt::format("--screenshot: {}: pictures are written as .png", path));
}

/// The words of the command line, besides those that other commands have too.
struct Words {
  VolumeOptions volume;
  LightOptions light;
  std::string scene;
  IsovalueOption iso;
  std::string screenshot;
  int frames = 0;
  std::string size = "1200x800";
  std::string view = "30,20";
  std::string mode;
  bool exact_light = false;
  double exposure = 0.0;
  std::string outer;
  std::string backend;
  std::vector<std::string> set;

  void add_to(CLI::App& program, Session& session) {
    volume.add_to(program, session);
    program.get_option("VOLUME")->required(false)->description(
        "a file, a folder of DICOM slices, or gen:NAME[:N]; without one a test field is shown");
    light.add_to(program, session);
    session.reads({.name = "--scene", .paths = [this] { return scene_files(scene); }});
    program
        .add_option(
            "--scene", scene,
            "what lights a draft (key b) and, without --light, exact light (default: uniform white sky, albedo 0.8)")
        ->type_name("SCENE.json");
    iso.add_one_to(program,
                   "isovalue to start with, or as many standard deviations above the mean of the volume's values, such "
                   "as 2.5sigma (default: Otsu's threshold)");
    program.add_option("--mode", mode, "global (default with --light), local, or both side by side")
        ->check(CLI::IsMember({"global", "local", "both"}));
    program.add_flag("--exact-light", exact_light, "trace the light at the vertices of the surface, as key x does");
    program.add_option("--view", view, "from where, in degrees (default 30,20)")->type_name("AZIMUTH,ELEVATION");
    program.add_option("--exposure", exposure, "stops by which the global light is made brighter")
        ->check(finite_number())
        ->type_name("STOPS");
    program
        .add_option("--outer", outer,
                    "the side that is outside: lower or higher values (default: what the light or scene says)")
        ->check(CLI::IsMember({"lower", "higher"}));
    program.add_option("--backend", backend, "extractor backend")->type_name("NAME");
    program.add_option("--set", set, "an option of the extractor")->check(key_and_value())->type_name("KEY=VALUE");
    program.add_option("--size", size, "of the window (default 1200x800)")->type_name("WxH");
    session.writes(
        program.add_option("--screenshot", screenshot, "write a picture before leaving")->type_name("OUT.png"));
    program.add_option("--frames", frames, "draw so many pictures and leave")
        ->transform(whole_number(1, 1000000))
        ->type_name("N");
  }

  /// Refuses a light of the other side than --outer alone, as render does. \throw IoError, InvalidInput
  [[nodiscard]] viewer::KnownLight read_light(const Volume& shown, std::optional<float> isovalue,
                                              Session& session) const {
    const auto file = std::make_shared<const LightFile>(light.read(shown, session));
    if (const auto side = outer_side()) static_cast<void>(light.of_side(*file, side_towards(*file, *side)));
    if (isovalue && mode != "local" && !exact_light) warn_outside_light(*file, {&*isovalue, 1}, session);
    return viewer::known_light(file);
  }

  [[nodiscard]] std::optional<OuterSide> outer_side() const {
    if (outer.empty()) return std::nullopt;
    return outer == "higher" ? OuterSide::kHigher : OuterSide::kLower;
  }

  /// All but the isovalue, which may be told by the volume's values. \throw UsageError, IoError, InvalidInput
  [[nodiscard]] viewer::AppSettings settings(const Session& session) const {
    viewer::AppSettings result;
    std::tie(result.width, result.height) = parse_size2("--size", size);
    if (std::max(result.width, result.height) > kLargestWindow)
      throw UsageError(fmt::format("--size = '{}': allowed is {} pixels each way", size, kLargestWindow));
    const auto angles = parse_numbers("--view", view, 2);
    result.frames = frames == 0 && !screenshot.empty() ? 1 : frames;
    result.screenshot = screenshot;
    require_png(screenshot);
    result.viewer.azimuth_deg = angles[0];
    result.viewer.elevation_deg = angles[1];
    result.viewer.exposure_stops = exposure;
    result.viewer.exact_light = exact_light;
    result.viewer.help = volume.source().empty();
    result.viewer.extractor.name = backend;
    apply_settings("--set", set, {{"extractor", &result.viewer.extractor.settings}});
    require_choice(session.stages.extractors, result.viewer.extractor);
    result.viewer.run = session.run;
    if (!scene.empty()) result.viewer.scene = read_scene(scene);
    result.viewer.outer = outer_side();
    if (mode == "local") result.viewer.layout = viewer::Layout::kLocal;
    if (mode == "global") result.viewer.layout = viewer::Layout::kGlobal;
    if (mode == "both") result.viewer.layout = viewer::Layout::kSideBySide;
    if (mode != "local" && !mode.empty() && !light.given() && !exact_light) {
      throw UsageError("--mode " + mode + ": it shows a light; give --light LIGHT.nrrd or --exact-light");
    }
    return result;
  }
};

/// The isovalue asked for, drawn into the volume's values, with a warning, as the slider has no place for others.
float within_values(float isovalue, const viewer::Document& document, const Session& session) {
  const ValueRange range = document.histogram.range;
  if (isovalue >= range.low && isovalue <= range.high) return isovalue;
  session.warn(fmt::format("--iso {} lies outside the values of {} ({} to {}): the nearest of these is shown", isovalue,
                           document.volume->name(), range.low, range.high));
  return std::clamp(isovalue, range.low, range.high);
}

void look(const Words& words, viewer::AppSettings settings, Session& session) {
  const viewer::WindowSystem windows;
  const bool given = !words.volume.source().empty();
  StoredVolume volume =
      given ? words.volume.read_stored(session) : read_stored_volume("gen:marschner-lobb", {}, session.run);
  std::optional<float> isovalue;
  if (words.iso.given()) isovalue = words.iso.in(volume).front();
  viewer::Document document = viewer::make_document(std::move(volume));
  if (isovalue) isovalue = within_values(*isovalue, document, session);
  if (words.light.given()) document.light = words.read_light(document.volume->floats(), isovalue, session);
  if (isovalue) settings.viewer.isovalue = double(*isovalue);
  session.report["settings"]["isovalue"] =
      session.timed("view", [&] { return viewer::run_app(std::move(document), settings, session.stages); });
}

int view(int argc, char** argv, Session& session) {
  Words words;
  CLI::App program("Looks at the isosurfaces of a volume, in local and in global light.", "isolux view");
  program.set_version_flag("--version", std::string("isolux ") + kVersion);
  words.add_to(program, session);
  // `isolux backends`, which links no GL, asks here for the stage that does.
  program.add_flag_callback(
      "--uploaders",
      [] {
        fmt::print("{}\n", stage_to_json(uploaders()).dump());
        throw CLI::Success();
      },
      "print the texture uploaders as JSON and leave");
  session.add_common_options(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return print_help(program, help);
  } catch (const CLI::ParseError& error) {
    throw UsageError(explain(error, program));
  }
  // Taken before the session shows progress, which is for the volume's and the light's way in alone.
  const viewer::AppSettings settings = words.settings(session);
  session.on_run([&] { look(words, settings, session); });
  session.run_action();
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("view", [&](Session& session, std::string& /*what*/) { return view(argc, argv, session); });
}
