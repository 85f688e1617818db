#pragma once

#include <isolux/bake/light_points.h>
#include <isolux/core/surface_colour.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/iso_mesh.h>
#include <isolux/mc_extract/write_mesh.h>
#include <isolux/raytrace_flat/scene.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/light_file.h>

#include <cstdint>
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

/// Lights the vertices of one mesh of a volume after the other as the options ask: traced (`scene`) or read from
/// `baked`, and on a cap that of the box's faces, which nothing stands before. What is baked is made ready to be read
/// once. All that it is given must outlive it.
class VertexLighter {
 public:
  /// `scene.outer` is the side that meshes face.
  VertexLighter(const Volume& volume, const Scene& scene, const std::optional<LightFile>& baked,
                const ExtractOptions& options, Session& session)
      : volume_(volume), scene_(scene), baked_(baked), options_(options), session_(session) {}

  /// \throw as light_points()
  [[nodiscard]] VertexLight light(const IsoMesh& mesh, float isovalue);

 private:
  [[nodiscard]] const LightReader& reader();
  [[nodiscard]] const Scene& scene_of_cap();
  [[nodiscard]] std::vector<Vec3f> baked_light(const std::vector<Vec3f>& positions, float isovalue);
  [[nodiscard]] PointLight exact_light(const std::vector<Vec3f>& positions, float isovalue);
  [[nodiscard]] PointLight cap_light(const std::vector<std::uint32_t>& vertices, const std::vector<Vec3f>& positions,
                                     const IsoMesh& mesh);

  const Volume& volume_;
  const Scene& scene_;
  const std::optional<LightFile>& baked_;
  const ExtractOptions& options_;
  Session& session_;
  std::optional<LightReader> reader_;
  std::optional<Scene> scene_of_cap_;
};

/// As a screen shows it, brighter by so many stops. Says how many are brighter than white and what would show them.
[[nodiscard]] std::vector<Rgb8> shown_colours(const VertexLight& light, float isovalue, double exposure,
                                              const Session& session);

/// e itself, `channels` numbers a vertex.
[[nodiscard]] std::vector<float> light_values(const VertexLight& light);

}  // namespace isolux
