#pragma once

#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/iso_mesh.h>

namespace isolux::mc {

/// The half-edge mesh of an oriented manifold triangle mesh, written into OpenMesh's kernel in bulk: half-edges are
/// paired through the lists of half-edges leaving each vertex, in linear time. \throw InvalidInput if an edge has more
/// than two faces or two faces disagree on its direction, or if there are too many half-edges for OpenMesh.
[[nodiscard]] IsoMesh build_mesh(const IndexedMesh& indexed);
/// The same into `mesh`, of which nothing is kept: OpenMesh moves no mesh, and a copy for which memory ends frees what
/// is not its own.
void build_mesh(const IndexedMesh& indexed, IsoMesh& mesh);

/// Replaces the normals by the area-weighted means of the adjacent faces' (their cross products are summed). A vertex
/// whose faces cancel keeps the one it had.
void set_face_normals(IndexedMesh& mesh);
void set_face_normals(IsoMesh& mesh);

}  // namespace isolux::mc
