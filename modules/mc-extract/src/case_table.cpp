#include "case_table.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>
#include <vector>

#include "cell_polygons.h"
#include "cube.h"

namespace isolux::mc {

namespace {

/// Where the two half-edges of an edge between two cube edges' vertices are found.
struct HalfEdgePlace {
  int slot;
  int half;
};
using EdgePlaces = std::map<std::pair<int, int>, HalfEdgePlace>;

std::pair<int, int> unordered(int a, int b) { return std::minmax({a, b}); }

EdgePlaces places_on_faces(const std::vector<CellPolygon>& polygons) {
  EdgePlaces places;
  for (const CellPolygon& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const PolygonStep& step = polygon[i];
      const int next = polygon[(i + 1) % polygon.size()].edge;
      const bool upper_cell = step.face % 2 == 0;  // the face is this cell's lower one
      places[unordered(step.edge, next)] = {.slot = step.face, .half = 2 * step.rank + (upper_cell ? 1 : 0)};
    }
  }
  return places;
}

CellCase make_case(int inside, CaseTable::Winding winding) {
  CellCase result;
  const int crossed = crossed_edges(inside);
  for (int e = 0; e < 12; ++e) {
    // Edges along y and z lie in pairs on their row: the one at the lower x, even, comes first.
    const int first = e < 4 ? e : e & ~1;
    result.step[e] = std::uint8_t(crossed >> first & 1);
    result.offset[e] = e == first ? std::uint8_t(0) : result.step[e];
  }
  for (int f = 0; f < 6; ++f) result.half_step[f] = std::uint8_t(2 * face_segments(inside, f));
  result.half_offset[1] = result.half_step[1] = result.half_step[0];
  const std::vector<CellPolygon> polygons = cell_polygons(inside, 0);
  EdgePlaces places = places_on_faces(polygons);
  for (const CellPolygon& polygon : polygons) {
    for (EdgeTriangle triangle : triangulate(polygon)) {
      if (winding == CaseTable::Winding::kInwards) std::swap(triangle[1], triangle[2]);
      for (int i = 0; i < 3; ++i) {
        const std::size_t corner = std::size_t(3) * result.triangles + std::size_t(i);
        assert(corner < 15);
        result.vertex[corner] = std::uint8_t(triangle[i]);
        if (triangle[i] % 4 == 0) result.owned[triangle[i] / 4] = std::int8_t(corner);
        const auto [place, is_new] = places.try_emplace(unordered(triangle[i], triangle[(i + 1) % 3]),
                                                        HalfEdgePlace{.slot = 6, .half = 2 * result.inner_edges});
        if (is_new) ++result.inner_edges;
        result.slot[corner] = std::uint8_t(place->second.slot);
        result.half[corner] = std::uint8_t(place->second.half);
        if (place->second.slot == 6) ++place->second.half;  // the next one to meet this diagonal is its other half
      }
      ++result.triangles;
    }
  }
  result.half_step[6] = std::uint8_t(2 * result.inner_edges);
  for (std::size_t corner = std::size_t(3) * result.triangles; corner < result.vertex.size(); ++corner) {
    result.vertex[corner] = result.vertex[corner % 3];
    result.slot[corner] = result.slot[corner % 3];
    result.half[corner] = result.half[corner % 3];
  }
  return result;
}

}  // namespace

CaseTable::CaseTable(Winding winding) {
  for (int inside = 0; inside < 256; ++inside) {
    cases_[inside] = make_case(inside, winding);
    counts_[inside] = cases_[inside].triangles | std::uint64_t(cases_[inside].inner_edges) << 32;
  }
}

const CaseTable& case_table(CaseTable::Winding winding) {
  static const CaseTable outwards(CaseTable::Winding::kOutwards);
  static const CaseTable inwards(CaseTable::Winding::kInwards);
  return winding == CaseTable::Winding::kOutwards ? outwards : inwards;
}

}  // namespace isolux::mc
