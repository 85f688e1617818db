#pragma once

#include <isolux/core/lattice.h>
#include <isolux/mc_extract/iso_mesh.h>

#include <cstdint>
#include <vector>

namespace isolux {

/// The numbers of the vertices that CapKind::kBox added to a mesh, rising: grid points on the box's faces, which no
/// vertex of a surface is. Their normal is that of the box's face, outwards; on an edge or a corner of the box the mean
/// of its faces'. The rim's vertices are the surface's. `volume` is the lattice that the mesh was extracted from. Cost:
/// one pass over the vertices.
[[nodiscard]] std::vector<std::uint32_t> cap_vertices(const IsoMesh& mesh, const Lattice& volume);

}  // namespace isolux
