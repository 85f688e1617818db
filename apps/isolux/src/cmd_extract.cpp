#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/light_points.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/measure_mesh.h>
#include <isolux/mc_extract/vertex_resolution.h>
#include <isolux/mc_extract/write_mesh.h>
#include <isolux/render/image.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/atomic_file.h>

#include <memory>

#include "bake_options.h"
#include "commands.h"
#include "light_options.h"
#include "parse.h"
#include "usage.h"
#include "volume_options.h"

namespace isolux {
namespace {

struct ExtractOptions {
  VolumeOptions volume;
  LightOptions light;
  SideOption side;
  TraceOptions trace;
  float isovalue = 0.0f;
  std::string output;
  std::string backend;
  OuterOption outer;
  std::vector<std::string> set;
  bool exact_light = false;
  bool cap = false;
  std::size_t min_component = 0;
  std::string normals = "gradient";
};

std::vector<Vec3f> positions(const IsoMesh& mesh) {
  std::vector<Vec3f> points;
  points.reserve(mesh.n_vertices());
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    points.emplace_back(p[0], p[1], p[2]);
  }
  return points;
}

Rgb8 colour(const Vec3f& radiance) { return {srgb_code(radiance.x), srgb_code(radiance.y), srgb_code(radiance.z)}; }

/// Light traced at the vertices, with a baked one as control variate if there is one.
std::vector<Rgb8> exact_colours(const IsoMesh& mesh, const Volume& volume, const Scene& scene,
                                const std::optional<LightFile>& baked, const ExtractOptions& options,
                                Session& session) {
  const PointLight light = session.timed("trace", [&] {
    const BackendChoice tracer{options.trace.tracer(), {}};
    TraceSettings settings = options.trace.settings();
    if (baked && !options.trace.bounces_given()) settings.bounces = light_bounces(*baked);
    if (!baked) return light_points(volume, scene, positions(mesh), settings, tracer, session.stages, session.run);
    const IlluminationGrid& grid = options.light.of_side(*baked, side_towards(*baked, scene.outer));
    const LightReader reader(volume, grid, TexelStorage::kBricks, session.run);
    return light_points(volume, scene, positions(mesh), settings, tracer, session.stages, session.run, reader);
  });
  session.report["rays"] = light.counters.rays;
  session.report["rmse_estimate"] = light.rmse_estimate;
  const SurfaceColour surface = surface_colour(scene, options.isovalue);
  std::vector<Rgb8> colours;
  for (const Vec3f& e : light.radiance) colours.push_back(colour(surface.shown(e)));
  return colours;
}

std::vector<Rgb8> baked_colours(const IsoMesh& mesh, const Volume& volume, const LightFile& light, OuterSide outer,
                                const ExtractOptions& options, const Run& run) {
  const float isovalue = options.isovalue;
  const IlluminationGrid& grid = options.light.of_side(light, side_towards(light, outer));
  const LightReader reader(volume, grid, TexelStorage::kBricks, run);
  const SurfaceColour surface = surface_colour(light, isovalue);
  std::vector<Rgb8> colours;
  for (const Vec3f& p : positions(mesh)) {
    colours.push_back(colour(surface.shown(reader.at_index(volume.lattice().frame.index(Vec3(p)), double(isovalue)))));
  }
  return colours;
}

NormalKind normal_kind(const std::string& name) {
  if (name == "faces") return NormalKind::kFaces;
  return name == "accurate" ? NormalKind::kAccurate : NormalKind::kGradient;
}

/// What the mesh's normals point to and whose light it shows: the outer side of the light or the scene (`lit`) or the
/// one that the user calls so, or with --side inner the other.
OuterSide facing(const ExtractOptions& options, OuterSide lit) {
  const OuterSide outer = options.outer.or_else(lit);
  return options.side.or_outer() == LevelSetSide::kInner ? opposite(outer) : outer;
}

/// The scene given, else that of the light, where exact light is to agree with it.
Scene scene_for(const ExtractOptions& options, const std::optional<LightFile>& light) {
  if (options.exact_light && light && !options.trace.scene_given()) {
    auto scene = light_scene(*light);
    if (!scene) throw UsageError("--exact-light: the light does not tell its whole scene; give it with --scene");
    return *std::move(scene);
  }
  return options.trace.scene();
}

/// \throw UsageError before any work is done for a mesh that cannot be written.
void require_output(const std::string& path) {
  try {
    require_mesh_extension(path);
  } catch (const InvalidInput& error) {
    throw UsageError(fmt::format("--output: {}", error.what()));
  }
}

/// What a surface is taken from: floats are for its light alone.
struct Subject {
  VolumeView volume;
  const Volume* floats;  ///< null without light
};

nlohmann::json mesh_settings(const ExtractOptions& options, const std::string& backend, OuterSide outer) {
  nlohmann::json result = {{"isovalue", options.isovalue},
                           {"backend", backend},
                           {"normals", options.normals},
                           {"cap", options.cap},
                           {"min_component", options.min_component},
                           {"side", options.side.name()},
                           {"outer", name_of(outer)},
                           {"exact_light", options.exact_light}};
  if (options.light.given()) result["light"] = options.light.path();
  if (options.exact_light) result["rays"] = options.trace.settings().rays;
  return result;
}

void report_mesh(const IsoMesh& mesh, const ExtractOptions& options, const std::string& backend, OuterSide outer,
                 Session& session) {
  const MeshMeasures measures = session.timed("measure", [&] { return measure_mesh(mesh); });
  session.report["area"] = measures.area;
  session.report["volume"] = measures.volume ? nlohmann::json(*measures.volume) : nlohmann::json();
  session.report["euler_number"] = measures.euler_number;
  session.report["components"] = measures.components;
  session.report["boundary_edges"] = measures.boundary_edges;
  session.report["zero_area_triangles"] = measures.zero_area_triangles;
  session.report["triangles"] = mesh.n_faces();
  session.report["vertices"] = mesh.n_vertices();
  session.report["settings"] = mesh_settings(options, backend, outer);
  session.say(fmt::format("{} triangles, {} vertices", mesh.n_faces(), mesh.n_vertices()));
}

/// Meshes are made of floats.
void warn_coarse(const Lattice& lattice, const Session& session) {
  const double places = places_a_voxel(lattice);
  if (places >= kPlacesEnough) return;
  session.warn(
      fmt::format("so far from the world's origin a mesh's float coordinates tell {:.2g} places a voxel apart: small "
                  "triangles may be empty",
                  places));
}

void extract(const Subject& subject, const BackendChoice& choice, const ExtractOptions& options, Session& session) {
  const VolumeView& volume = subject.volume;
  std::optional<LightFile> light;
  if (options.light.given()) light = options.light.read(*subject.floats, session);
  const Scene scene = scene_for(options, light);
  options.light.warn_of_no_effect(session);
  if (!options.exact_light && options.trace.says_how_to_trace())
    session.warn("--bounces, --quality, --rays and --tracer have no effect without --exact-light");
  if (!options.exact_light && light && options.trace.scene_given())
    session.warn("--scene has no effect with --light unless --exact-light is given");

  const OuterSide outer = facing(options, light ? light_outer(*light) : scene.outer);
  const auto extractor = session.stages.extractors.create(choice.name, choice.settings);
  const IsoMesh mesh = session.timed("extract", [&] {
    return extractor->extract(volume,
                              {.isovalue = options.isovalue,
                               .outer = outer,
                               .normals = normal_kind(options.normals),
                               .cap = options.cap ? CapKind::kBox : CapKind::kNone,
                               .min_component = options.min_component},
                              session.run);
  });
  // A cap closes the whole box where all of it is inside.
  if (!options.cap || mesh.n_faces() == 0) warn_outside_range(volume, options.isovalue, session);
  warn_coarse(volume.lattice(), session);
  std::vector<Rgb8> colours;
  if (options.exact_light) {
    Scene traced = scene;
    traced.outer = outer;
    traced.sides = LitSides::kOuter;
    colours = exact_colours(mesh, *subject.floats, traced, light, options, session);
  } else if (light) {
    warn_outside_light(*light, options.isovalue, session);
    colours = session.timed("light",
                            [&] { return baked_colours(mesh, *subject.floats, *light, outer, options, session.run); });
  }
  session.timed("write", [&] {
    write_atomically_by_name(options.output, [&](const std::string& path) { write_mesh(mesh, colours, path); });
  });
  // What is called outside, whichever side is shown.
  const OuterSide outside = options.side.or_outer() == LevelSetSide::kInner ? opposite(outer) : outer;
  report_mesh(mesh, options, session.stages.extractors.info(choice.name).name, outside, session);
}

void run_extract(const ExtractOptions& options, Session& session) {
  require_output(options.output);
  BackendChoice choice{options.backend, {}};
  apply_settings("--set", options.set, {{"extractor", &choice.settings}});
  require_choice(session.stages.extractors, choice);
  require_choice(session.stages.tracers, {options.trace.tracer(), {}});
  const bool lit = options.light.given() || options.exact_light;
  if (options.side.given() && !lit)
    throw UsageError("--side: it chooses whose light; give --light LIGHT.nrrd or --exact-light");
  if (lit) {
    const Volume volume = options.volume.read(session);
    extract({.volume = volume, .floats = &volume}, choice, options, session);
  } else {
    const StoredVolume volume = options.volume.read_stored(session);
    extract({.volume = volume, .floats = nullptr}, choice, options, session);
  }
}

}  // namespace

