#include "render_options.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>

#include <cctype>
#include <cmath>
#include <filesystem>

#include "parse.h"
#include "surfaces.h"
#include "usage.h"

namespace isolux {
namespace {

/// Without an extension it may be a pipe. \throw UsageError
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

void RenderOptions::add_to(CLI::App& command, Session& session) {
  volume.add_to(command, session);
  iso.add_to(command);
  command.add_option("-o,--output", output, "the picture to write; of several isovalues with {iso} or %03d in it")
      ->required()
      ->type_name("IMAGE.png");
  session.writes(outputs_of(output, iso));
  light.add_to(command, session);
  side.add_to(command,
              "show this side alone and look through the other (default: both, each in its own light where "
              "the light has it)");
  command.add_option("--size", size, "pixels (default 800x600)")->type_name("WxH");
  command
      .add_option("--view", view,
                  "from where, in degrees (default 30,20): azimuth 0 looks along +y, 90 along -x; elevation 90 "
                  "looks down")
      ->type_name("AZIMUTH,ELEVATION");
  command.add_option("--eye", eye, "look from this place of the world, in the direction of --view")->type_name("X,Y,Z");
  add_framing_options(command, *this);
  command
      .add_option("--mode", mode,
                  "global: the baked light (default with --light); local: a headlight; both: side by side; "
                  "normal: normals as colours")
      ->check(CLI::IsMember({"global", "local", "both", "normal"}));
  command.add_option("--samples", samples, "rays a pixel, squared (default 3)")
      ->transform(whole_number(1, 16))
      ->type_name("N");
  command.add_option("--exposure", exposure, "stops by which the global light is made brighter")
      ->check(finite_number())
      ->type_name("STOPS");
  outer.add_to(command, "the side that is outside: lower or higher values (default: what the light says)");
  parts.add_to(command);
  trace.add_scene_to(command, session,
                     "what lights a cap, where the light does not tell all of its scene (default: uniform white sky)");
}

View RenderOptions::looking() const {
  const auto turn = parse_numbers("--view", view, 2);
  const auto skywards = parse_numbers("--up", up, 3);
  if (skywards[0] == 0.0 && skywards[1] == 0.0 && skywards[2] == 0.0)
    throw UsageError(fmt::format("--up = '{}': allowed is a direction, such as 0,1,0", up));
  return {.azimuth_deg = turn[0],
          .elevation_deg = turn[1],
          .up = {skywards[0], skywards[1], skywards[2]},
          .projection = projection == "orthographic" ? Projection::kOrthographic : Projection::kPerspective};
}

std::optional<Vec3f> RenderOptions::background_colour() const {
  if (background.empty()) return RenderSettings{}.background;
  if (background == "transparent") return std::nullopt;
  const std::string wrong =
      fmt::format("--background = '{}': allowed are transparent, or R,G,B from 0 to 255", background);
  Vec3f colour(0.0f);
  try {
    const auto codes = parse_numbers("--background", background, 3);
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

std::string RenderOptions::shown_mode() const {
  if (mode.empty()) return light.given() ? "global" : "local";
  if ((mode == "global" || mode == "both") && !light.given())
    throw UsageError("--mode " + mode + ": it shows a light; give --light LIGHT.nrrd");
  return mode;
}

void RenderOptions::require_pictures() const {
  const auto [width, height] = parse_size2("--size", size);
  const int channels = background_colour() ? 3 : 4;
  for (const std::string& name : output_names(output, iso)) {
    require_png(name, width, height, channels);
    if (shown_mode() == "both") require_png(name, 2 * width + kGap, height, channels);
  }
}

void RenderOptions::warn_of_no_effect(const std::optional<LightFile>& baked, const Session& session) const {
  const std::string shown = shown_mode();
  light.warn_of_no_effect(session);
  if (exposure && shown != "global" && shown != "both")
    session.warn(fmt::format("--exposure has no effect with --mode {}: it is of global light", shown));
  if (!eye.empty() && frame != "box") session.warn("--frame has no effect with --eye");
  const bool shows_light_of_cap = parts.cap && (shown == "global" || shown == "both");
  if (trace.scene_given() && !shows_light_of_cap)
    session.warn("--scene has no effect but on a cap in global light: with --cap and --light");
  else if (trace.scene_given() && baked && light_scene(*baked))
    session.warn("--scene has no effect: the cap is in the light's own scene, which its file tells");
  if (shown == "normal" && light.given() && !side.given()) session.warn("--light has no effect with --mode normal");
}

nlohmann::json RenderOptions::settings(float isovalue, OuterSide outside) const {
  const auto [width, height] = parse_size2("--size", size);
  nlohmann::json result = {{"isovalue", isovalue},
                           {"size", {width, height}},
                           {"view", parse_numbers("--view", view, 2)},
                           {"mode", shown_mode()},
                           {"samples", samples},
                           {"outer", name_of(outside)},
                           {"exposure", exposure.value_or(0.0)}};
  if (!eye.empty()) result["eye"] = parse_numbers("--eye", eye, 3);
  const RenderOptions usual;
  if (up != usual.up) result["up"] = parse_numbers("--up", up, 3);
  if (projection != usual.projection) result["projection"] = projection;
  if (frame != usual.frame) result["frame"] = frame;
  if (zoom != usual.zoom) result["zoom"] = zoom;
  if (background != usual.background) result["background"] = background;
  if (parts.cap) result["cap"] = true;
  if (parts.min_component > 0) result["min_component"] = parts.min_component;
  if (light.given()) result["light"] = light.path();
  if (side.given()) result["side"] = side.name();
  return result;
}

}  // namespace isolux
