#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/render/render.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "bake_options.h"
#include "commands.h"
#include "isovalue_option.h"
#include "light_options.h"
#include "parse.h"
#include "usage.h"
#include "volume_options.h"

namespace isolux {
namespace {

/// Tangent of half the angle of view from within a volume: 60 degrees.
constexpr double kHalfHeightFromWithin = 0.577;
/// Pixels between the two pictures of --mode both.
constexpr int kGap = 4;

struct RenderOptions {
  VolumeOptions volume;
  LightOptions light;
  SideOption side;
  IsovalueOption iso;
  float isovalue = 0.0f;  ///< `iso` in the volume, once that is read
  std::string output;
  std::string size = "800x600";
  std::string view = "30,20";
  std::string eye;
  std::string up = "0,0,1";
  std::string projection = "perspective";
  std::string frame = "box";
  double zoom = 1.0;
  std::string background;
  std::string mode;
  int samples = 3;
  std::optional<double> exposure;
  OuterOption outer;
};

/// The surface brighter by so many stops; what is seen beside it stays.
Shader exposed(Shader shader, double stops) {
  return [shader = std::move(shader), factor = float(std::exp2(stops))](const SurfacePoint& point) {
    return factor * shader(point);
  };
}

/// Baked light as a shader. A light of both sides shows each where it is, whatever --outer says; one that does not have
/// the side that is shown is refused.
Shader baked_shader(const Volume& volume, const LightFile& light, const RenderOptions& options, OuterSide outer,
                    const Run& run) {
  const auto reading = [&](LevelSetSide side) -> LightAt {
    const auto reader =
        std::make_shared<LightReader>(volume, options.light.of_side(light, side), TexelStorage::kBricks, run);
    const double isovalue = double(options.isovalue);
    return [reader, isovalue](const SurfacePoint& point) { return reader->at_index(point.index, isovalue); };
  };
  const SurfaceColour colour = surface_colour(light, options.isovalue);
  if (options.side.given()) {
    const OuterSide shown = options.side.or_outer() == LevelSetSide::kInner ? opposite(outer) : outer;
    const LightAt light_there = reading(side_towards(light, shown));
    return global_shader(light_there, light_there, colour);
  }
  if (!light.inner) return global_shader(reading(side_towards(light, outer)), colour);
  LightAt first = reading(LevelSetSide::kOuter);
  LightAt second = reading(LevelSetSide::kInner);
  if (outer != light_outer(light)) std::swap(first, second);
  return global_shader(std::move(first), std::move(second), colour);
}

View view_of(const RenderOptions& options) {
  const auto turn = parse_numbers("--view", options.view, 2);
  const auto up = parse_numbers("--up", options.up, 3);
  if (up[0] == 0.0 && up[1] == 0.0 && up[2] == 0.0)
    throw UsageError(fmt::format("--up = '{}': allowed is a direction, such as 0,1,0", options.up));
  return {.azimuth_deg = turn[0],
          .elevation_deg = turn[1],
          .up = {up[0], up[1], up[2]},
          .projection = options.projection == "orthographic" ? Projection::kOrthographic : Projection::kPerspective};
}

/// At the surface, where --frame asks for it and there is one, or at the middle of the box.
Camera outer_camera(const RenderOptions& options, const Volume& volume, const View& view, double aspect,
                    const Session& session) {
  if (options.frame == "surface") {
    IndexedMesh mesh;
    IsoExtractor(volume, session.run, IsoExtractor::Index::kNone)
        .extract({.isovalue = options.isovalue}, session.run, mesh);
    if (!mesh.positions.empty()) return framing_camera(mesh.positions, view, aspect);
  }
  return orbit_camera(volume.lattice(), view, aspect);
}

/// From outside, or out of --eye.
Camera camera_of(const RenderOptions& options, const Volume& volume, double aspect, const Session& session) {
  const View view = view_of(options);
  Camera camera;
  if (options.eye.empty()) {
    camera = outer_camera(options, volume, view, aspect, session);
  } else {
    camera = orbit_camera(volume.lattice(), view, aspect);
    const auto eye = parse_numbers("--eye", options.eye, 3);
    camera.eye = {eye[0], eye[1], eye[2]};
    camera.half_height = kHalfHeightFromWithin;
  }
  camera.half_height /= options.zoom;
  return camera;
}

/// As linear radiance; nothing for a transparent one. \throw UsageError
std::optional<Vec3f> background_of(const RenderOptions& options) {
  if (options.background.empty()) return RenderSettings{}.background;
  if (options.background == "transparent") return std::nullopt;
  const std::string wrong =
      fmt::format("--background = '{}': allowed are transparent, or R,G,B from 0 to 255", options.background);
  Vec3f colour(0.0f);
  try {
    const auto codes = parse_numbers("--background", options.background, 3);
    for (int c = 0; c < 3; ++c) {
      const double code = codes[std::size_t(c)];
      if (!(code >= 0.0 && code <= 255.0) || code != std::floor(code)) throw UsageError(wrong);
      colour[c] = linear_value(std::uint8_t(code));
    }
  } catch (const UsageError&) {
    throw UsageError(wrong);
  }
  return colour;
}

/// \throw UsageError before any work is done for a picture that cannot be written. Without an extension it may be a
/// pipe.
void require_png(const std::string& path, int width, int height, int channels) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (!extension.empty() && extension != ".png")
    throw UsageError(fmt::format("--output: {}: pictures are written as .png", path));
  try {
    require_png_size(width, height, channels);
  } catch (const InvalidInput& error) {
    throw UsageError(fmt::format("--size: {}", error.what()));
  }
}

void warn_of_no_effect(const RenderOptions& options, const std::string& mode, const Session& session) {
  options.light.warn_of_no_effect(session);
  if (options.exposure && mode != "global" && mode != "both")
    session.warn(fmt::format("--exposure has no effect with --mode {}: it is of global light", mode));
  if (!options.eye.empty() && options.frame != "box") session.warn("--frame has no effect with --eye");
  if (mode == "normal" && options.light.given() && !options.side.given())
    session.warn("--light has no effect with --mode normal");
}

nlohmann::json picture_settings(const RenderOptions& options, const RenderSettings& settings, const std::string& mode) {
  nlohmann::json result = {{"isovalue", options.isovalue},
                           {"size", {settings.width, settings.height}},
                           {"view", parse_numbers("--view", options.view, 2)},
                           {"mode", mode},
                           {"samples", options.samples},
                           {"outer", name_of(settings.outer)},
                           {"exposure", options.exposure.value_or(0.0)}};
  if (!options.eye.empty()) result["eye"] = parse_numbers("--eye", options.eye, 3);
  const RenderOptions usual;
  if (options.up != usual.up) result["up"] = parse_numbers("--up", options.up, 3);
  if (options.projection != usual.projection) result["projection"] = options.projection;
  if (options.frame != usual.frame) result["frame"] = options.frame;
  if (options.zoom != usual.zoom) result["zoom"] = options.zoom;
  if (options.background != usual.background) result["background"] = options.background;
  if (options.light.given()) result["light"] = options.light.path();
  if (options.side.given()) result["side"] = options.side.name();
  return result;
}

void run_render(RenderOptions options, Session& session) {
  const auto [width, height] = parse_size2("--size", options.size);
  if (view_of(options).projection == Projection::kOrthographic && !options.eye.empty())
    throw UsageError("--projection orthographic: --eye looks in perspective; give one of them");
  const std::optional<Vec3f> background = background_of(options);
  const int channels = background ? 3 : 4;
  if (!options.eye.empty()) static_cast<void>(parse_numbers("--eye", options.eye, 3));
  const std::string mode = !options.mode.empty() ? options.mode : options.light.given() ? "global" : "local";
  if ((mode == "global" || mode == "both") && !options.light.given()) {
    throw UsageError("--mode " + mode + ": it shows a light; give --light LIGHT.nrrd");
  }
  require_png(options.output, width, height, channels);
  if (mode == "both") require_png(options.output, 2 * width + kGap, height, channels);
  warn_of_no_effect(options, mode, session);
  const Volume volume = options.volume.read(session);
  options.isovalue = options.iso.in(volume);
  std::optional<LightFile> light;
  if (options.light.given()) light = options.light.read(volume, session);
  warn_outside_range(volume, options.isovalue, session);
  if (light && (mode == "global" || mode == "both")) warn_outside_light(*light, options.isovalue, session);

  const Vec3f albedo = light ? surface_colour(*light, options.isovalue).albedo : SurfaceColour{}.albedo;
  RenderSettings settings{
      .width = width, .height = height, .supersampling = options.samples, .isovalue = options.isovalue};
  settings.outer = light ? light_outer(*light) : OuterSide::kLower;
  settings.outer = options.outer.or_else(settings.outer);
  settings.only = options.side.given();
  settings.background = background;
  const double aspect = double(width) / height;
  const Camera camera = session.timed("frame", [&] { return camera_of(options, volume, aspect, session); });
  const auto draw = [&](const Shader& shader) { return render(volume, camera, settings, shader, session.run); };
  Image image = session.timed("render", [&]() -> Image {
    if (mode == "normal") return draw(normal_shader());
    if (mode == "local") return draw(local_shader(albedo));
    const Shader shader = baked_shader(volume, *light, options, settings.outer, session.run);
    Image global = draw(exposed(shader, options.exposure.value_or(0.0)));
    return mode == "both" ? side_by_side(draw(local_shader(albedo)), global, kGap, Vec3f(1.0f)) : global;
  });
  session.timed("write", [&] {
    write_atomically_by_name(options.output, [&](const std::string& path) { write_png(image, path); });
  });
  session.report["settings"] = picture_settings(options, settings, mode);
}

void add_framing_options(CLI::App& command, RenderOptions& options) {
  command.add_option("--up", options.up, "the direction of the world that is up (default 0,0,1)")->type_name("X,Y,Z");
  command
      .add_option("--projection", options.projection,
                  "perspective (default), or orthographic: lengths across the view keep their ratio")
      ->check(CLI::IsMember({"perspective", "orthographic"}));
  command
      .add_option("--frame", options.frame, "what fills the picture: the volume's box (default), or the surface alone")
      ->check(CLI::IsMember({"box", "surface"}));
  command.add_option("--zoom", options.zoom, "enlarges the picture about its middle (default 1)")
      ->check(above_zero())
      ->type_name("FACTOR");
  command
      .add_option("--background", options.background,
                  "transparent, or a colour as screens show it, each from 0 to 255 (default 124,124,124)")
      ->type_name("R,G,B");
}

}  // namespace

