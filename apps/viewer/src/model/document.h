#pragma once

#include <isolux/bake/bake.h>
#include <isolux/bake/light_points.h>
#include <isolux/core/surface_colour.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/volume_io/light_file.h>

#include <memory>
#include <optional>
#include <span>

#include "model/histogram.h"
#include "model/viewed_volume.h"

namespace isolux::viewer {

/// A light and what is known of how it was baked.
struct KnownLight {
  std::shared_ptr<const LightFile> file;  ///< shared with the threads that work on it
  std::optional<Scene> scene;             ///< all of it; nothing where the file tells only parts
};

/// As far as the file tells.
[[nodiscard]] KnownLight known_light(std::shared_ptr<const LightFile> file);

/// What is looked at: a volume and, once there is one, its light.
struct Document {
  std::shared_ptr<const ViewedVolume> volume;  ///< shared likewise
  Histogram histogram;
  std::optional<KnownLight> light;  ///< none at first
};

/// \pre require_usable(volume)
[[nodiscard]] Document make_document(StoredVolume volume);

/// What lights the window where the document has no light, and the side of every surface that is outside: that of the
/// mesh, of drafts, of exact light and of what is saved.
struct Lighted {
  Scene scene;
  OuterSide outer = OuterSide::kLower;
};

/// `wanted`, else that of the light, else that of the scene.
[[nodiscard]] OuterSide outer_side(const Document& document, const Scene& scene, std::optional<OuterSide> wanted);

/// The light of level sets seen from `side`; null if the file has none for it.
[[nodiscard]] const IlluminationGrid* grid_of(const LightFile& light, OuterSide side);
/// What is read on the outer side. \throw InvalidInput if the light is of the other side alone
[[nodiscard]] const IlluminationGrid& shown_grid(const LightFile& light, OuterSide outer);

/// Whether the document has a light of this isovalue.
[[nodiscard]] bool has_light_of(const Document& document, float isovalue);

/// Of this isovalue's surface, as the light's scene has it, without a light as `scene` has it.
[[nodiscard]] SurfaceColour surface_colour_of(const Document& document, const Scene& scene, float isovalue);

/// The largest draft.
struct DraftLimits {
  double texels = 3e5;
  int texels_an_axis = 1 << 16;  ///< of a volume with more there is no near field
};

/// A light that is soon there, with few rays. \throw as bake()
[[nodiscard]] LightFile bake_draft(const Volume& volume, const Scene& scene, const DraftLimits& limits,
                                   const Stages& stages, const Run& run);

/// Texels of a draft: one a cell, fewer by the same factor on each axis where that would be more than `limits.texels`.
[[nodiscard]] Index3 draft_texels(Index3 volume_size, const DraftLimits& limits);

/// Light traced at the vertices of the level set of `isovalue`, with the document's light as control variate if it has
/// one of this isovalue and of the outer side. With a light in its scene and with its bounces, otherwise in that of
/// `lighted` with all. \throw InvalidInput if the light does not tell its whole scene; as light_points()
[[nodiscard]] PointLight trace_surface(const Document& document, const Lighted& lighted, float isovalue,
                                       std::span<const Vec3f> positions, const Stages& stages, const Run& run);

/// Where a saved surface has its colours from.
struct VertexLight {
  enum class Source { kNone, kBaked, kExact };
  Source source = Source::kNone;
  std::span<const Vec3f> positions;  ///< of kExact: the vertices
  std::span<const Vec3f> radiance;   ///< and e there
};

/// Writes the surface as PLY to `path`, with the light at its vertices as colours in sRGB, as it is shown.
/// \throw IoError, InvalidInput
void export_surface(const Document& document, const Scene& scene, const VertexLight& light, const Stages& stages,
                    const BackendChoice& extractor, const ExtractSettings& settings, const Run& run,
                    const std::string& path);

}  // namespace isolux::viewer
