#pragma once

#include <isolux/bake/bake.h>
#include <isolux/bake/light_points.h>
#include <isolux/core/surface_colour.h>
#include <isolux/volume_io/light_file.h>

#include <memory>
#include <optional>
#include <span>

#include "model/histogram.h"
#include "model/viewed_volume.h"

namespace isolux::viewer {

/// What is looked at: a volume and, once there is one, its light.
struct Document {
  std::shared_ptr<const ViewedVolume> volume;  ///< shared with the threads that work on it
  Histogram histogram;
  std::shared_ptr<const LightFile> light;  ///< none at first; shared likewise
};

/// \pre require_usable(volume)
[[nodiscard]] Document make_document(StoredVolume volume);

/// Of this isovalue's surface, as the light's scene has it; without a light that of the scene by default.
[[nodiscard]] SurfaceColour surface_colour_of(const Document& document, float isovalue);

/// A light that is soon there: few rays, and at most 300,000 texels. \throw as bake()
[[nodiscard]] LightFile bake_draft(const Volume& volume, const Scene& scene, const Stages& stages, const Run& run);

/// Texels of a draft: one a cell, fewer by the same factor on each axis where that would be more than `most`.
[[nodiscard]] Index3 draft_texels(Index3 volume_size, double most);

/// Light traced at the vertices of the level set of `isovalue`, with the document's light as control variate if it has
/// one; then in its scene and with its bounces, otherwise in `scene` with all. \throw InvalidInput if the light does
/// not tell its whole scene; as light_points()
[[nodiscard]] PointLight trace_surface(const Document& document, const Scene& scene, std::span<const Vec3f> positions,
                                       const Stages& stages, const Run& run);

/// Writes the surface as PLY with the light at its vertices as colours, in sRGB as it is shown; without colours if
/// there is no light. \throw IoError, InvalidInput
void export_surface(const Document& document, const Stages& stages, const BackendChoice& extractor,
                    const ExtractSettings& settings, const Run& run, const std::string& path);

/// "STEM-ISOVALUE.EXTENSION" in the current folder, or STEM-ISOVALUE-2, -3, ... where that exists.
[[nodiscard]] std::string free_file_name(const std::string& volume_name, double isovalue, const std::string& extension);

}  // namespace isolux::viewer
