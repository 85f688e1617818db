#pragma once

#include <isolux/core/surface_colour.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/iso_mesh.h>
#include <isolux/mc_extract/write_mesh.h>
#include <isolux/raytrace_flat/scene.h>
#include <isolux/volume_io/light_file.h>

#include <optional>
#include <vector>

#include "extract_options.h"

namespace isolux {

/// The light of a mesh's vertices.
struct VertexLight {
  std::vector<Vec3f> e;  ///< irradiance/pi, one a vertex; empty without light
  int channels = 1;      ///< 1: the three are the same
  SurfaceColour surface;
};

/// What the options ask for: traced (`scene`) or read from `baked`, and on a cap that of the box's faces, which nothing
/// stands before. `outer` is the side that the mesh faces. \throw as light_points()
[[nodiscard]] VertexLight vertex_light(const IsoMesh& mesh, const Volume& volume, const Scene& scene,
                                       const std::optional<LightFile>& baked, OuterSide outer,
                                       const ExtractOptions& options, Session& session);

/// As a screen shows it, brighter by so many stops. Says how many are brighter than white and what would show them.
[[nodiscard]] std::vector<Rgb8> shown_colours(const VertexLight& light, double exposure, const Session& session);

/// e itself, `channels` numbers a vertex.
[[nodiscard]] std::vector<float> light_values(const VertexLight& light);

}  // namespace isolux
