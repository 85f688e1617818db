#pragma once

#include <isolux/mc_extract/iso_mesh.h>

#include <cstddef>

#include "wide_kernels.h"

namespace isolux::mc {

/// The arrays behind an OpenMesh kernel.
struct MeshMemory {
  HalfEdgeArrays connectivity{};
  float* positions = nullptr;
  float* normals = nullptr;
};

/// Gives the mesh this size without emptying it first (OpenMesh then fills only what is new), fresh memory in huge
/// pages, and returns its arrays, which may hold anything. Their layout is OpenMesh 9's; the size of each item is
/// asserted, the order of its parts tested against OpenMesh's own accessors.
[[nodiscard]] MeshMemory resize_mesh(IsoMesh& mesh, std::size_t vertices, std::size_t edges, std::size_t faces);

}  // namespace isolux::mc
