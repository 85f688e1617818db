#pragma once

#include <isolux/core/vec.h>
#include <isolux/mc_extract/large_vector.h>

#include <array>
#include <cstdint>

namespace isolux {

/// Three vertex numbers, counter-clockwise seen from the outer side.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh, what a graphics card draws: positions in world space, a unit normal a vertex (towards the
/// outer side), triangles as vertex numbers. The arrays are contiguous: 3 floats or 3 numbers an element.
struct IndexedMesh {
  LargeVector<Vec3f> positions;
  LargeVector<Vec3f> normals;
  LargeVector<Triangle> triangles;
};

}  // namespace isolux
