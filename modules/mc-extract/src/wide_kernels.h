#pragma once

#include <isolux/core/volume.h>
#include <isolux/mc_extract/indexed_mesh.h>

#include "case_table.h"
#include "march_state.h"

/// The passes over one slab, compiled for each instruction set and chosen at run time (Highway). All give the same bits
/// on every machine: IEEE operations in one order, no fused multiply-add, no approximate reciprocal.
namespace isolux::mc {

/// Sets the inside bits of a row.
void classify_row(MarchState& march, int j, int k);

/// The grid points of a row and a layer of bricks: rows and planes [first, last).
struct BrickRows {
  int first_row;
  int last_row;
  int first_plane;
  int last_plane;
};

/// Sets the inside bits of one word in each of these rows: those of the bricks of 16 voxels that `active` has a bit for
/// from their values, the others from `uniform`.
void classify_bricks(MarchState& march, const BrickRows& rows, int word, unsigned active, std::uint64_t uniform);

/// Smallest and largest value of the grid points first to last, both included, at most 17 along x; -inf and inf where
/// one of them is NaN.
void find_range(const VolumeView& volume, const Index3& first, const Index3& last, float& low, float& high);

/// Finds the words of slab k that hold anything, among `candidates` (packed, rising) or all if there are
/// none given, and counts what its rows hold.
void count_slab(MarchState& march, int k, const std::uint32_t* candidates, std::size_t candidate_count,
                Connectivity connectivity);

/// What vertices are computed from, in float: index space to world space, and gradients to normals.
struct VertexFrame {
  float origin[3];
  float axes[3][3];      ///< axes[a]: world step along index axis a
  float outwards[3][3];  ///< column a: what a gradient along index axis a adds to the direction outwards, scaled
  float along_edge[3]
                  [3];  ///< unit vector for an edge along axis a whose lower end is inside, where there is no gradient
  float margin[3];      ///< of an edge along each axis
};

/// Vertices that a mesh holds already, and may be written over.
struct VertexRoom {
  float* positions = nullptr;
  float* normals = nullptr;
  std::size_t vertices = 0;
};

/// Writes the vertices of slab k to their places in the mesh: 3 floats a vertex, world space.
void make_vertices(const MarchState& march, int k, const VertexFrame& frame, float* positions, float* normals);

/// Writes the triangles of slab k, three vertex numbers each.
void make_triangles(const MarchState& march, int k, const CaseTable& cases, Triangle* triangles);

/// OpenMesh's half-edge, as it lies in memory.
struct HalfEdgeRecord {
  std::int32_t face;
  std::int32_t to_vertex;
  std::int32_t next;
  std::int32_t previous;
};

/// Where OpenMesh keeps its connectivity.
struct HalfEdgeArrays {
  HalfEdgeRecord* half_edges;
  std::int32_t* vertex_half_edge;
  std::int32_t* face_half_edge;
};

/// Writes the half-edges of slab k's triangles, one half-edge of each of those faces, and one leaving each vertex that
/// a cell of the slab owns. Those of the border are left to link_border().
void make_half_edges(const MarchState& march, int k, const CaseTable& cases, const HalfEdgeArrays& out);

}  // namespace isolux::mc
