#include "cell_polygons.h"

#include <functional>
#include <limits>

#include "cube.h"

namespace isolux::mc {

namespace {

/// Where the segments leaving each crossed edge go.
struct Successor {
  int edge = -1;
  int face = -1;
  int rank = 0;
};

/// The number of an edge within a face, the same seen from both cells that share the face.
int place_in_face(int face, int edge) {
  const CubeEdge& e = kCubeEdges[edge];
  const int across = 3 - face / 2 - e.axis;  // the face's axis other than the edge's
  return 2 * e.axis + (e.low >> across & 1);
}

void add_face_segments(int face, int inside, bool joined, std::array<Successor, 12>& next) {
  const auto& corners = kFaceCorners[face];
  const auto is_inside = [&](int i) { return (inside >> corners[i & 3] & 1) != 0; };
  const auto edge = [&](int i) { return cube_edge(corners[i & 3], corners[(i + 1) & 3]); };
  const bool ambiguous = face_segments(inside, face) == 2;
  int first_place = 6;
  for (int i = 0; i < 4; ++i)
    if (is_inside(i) != is_inside(i + 1)) first_place = std::min(first_place, place_in_face(face, edge(i)));
  for (int i = 0; i < 4; ++i) {
    if (is_inside(i) || !is_inside(i + 1)) continue;  // not a side on which the way round enters
    int j = i;
    const int step = ambiguous && joined ? 3 : 1;
    do j += step;
    while (!(is_inside(j) && !is_inside(j + 1)));
    const bool first = place_in_face(face, edge(i)) == first_place || place_in_face(face, edge(j)) == first_place;
    next[edge(i)] = {.edge = edge(j), .face = face, .rank = first ? 0 : 1};
  }
}

double squared_distance_of_midpoints(int a, int b) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto twice = [&](int e) { return (kCubeEdges[e].low >> axis & 1) + (kCubeEdges[e].high() >> axis & 1); };
    const double d = 0.5 * (twice(a) - twice(b));
    sum += d * d;
  }
  return sum;
}

}  // namespace

std::vector<CellPolygon> cell_polygons(int inside, int joined) {
  std::array<Successor, 12> next;
  for (int face = 0; face < 6; ++face) add_face_segments(face, inside, (joined >> face & 1) != 0, next);
  std::vector<CellPolygon> polygons;
  std::array<bool, 12> seen{};
  for (int start = 0; start < 12; ++start) {
    if (next[start].edge < 0 || seen[start]) continue;
    CellPolygon polygon;
    for (int e = start; !seen[e]; e = next[e].edge) {
      seen[e] = true;
      polygon.push_back({.edge = e, .face = next[e].face, .rank = next[e].rank});
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

std::vector<EdgeTriangle> triangulate(const CellPolygon& polygon) {
  constexpr double kImpossible = std::numeric_limits<double>::infinity();
  const int n = int(polygon.size());
  const auto edge = [&](int i) { return polygon[i].edge; };
  // cost[i][j]: of the best triangulation of vertices i..j, apex[i][j]: the third vertex of its triangle on (i, j).
  std::vector<std::vector<double>> cost(n, std::vector<double>(n, kImpossible));
  std::vector<std::vector<int>> apex(n, std::vector<int>(n, -1));
  for (int i = 0; i + 1 < n; ++i) cost[i][i + 1] = 0.0;
  for (int span = 2; span < n; ++span) {
    for (int i = 0; i + span < n; ++i) {
      const int j = i + span;
      const bool diagonal = span < n - 1;
      if (diagonal && (faces_of_edge(edge(i)) & faces_of_edge(edge(j))) != 0) continue;
      const double own = diagonal ? squared_distance_of_midpoints(edge(i), edge(j)) : 0.0;
      for (int k = i + 1; k < j; ++k) {
        const double candidate = cost[i][k] + cost[k][j] + own;
        if (candidate >= cost[i][j]) continue;
        cost[i][j] = candidate;
        apex[i][j] = k;
      }
    }
  }
  std::vector<EdgeTriangle> triangles;
  if (cost[0][n - 1] == kImpossible) return triangles;
  const std::function<void(int, int)> collect = [&](int i, int j) {
    if (j - i < 2) return;
    const int k = apex[i][j];
    triangles.push_back({edge(i), edge(k), edge(j)});
    collect(i, k);
    collect(k, j);
  };
  collect(0, n - 1);
  return triangles;
}

}  // namespace isolux::mc
