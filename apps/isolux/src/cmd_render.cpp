#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/mc_extract/left_out_components.h>
#include <isolux/render/render.h>
#include <isolux/volume_io/atomic_file.h>

#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bake_options.h"
#include "baked_light.h"
#include "commands.h"
#include "parse.h"
#include "render_options.h"
#include "surfaces.h"

namespace isolux {
namespace {

/// Tangent of half the angle of view from within a volume: 60 degrees.
constexpr double kHalfHeightFromWithin = 0.577;

/// At all of the meshes, where --frame asks for that and they are not empty, or at the middle of the box; or out of
/// --eye.
Camera camera_of(const RenderOptions& options, const std::vector<ExtractSettings>& meshes, const Lattice& volume,
                 double aspect, IsoExtractor* extractor, const Run& run) {
  Camera camera = orbit_camera(volume, options.looking(), aspect);
  if (!options.eye.empty()) {
    const auto eye = parse_numbers("--eye", options.eye, 3);
    camera.eye = {eye[0], eye[1], eye[2]};
    camera.half_height = kHalfHeightFromWithin;
  } else if (options.frame == "surface") {
    Framing framing(options.looking(), aspect);
    IndexedMesh mesh;
    for (const ExtractSettings& settings : meshes) {
      extractor->extract(settings, run, mesh);
      framing.add(mesh.positions);
    }
    if (!framing.empty()) camera = framing.camera();
  }
  camera.half_height /= options.zoom;
  return camera;
}

/// The run of one picture of several, whose progress is told as that of all.
Run run_of_picture(const Run& all, double number, double count) {
  Run run = all;
  if (all.progress)
    run.progress = [&tell = all.progress, number, count](std::string_view stage, double fraction) {
      tell(stage, (number + fraction) / count);
    };
  return run;
}

RenderSettings picture_settings(const RenderOptions& options, OuterSide outer) {
  const auto [width, height] = parse_size2("--size", options.size);
  RenderSettings settings{.width = width, .height = height, .supersampling = options.samples, .outer = outer};
  settings.only = options.side.given();
  settings.background = options.background_colour();
  settings.cap = options.parts.cap;
  return settings;
}

/// Of each isovalue the mesh that `extract` makes of what is shown.
std::vector<ExtractSettings> meshes_of(const RenderOptions& options, const std::vector<float>& isovalues,
                                       OuterSide outer) {
  const bool is_inner = options.side.or_outer() == LevelSetSide::kInner;
  std::vector<ExtractSettings> meshes;
  for (const float isovalue : isovalues)
    meshes.push_back(options.parts.settings(isovalue, is_inner ? opposite(outer) : outer));
  return meshes;
}

void draw(const Volume& volume, const std::optional<LightFile>& light, const RenderOptions& options, Session& session) {
  const std::vector<float> isovalues = options.iso.in(volume);
  const std::vector<std::string> outputs = output_names(options.output, options.iso);
  const std::string mode = options.shown_mode();
  const bool is_global = mode == "global" || mode == "both";
  RenderSettings settings =
      picture_settings(options, options.outer.or_else(light ? light_outer(*light) : OuterSide::kLower));
  const std::vector<ExtractSettings> meshes = meshes_of(options, isovalues, settings.outer);
  const std::vector<float> there = isovalues_of_surfaces(volume, meshes, session);
  if (light && is_global) warn_outside_light(*light, there, session);
  std::optional<IsoExtractor> extractor;
  if (options.needs_meshes())
    session.timed("extract", [&] {
      const bool are_many = outputs.size() > 1;
      extractor.emplace(volume, session.run, are_many ? IsoExtractor::Index::kBricks : IsoExtractor::Index::kNone);
    });
  const Camera camera = session.timed("frame", [&] {
    const double aspect = double(settings.width) / settings.height;
    return camera_of(options, meshes, volume.lattice(), aspect, extractor ? &*extractor : nullptr, session.run);
  });
  std::optional<BakedLight> baked;
  if (is_global) baked.emplace(volume, *light, options, settings.outer, session);
  const Renderer renderer = session.timed("render", [&] { return Renderer(volume); });

  const double pictures = double(outputs.size()) * (mode == "both" ? 2.0 : 1.0);
  double drawn = 0.0;
  const auto picture = [&](const Shader& shader) {
    return renderer.draw(camera, settings, shader, run_of_picture(session.run, drawn++, pictures));
  };
  for_each_surface(outputs, session, [&](std::size_t number) {
    settings.isovalue = isovalues[number];
    std::optional<LeftOutComponents> left_out;
    if (options.parts.min_component > 0) {
      session.timed("extract", [&] { left_out.emplace(*extractor, volume.lattice(), meshes[number], session.run); });
      if (left_out->leaves_nothing())
        session.warn(fmt::format("isovalue {}: no connected part has {} triangles, so nothing is shown",
                                 settings.isovalue, options.parts.min_component));
      settings.left_out = [&left_out](const Vec3& index) { return left_out->contain(index); };
    }
    const Image image = session.timed("render", [&]() -> Image {
      if (mode == "normal") return picture(normal_shader());
      const auto local = [&] {
        return picture(local_shader((light ? surface_colour(*light, settings.isovalue) : SurfaceColour{}).albedo));
      };
      if (mode == "local") return local();
      Image global = picture(baked->shader(settings.isovalue));
      return mode == "both" ? side_by_side(local(), global, kGap, Vec3f(1.0f)) : global;
    });
    session.timed("write", [&] {
      write_atomically_by_name(outputs[number], [&](const std::string& path) { write_png(image, path); });
    });
    session.report["settings"] = options.settings(settings.isovalue, settings.outer);
  });
}

void run_render(const RenderOptions& options, Session& session) {
  if (options.looking().projection == Projection::kOrthographic && !options.eye.empty())
    throw UsageError("--projection orthographic: --eye looks in perspective; give one of them");
  if (!options.eye.empty()) static_cast<void>(parse_numbers("--eye", options.eye, 3));
  options.require_pictures();
  session.report["output"] = options.output;
  const Volume volume = options.volume.read(session);
  std::optional<LightFile> light;
  if (options.light.given()) light = options.light.read(volume, session);
  options.warn_of_no_effect(light, session);
  draw(volume, light, options, session);
}

}  // namespace

void add_render_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("render", "A picture of one isosurface; needs no display and no GPU");
  const auto options = std::make_shared<RenderOptions>();
  options->add_to(command, session);
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_render(*options, session); }); });
}

}  // namespace isolux
