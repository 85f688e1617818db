#pragma once

#include <isolux/mc_extract/iso_mesh.h>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace isolux {

/// Figures of a mesh, world units.
struct MeshMeasures {
  double area = 0.0;
  /// Enclosed volume, positive where faces look away from it; nothing where boundary_edges is not 0.
  std::optional<double> volume{};
  /// Vertices - edges + faces: 2 for each closed component without holes, less 2 for each handle.
  std::int64_t euler_number = 0;
  std::size_t components = 0;
  std::size_t boundary_edges = 0;
  std::size_t zero_area_triangles = 0;
};

/// One pass over the faces, in double precision.
[[nodiscard]] MeshMeasures measure_mesh(const IsoMesh& mesh);

}  // namespace isolux
