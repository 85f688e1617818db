#include <isolux/bake/light_metadata.h>
#include <isolux/mc_extract/iso_extractor.h>
#include <isolux/render/render.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bake_options.h"
#include "commands.h"
#include "parse.h"
#include "render_options.h"
#include "surfaces.h"

namespace isolux {
namespace {

/// Tangent of half the angle of view from within a volume: 60 degrees.
constexpr double kHalfHeightFromWithin = 0.577;

/// The surface brighter by so many stops; what is seen beside it stays.
Shader exposed(Shader shader, double stops) {
  return [shader = std::move(shader), factor = float(std::exp2(stops))](const SurfacePoint& point) {
    return factor * shader(point);
  };
}

/// Baked light for pictures of any isovalue, made ready to be read once. A light of both sides shows each where it is,
/// whatever --outer says; one that does not have the side that is shown is refused.
class BakedLight {
 public:
  BakedLight(const Volume& volume, const LightFile& light, const RenderOptions& options, OuterSide outer,
             const Run& run)
      : light_(light) {
    const auto of_side = [&](LevelSetSide side) {
      return std::make_shared<const LightReader>(volume, options.light.of_side(light, side), TexelStorage::kBricks,
                                                 run);
    };
    if (options.side.given()) {
      const OuterSide shown = options.side.or_outer() == LevelSetSide::kInner ? opposite(outer) : outer;
      outer_ = inner_ = of_side(side_towards(light, shown));
    } else if (!light.inner) {
      outer_ = of_side(side_towards(light, outer));
    } else {
      outer_ = of_side(LevelSetSide::kOuter);
      inner_ = of_side(LevelSetSide::kInner);
      if (outer != light_outer(light)) std::swap(outer_, inner_);
    }
  }

  [[nodiscard]] Shader shader(float isovalue) const {
    const auto light_at = [isovalue](const std::shared_ptr<const LightReader>& reader) -> LightAt {
      return [reader, isovalue](const SurfacePoint& point) { return reader->at_index(point.index, double(isovalue)); };
    };
    const SurfaceColour colour = surface_colour(light_, isovalue);
    return inner_ ? global_shader(light_at(outer_), light_at(inner_), colour) : global_shader(light_at(outer_), colour);
  }

 private:
  const LightFile& light_;
  std::shared_ptr<const LightReader> outer_;
  std::shared_ptr<const LightReader> inner_;  ///< none: it has no light of its own
};

/// At all of the surfaces, where --frame asks for them and there is one, or at the middle of the box.
Camera outer_camera(const RenderOptions& options, const std::vector<float>& isovalues, const Volume& volume,
                    double aspect, const Session& session) {
  if (options.frame == "surface") {
    Framing framing(options.looking(), aspect);
    IsoExtractor extractor(volume, session.run,
                           isovalues.size() > 1 ? IsoExtractor::Index::kBricks : IsoExtractor::Index::kNone);
    IndexedMesh mesh;
    for (const float isovalue : isovalues) {
      extractor.extract({.isovalue = isovalue}, session.run, mesh);
      framing.add(mesh.positions);
    }
    if (!framing.empty()) return framing.camera();
  }
  return orbit_camera(volume.lattice(), options.looking(), aspect);
}

/// From outside, or out of --eye.
Camera camera_of(const RenderOptions& options, const std::vector<float>& isovalues, const Volume& volume, double aspect,
                 const Session& session) {
  Camera camera;
  if (options.eye.empty()) {
    camera = outer_camera(options, isovalues, volume, aspect, session);
  } else {
    camera = orbit_camera(volume.lattice(), options.looking(), aspect);
    const auto eye = parse_numbers("--eye", options.eye, 3);
    camera.eye = {eye[0], eye[1], eye[2]};
    camera.half_height = kHalfHeightFromWithin;
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

void draw(const Volume& volume, const std::optional<LightFile>& light, const RenderOptions& options, Session& session) {
  const std::vector<float> isovalues = options.iso.in(volume);
  const std::vector<std::string> outputs = output_names(options.output, options.iso);
  const std::string mode = options.shown_mode();
  const bool is_global = mode == "global" || mode == "both";
  for (const float isovalue : isovalues) {
    warn_outside_range(volume, isovalue, session);
    if (light && is_global) warn_outside_light(*light, isovalue, session);
  }
  const auto [width, height] = parse_size2("--size", options.size);
  RenderSettings settings{.width = width, .height = height, .supersampling = options.samples};
  settings.outer = options.outer.or_else(light ? light_outer(*light) : OuterSide::kLower);
  settings.only = options.side.given();
  settings.background = options.background_colour();
  const double aspect = double(settings.width) / settings.height;
  const Camera camera = session.timed("frame", [&] { return camera_of(options, isovalues, volume, aspect, session); });
  std::optional<BakedLight> baked;
  const Renderer renderer = session.timed("render", [&] {
    if (is_global) baked.emplace(volume, *light, options, settings.outer, session.run);
    return Renderer(volume);
  });

  const double pictures = double(outputs.size()) * (mode == "both" ? 2.0 : 1.0);
  double drawn = 0.0;
  const auto picture = [&](const Shader& shader) {
    return renderer.draw(camera, settings, shader, run_of_picture(session.run, drawn++, pictures));
  };
  for_each_surface(outputs, session, [&](std::size_t number) {
    settings.isovalue = isovalues[number];
    const Image image = session.timed("render", [&]() -> Image {
      if (mode == "normal") return picture(normal_shader());
      const auto local = [&] {
        return picture(local_shader((light ? surface_colour(*light, settings.isovalue) : SurfaceColour{}).albedo));
      };
      if (mode == "local") return local();
      Image global = picture(exposed(baked->shader(settings.isovalue), options.exposure.value_or(0.0)));
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
  options.warn_of_no_effect(session);
  session.report["output"] = options.output;
  const Volume volume = options.volume.read(session);
  std::optional<LightFile> light;
  if (options.light.given()) light = options.light.read(volume, session);
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
