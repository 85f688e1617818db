#pragma once

#include <isolux/core/vec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace isolux {

/// Three vertex numbers, counter-clockwise seen from the outer side.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh, what a graphics card draws: positions in world space, a unit normal a vertex (towards the
/// outer side), triangles as vertex numbers.
struct IndexedMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;
  std::vector<Triangle> triangles;
};

}  // namespace isolux
