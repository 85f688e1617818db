#pragma once

#include <array>
#include <bit>

/// The cell as a combinatorial cube. Corner c lies at (c & 1, c >> 1 & 1, c >> 2). Edges 0-3 run along x and are
/// numbered by y + 2z, 4-7 along y by x + 2z, 8-11 along z by x + 2y. Faces: x low, x high, y low, y high, z low,
/// z high.
namespace isolux::mc {

struct CubeEdge {
  int axis;  ///< that it runs along
  int low;   ///< its corner at the lower coordinate
  [[nodiscard]] constexpr int high() const { return low | 1 << axis; }
};

inline constexpr std::array<CubeEdge, 12> kCubeEdges = {
    {{0, 0}, {0, 2}, {0, 4}, {0, 6}, {1, 0}, {1, 1}, {1, 4}, {1, 5}, {2, 0}, {2, 1}, {2, 2}, {2, 3}}};

/// The corners of each face, counter-clockwise seen from outside the cube.
inline constexpr std::array<std::array<int, 4>, 6> kFaceCorners = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// The edge between two adjacent corners.
constexpr int cube_edge(int a, int b) {
  const int low = a & b;
  switch (a ^ b) {
    case 1:
      return low >> 1;
    case 2:
      return 4 + (low & 1) + 2 * (low >> 2);
    default:
      return 8 + low;
  }
}

/// Bit f is set where face f holds the corner.
constexpr int faces_of_corner(int c) { return 1 << (c & 1) | 4 << (c >> 1 & 1) | 16 << (c >> 2); }

/// Bit f is set where face f holds the edge.
constexpr int faces_of_edge(int e) {
  return faces_of_corner(kCubeEdges[e].low) & faces_of_corner(kCubeEdges[e].high());
}

/// Edges whose ends differ in `inside`, a bit a corner.
constexpr int crossed_edges(int inside) {
  int mask = 0;
  for (int e = 0; e < 12; ++e)
    if ((inside >> kCubeEdges[e].low & 1) != (inside >> kCubeEdges[e].high() & 1)) mask |= 1 << e;
  return mask;
}

/// Number of segments that a level set leaves on a face: 0, 1, or 2 where the corners alternate (an ambiguous face).
constexpr int face_segments(int inside, int face) {
  int changes = 0;
  for (int i = 0; i < 4; ++i)
    changes += (inside >> kFaceCorners[face][i] & 1) != (inside >> kFaceCorners[face][(i + 1) & 3] & 1) ? 1 : 0;
  return changes / 2;
}

}  // namespace isolux::mc
