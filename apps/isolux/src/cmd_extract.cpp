#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/measure_mesh.h>
#include <isolux/mc_extract/vertex_resolution.h>
#include <isolux/mc_extract/write_mesh.h>
#include <isolux/volume_io/atomic_file.h>

#include <filesystem>
#include <memory>

#include "commands.h"
#include "extract_options.h"
#include "mesh_maker.h"
#include "parse.h"
#include "surfaces.h"
#include "usage.h"
#include "vertex_light.h"

namespace isolux {
namespace {

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

nlohmann::json mesh_settings(const ExtractOptions& options, float isovalue, const std::string& backend,
                             OuterSide outer) {
  nlohmann::json result = {{"isovalue", isovalue},
                           {"backend", backend},
                           {"normals", options.normals},
                           {"cap", options.parts.cap},
                           {"min_component", options.parts.min_component},
                           {"side", options.side.name()},
                           {"outer", name_of(outer)},
                           {"exact_light", options.exact_light}};
  if (options.light.given()) result["light"] = options.light.path();
  if (options.exact_light) result["rays"] = options.trace.settings().rays;
  if (options.exposure) result["exposure"] = *options.exposure;
  return result;
}

/// `whose` stands before what is said of it.
void report_mesh(const IsoMesh& mesh, const std::string& whose, Session& session) {
  const MeshMeasures measures = session.timed("measure", [&] { return measure_mesh(mesh); });
  session.report["area"] = measures.area;
  session.report["volume"] = measures.volume ? nlohmann::json(*measures.volume) : nlohmann::json();
  session.report["euler_number"] = measures.euler_number;
  session.report["components"] = measures.components;
  session.report["boundary_edges"] = measures.boundary_edges;
  session.report["zero_area_triangles"] = measures.zero_area_triangles;
  session.report["triangles"] = mesh.n_faces();
  session.report["vertices"] = mesh.n_vertices();
  session.say(fmt::format("{}{} triangles, {} vertices", whose, mesh.n_faces(), mesh.n_vertices()));
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

/// Words that change nothing.
void warn_of_no_effect(const ExtractOptions& options, const std::optional<LightFile>& light, const Scene& scene,
                       const Session& session) {
  options.light.warn_of_no_effect(session);
  const bool is_shown = options.is_lit() && holds_colours(options.output);
  if (options.is_lit() && !is_shown)
    session.warn(fmt::format("{}: {} files have no colours: {} has no effect but for the side that is outside",
                             options.output, std::filesystem::path(options.output).extension().string(),
                             options.light.given() ? "--light" : "--exact-light"));
  if (!options.exact_light && !(light && options.parts.cap) && options.trace.says_how_to_trace())
    session.warn("--bounces, --quality, --rays and --tracer have no effect without --exact-light");
  const bool is_of_cap = light && options.parts.cap && !light_scene(*light);
  if (light && !options.exact_light && options.trace.scene_given() && !is_of_cap)
    session.warn("--scene has no effect with --light unless --exact-light is given");
  if (!options.is_lit() && options.trace.scene_given() && scene.outer == Scene{}.outer)
    session.warn("--scene has no effect without --exact-light, but for its outer side");
  if (options.exposure && !is_shown) session.warn("--exposure has no effect without colours");
  if (options.light_values && !(is_shown && holds_light(options.output)))
    session.warn("--light-values has no effect without light, or in other files than .ply");
}

/// What the file says of where it comes from.
MeshExtras notes_of(const VolumeView& volume, const VertexLight& light, float isovalue, const ExtractOptions& options) {
  MeshExtras extras;
  const std::string source = std::filesystem::path(volume.name()).filename().string();
  extras.name = fmt::format("{} at {}", source, isovalue);
  extras.notes = {{"volume", source}, {"isovalue", fmt::format("{}", isovalue)}};
  // As 3D Slicer has it; other spaces have no short name.
  if (volume.space() == "left-posterior-superior") extras.notes.emplace_back("SPACE", "LPS");
  if (light.e.empty()) return extras;
  const Vec3f& albedo = light.surface.albedo;
  extras.notes.emplace_back("albedo", fmt::format("{} {} {}", albedo.x, albedo.y, albedo.z));
  extras.notes.emplace_back("exposure", fmt::format("{}", options.exposure.value_or(0.0)));
  return extras;
}

void write_lit_mesh(const IsoMesh& mesh, const VertexLight& light, const VolumeView& volume, float isovalue,
                    const std::string& output, const ExtractOptions& options, Session& session) {
  const std::vector<Rgb8> colours = shown_colours(light, isovalue, options.exposure.value_or(0.0), session);
  MeshExtras extras = notes_of(volume, light, isovalue, options);
  std::vector<float> values;
  if (options.light_values && holds_light(output)) values = light_values(light);
  extras.light = values;
  extras.light_channels = light.channels;
  session.timed("write", [&] {
    write_atomically_by_name(output, [&](const std::string& path) { write_mesh(mesh, colours, path, extras); });
  });
}

void extract(const Subject& subject, const BackendChoice& choice, const ExtractOptions& options, Session& session) {
  const VolumeView& volume = subject.volume;
  const std::vector<float> isovalues = options.iso.in(volume);
  const std::vector<std::string> outputs = output_names(options.output, options.iso);
  std::optional<LightFile> light;
  if (options.light.given()) light = options.light.read(*subject.floats, session);
  Scene scene = scene_for(options, light);
  warn_of_no_effect(options, light, scene, session);
  warn_coarse(volume.lattice(), session);

  const OuterSide outer = facing(options, light ? light_outer(*light) : scene.outer);
  scene.outer = outer;
  scene.sides = LitSides::kOuter;
  // What is called outside, whichever side is shown.
  const OuterSide outside = options.side.or_outer() == LevelSetSide::kInner ? opposite(outer) : outer;
  std::vector<ExtractSettings> surfaces;
  for (const float isovalue : isovalues) {
    surfaces.push_back(options.parts.settings(isovalue, outer));
    surfaces.back().normals = normal_kind(options.normals);
  }
  const std::vector<float> there = isovalues_of_surfaces(volume, surfaces, session);
  std::optional<VertexLighter> lighter;
  if (options.is_lit() && holds_colours(options.output))
    lighter.emplace(*subject.floats, scene, light, options, session);
  if (lighter && light)
    warn_outside_light(*light, there, session,
                       options.exact_light ? "it is no help to --exact-light" : "what is shown is not its light");
  MeshMaker maker = session.timed("extract", [&] { return MeshMaker(volume, choice, outputs.size(), session); });
  for_each_surface(outputs, session, [&](std::size_t number) {
    const float isovalue = isovalues[number];
    const auto extracted = [&]() -> const IsoMesh& { return maker.extract(surfaces[number]); };
    const IsoMesh& mesh = session.timed("extract", extracted);
    const VertexLight shown = lighter ? lighter->light(mesh, isovalue) : VertexLight();
    write_lit_mesh(mesh, shown, volume, isovalue, outputs[number], options, session);
    report_mesh(mesh, outputs.size() > 1 ? outputs[number] + ": " : "", session);
    session.report["settings"] =
        mesh_settings(options, isovalue, session.stages.extractors.info(choice.name).name, outside);
  });
}

void run_extract(const ExtractOptions& options, Session& session) {
  for (const std::string& output : output_names(options.output, options.iso)) require_output(output);
  session.report["output"] = options.output;
  BackendChoice choice{options.backend, {}};
  apply_settings("--set", options.set, {{"extractor", &choice.settings}});
  require_choice(session.stages.extractors, choice);
  require_choice(session.stages.tracers, {options.trace.tracer(), {}});
  if (options.side.given() && !options.is_lit())
    throw UsageError("--side: it chooses whose light; give --light LIGHT.nrrd or --exact-light");
  if (options.is_lit()) {
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
  options->iso.add_to(command);
  command
      .add_option("-o,--output", options->output,
                  "the mesh to write: .ply, .glb, .obj, .off or .stl; of several isovalues with {iso} or %03d in it")
      ->required()
      ->type_name("MESH.ply");
  session.writes(outputs_of(options->output, options->iso));
  options->light.add_to(command, session);
  options->side.add_to(
      command, "whose light, and where the normals point: outer (default), or inner, which --light needs to have");
  command.add_flag("--exact-light", options->exact_light,
                   "trace the light at the vertices; with --light too, that light's scene is taken and, where they are "
                   "few, half the rays do");
  options->trace.add_to(command, session, "a vertex", "those of --light, else ");
  options->outer.add_to(command,
                        "the side that is outside: lower or higher values (default: what the light or scene says)");
  command.add_option("--exposure", options->exposure, "stops by which the colours are made brighter")
      ->check(finite_number())
      ->type_name("STOPS");
  command.add_flag("--light-values", options->light_values,
                   "the light itself, e, as float properties of a .ply file: quality, or e_r, e_g and e_b");
  options->parts.add_to(command);
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
