#pragma once

#include <isolux/mc_extract/iso_mesh.h>

#include <cstddef>

#include "march_state.h"
#include "wide_kernels.h"

namespace isolux::mc {

/// The arrays behind an OpenMesh kernel.
struct MeshMemory {
  HalfEdgeArrays connectivity{};
  float* positions = nullptr;
  float* normals = nullptr;
};

/// The vertices that a mesh holds already, to be written over; none where it is empty.
[[nodiscard]] VertexRoom vertex_room(IsoMesh& mesh);

/// Reserves memory for as much, fresh memory in huge pages, and gives the arrays, which may hold anything; of what the
/// mesh held no more is kept than that. Their layout is OpenMesh 9's; the size of each item is asserted, the order of
/// its parts tested against OpenMesh's own accessors.
[[nodiscard]] MeshMemory reserve_mesh(IsoMesh& mesh, const MeshSize& size);

/// Touches the huge pages that begin in the memory reserved for what comes after `before`, up to `after`: whoever does
/// so waits until the system has cleared them, so several threads had better share in it.
void bring_huge_pages(const MeshMemory& memory, const MeshSize& before, const MeshSize& after);

/// Lets the mesh hold as much as this at least, up to what is reserved: OpenMesh clears what comes. Best done little by
/// little, each just before it is written, while it is in the cache; others may write what there was meanwhile.
void reach(IsoMesh& mesh, const MeshSize& size);

}  // namespace isolux::mc
