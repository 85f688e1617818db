#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/render/render.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <cmath>
#include <memory>
#include <optional>

#include "bake_options.h"
#include "commands.h"
#include "light_options.h"
#include "parse.h"
#include "volume_options.h"

namespace isolux {
namespace {

struct Options {
  VolumeOptions volume;
  LightOptions light;
  float isovalue = 0.0f;
  std::string output;
  std::string size = "800x600";
  std::string view = "30,20";
  std::string mode;
  int samples = 3;
  double exposure = 0.0;
  std::string outer;
};

void expose(Image& image, double stops) {
  const float factor = float(std::exp2(stops));
  for (Vec3f& p : image.pixels) p *= factor;
}

void run_render(const Options& options, Session& session) {
  const auto [width, height] = parse_size2("--size", options.size);
  const auto view = parse_numbers("--view", options.view, 2);
  const std::string mode = !options.mode.empty() ? options.mode : options.light.given() ? "global" : "local";
  if ((mode == "global" || mode == "both") && !options.light.given()) {
    throw UsageError("--mode " + mode + ": it shows a light; give --light LIGHT.nrrd");
  }
  const Volume volume = options.volume.read(session);
  std::optional<LightFile> light;
  if (options.light.given()) light = options.light.read(volume, session);
  warn_outside_range(volume, options.isovalue, session);

  const Vec3f albedo = light ? light_albedo(*light, options.isovalue) : Vec3f(0.8f);
  RenderSettings settings{
      .width = width, .height = height, .supersampling = options.samples, .isovalue = options.isovalue};
  settings.outer = light ? light_outer(*light) : OuterSide::kLower;
  if (!options.outer.empty()) settings.outer = options.outer == "higher" ? OuterSide::kHigher : OuterSide::kLower;
  const Camera camera = orbit_camera(volume.lattice(), view[0], view[1], double(width) / height);
  const auto draw = [&](const Shader& shader) { return render(volume, camera, settings, shader, session.run); };
  Image image = session.timed("render", [&]() -> Image {
    if (mode == "normal") return draw(normal_shader());
    if (mode == "local") return draw(local_shader(albedo));
    const LightReader reader(volume, light->grid, TexelStorage::kBricks);
    const LightAt at = [&](const SurfacePoint& point) {
      return reader.at_index(point.index, double(options.isovalue));
    };
    Image global = draw(global_shader(at, albedo));
    expose(global, options.exposure);
    return mode == "both" ? side_by_side(draw(local_shader(albedo)), global, 4, Vec3f(1.0f)) : global;
  });
  session.timed("write", [&] {
    write_atomically_by_name(options.output, [&](const std::string& path) { write_png(image, path); });
  });
  session.report["settings"] = {
      {"isovalue", options.isovalue}, {"size", {width, height}}, {"view", view}, {"mode", mode}};
}

}  // namespace

void add_render_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("render", "A picture of one isosurface; needs no display and no GPU");
  const auto options = std::make_shared<Options>();
  options->volume.add_to(command);
  command.add_option("--iso", options->isovalue, "isovalue")->required()->type_name("H");
  command.add_option("-o,--output", options->output, "the picture to write")->required()->type_name("IMAGE.png");
  options->light.add_to(command);
  command.add_option("--size", options->size, "pixels (default 800x600)")->type_name("WxH");
  command
      .add_option("--view", options->view,
                  "from where, in degrees (default 30,20): azimuth 0 looks along +y, 90 along -x; elevation 90 "
                  "looks down")
      ->type_name("AZIMUTH,ELEVATION");
  command
      .add_option("--mode", options->mode,
                  "global: the baked light (default with --light); local: a headlight; both: side by side; "
                  "normal: normals as colours")
      ->check(CLI::IsMember({"global", "local", "both", "normal"}));
  command.add_option("--samples", options->samples, "rays a pixel, squared (default 3)")
      ->check(CLI::Range(1, 16))
      ->type_name("N");
  command.add_option("--exposure", options->exposure, "stops by which the global light is made brighter")
      ->type_name("STOPS");
  command
      .add_option("--outer", options->outer,
                  "the side that is outside: lower or higher values (default: what the light says)")
      ->check(CLI::IsMember({"lower", "higher"}));
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_render(*options, session); }); });
}

}  // namespace isolux