void add_extract_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("extract", "One isosurface as a mesh, with its light as vertex colours");
  const auto options = std::make_shared<ExtractOptions>();
  options->volume.add_to(command, session);
  add_isovalue(command, options->isovalue);
  session.writes(
      command.add_option("-o,--output", options->output, "the mesh to write: .ply, .glb, .obj, .off or .stl")
          ->required()
          ->type_name("MESH.ply"));
  options->light.add_to(command, session);
  options->side.add_to(
      command, "whose light, and where the normals point: outer (default), or inner, which --light needs to have");
  command.add_flag(
      "--exact-light", options->exact_light,
      "trace the light at the vertices; with --light too, that light's scene is taken and half the rays do");
  options->trace.add_to(command, session);
  options->outer.add_to(command,
                        "the side that is outside: lower or higher values (default: what the light or scene says)");
  command.add_flag("--cap", options->cap, "close the surface where it meets the box");
  command.add_option("--min-component", options->min_component, "leave out connected parts of fewer triangles")
      ->transform(whole_number(0, std::uint64_t(1) << 32))
      ->type_name("N");
  command
      .add_option(
          "--normals", options->normals,
          "from the field's gradient by central differences, as the light has it (gradient, default), by higher "
          "differences where the data are smooth (accurate), or from the faces")
      ->check(CLI::IsMember({"gradient", "accurate", "faces"}));
  command.add_option("--backend", options->backend, "extractor backend")->type_name("NAME");
  command.add_option("--set", options->set, "an option of the extractor")
      ->check(key_and_value())
      ->type_name("key=value");
  session.add_common_options(command);
  command.callback([options, &session] { session.on_run([options, &session] { run_extract(*options, session); }); });
}

}  // namespace isolux