void add_render_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("render", "A picture of one isosurface; needs no display and no GPU");
  const auto options = std::make_shared<RenderOptions>();
  options->volume.add_to(command, session);
  options->iso.add_to(command);
  session.writes(
      command.add_option("-o,--output", options->output, "the picture to write")->required()->type_name("IMAGE.png"));
  options->light.add_to(command, session);
  options->side.add_to(command,
                       "show this side alone and look through the other (default: both, each in its own light where "
                       "the light has it)");
  command.add_option("--size", options->size, "pixels (default 800x600)")->type_name("WxH");
  command
      .add_option("--view", options->view,
                  "from where, in degrees (default 30,20): azimuth 0 looks along +y, 90 along -x; elevation 90 "
                  "looks down")
      ->type_name("AZIMUTH,ELEVATION");
  command.add_option("--eye", options->eye, "look from this place of the world, in the direction of --view")
      ->type_name("X,Y,Z");
  add_framing_options(command, *options);
  command
      .add_option("--mode", options->mode,
                  "global: the baked light (default with --light); local: a headlight; both: side by side; "
                  "normal: normals as colours")
      ->check(CLI::IsMember({"global", "local", "both", "normal"}));
  command.add_option("--samples", options->samples, "rays a pixel, squared (default 3)")
      ->transform(whole_number(1, 16))
      ->type_name("N");
  command.add_option("--exposure", options->exposure, "stops by which the global light is made brighter")
      ->check(finite_number())
      ->type_name("STOPS");
  options->outer.add_to(command, "the side that is outside: lower or higher values (default: what the light says)");
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_render(*options, session); }); });
}

}  // namespace isolux
