#pragma once

#include <array>
#include <vector>

namespace isolux::mc {

/// A directed segment of a cell's polygons: from the vertex on cube edge `edge` across cube face `face`. `rank` tells
/// the two segments of an ambiguous face apart, alike from both cells that share it.
struct PolygonStep {
  int edge;
  int face;
  int rank;
};
using CellPolygon = std::vector<PolygonStep>;

/// The closed polygons in which a level set meets a cell's boundary, one vertex a crossed edge, counter-clockwise seen
/// from the side that is not inside. `inside` has a bit a corner, `joined` a bit a face: on an ambiguous face, whether
/// its two inside corners are connected there.
[[nodiscard]] std::vector<CellPolygon> cell_polygons(int inside, int joined);

using EdgeTriangle = std::array<int, 3>;  ///< three cube edges

/// Triangulates a polygon of cube edges without a diagonal that has both ends on one cube face (two cells could both
/// use it and an edge would have four faces); of the allowed triangulations the one with the shortest diagonals between
/// the edges' midpoints, by dynamic programming (Klincsek 1980). Empty if there is none: it then needs a vertex inside.
[[nodiscard]] std::vector<EdgeTriangle> triangulate(const CellPolygon& polygon);

}  // namespace isolux::mc
