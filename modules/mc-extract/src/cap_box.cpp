#include "cap_box.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/plain_floats.h>
#include <isolux/mc_extract/accurate_normals.h>
#include <isolux/mc_extract/vertex_resolution.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "build_mesh.h"
#include "components.h"
#include "cube.h"

namespace isolux::mc {

namespace {

using Point2 = glm::dvec2;
using Segment = std::pair<std::uint32_t, std::uint32_t>;  ///< the cap's boundary runs from the first to the second

/// One square of a face of the box: its four corners as grid points, counter-clockwise seen from outside.
struct Square {
  int face;
  Index3 cell;
  [[nodiscard]] Index3 corner(int i) const {
    const int c = kFaceCorners[face][i & 3];
    return cell + Index3(c & 1, c >> 1 & 1, c >> 2);
  }
};

double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class BoxCap {
 public:
  BoxCap(IndexedMesh& mesh, const VolumeView& volume, const LevelSet& level_set)
      : mesh_(mesh), volume_(volume), lattice_(volume.lattice()), level_set_(level_set) {}

  void add() {
    find_segments();
    const Index3 cells = lattice_.size - 1;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      Square square{.face = face, .cell = Index3(0)};
      square.cell[axis] = face % 2 == 0 ? 0 : cells[axis] - 1;
      for (square.cell[v] = 0; square.cell[v] < cells[v]; ++square.cell[v])
        for (square.cell[u] = 0; square.cell[u] < cells[u]; ++square.cell[u]) fill(square);
    }
    for (const auto& [point, vertex] : corner_vertices_) set_corner_normal(point, vertex);
  }

 private:
  [[nodiscard]] Vec3 index_of(std::uint32_t vertex) const {
    return lattice_.frame.index(Vec3(mesh_.positions[vertex]));
  }
  [[nodiscard]] bool on_side(const Vec3& index, int axis, int side) const {
    return std::fabs(index[axis] - side) < 0.5 * level_set_.margin[axis];
  }
  [[nodiscard]] std::size_t key(const Square& square) const {
    return lattice_.offset(square.cell.x, square.cell.y, square.cell.z) * 6 + std::size_t(square.face);
  }

  /// Sorts the mesh's boundary edges into the squares they lie in.
  void find_segments() {
    const IsoMesh half_edges = build_mesh(mesh_);
    for (int h = 0; h < int(half_edges.n_halfedges()); ++h) {
      const OpenMesh::HalfedgeHandle border(h);
      if (!half_edges.is_boundary(border)) continue;
      auto from = std::uint32_t(half_edges.from_vertex_handle(border).idx());
      auto to = std::uint32_t(half_edges.to_vertex_handle(border).idx());
      if (level_set_.mirrored) std::swap(from, to);
      const Vec3 a = index_of(from);
      const Vec3 b = index_of(to);
      const Vec3 middle = 0.5 * (a + b);
      for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const int side = face % 2 == 0 ? 0 : lattice_.size[axis] - 1;
        if (!on_side(a, axis, side) || !on_side(b, axis, side)) continue;
        const Index3 cell = glm::clamp(Index3(glm::floor(middle)), Index3(0), lattice_.size - 2);
        segments_[key({.face = face, .cell = cell})].emplace_back(from, to);
      }
    }
  }

  [[nodiscard]] bool inside(const Index3& point) const { return level_set_.inside(volume_(point.x, point.y, point.z)); }

  std::uint32_t corner_vertex(const Index3& point) {
    const auto [place, is_new] =
        corner_vertices_.try_emplace(lattice_.offset(point.x, point.y, point.z), std::uint32_t(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.emplace_back(lattice_.frame.world(Vec3(point)));
      mesh_.normals.emplace_back(0.0f);
    }
    return place->second;
  }

  /// The mean of the normals of the box's faces that meet in a grid point.
  void set_corner_normal(std::size_t point, std::uint32_t vertex) {
    const std::size_t plane = std::size_t(lattice_.size.x) * std::size_t(lattice_.size.y);
    const Index3 at(int(point % std::size_t(lattice_.size.x)), int(point % plane / std::size_t(lattice_.size.x)),
                    int(point / plane));
    const Mat3 to_normal = lattice_.frame.gradient_to_world();
    Vec3 sum(0.0);
    for (int a = 0; a < 3; ++a) {
      if (at[a] == 0) sum -= glm::normalize(to_normal[a]);
      if (at[a] == lattice_.size[a] - 1) sum += glm::normalize(to_normal[a]);
    }
    mesh_.normals[vertex] = Vec3f(glm::normalize(sum));
  }

  /// Place in a square, counter-clockwise seen from outside, its corners at (0,0), (1,0), (1,1), (0,1).
  [[nodiscard]] static Point2 place(const Square& square, const Vec3& index) {
    const Vec3 origin(square.corner(0));
    return {glm::dot(index - origin, Vec3(square.corner(1)) - origin),
            glm::dot(index - origin, Vec3(square.corner(3)) - origin)};
  }

  /// Which side of the square (from corner i to i + 1) a vertex lies on, or -1.
  [[nodiscard]] int side_of(const Square& square, std::uint32_t vertex) const {
    const Point2 p = place(square, index_of(vertex));
    // In margins: where those of the axes differ, the rounding across one may be more than the other's whole margin.
    const Point2 margin = place(square, Vec3(square.corner(0)) + Vec3(level_set_.margin));
    const std::array<double, 4> distance = {p.y, 1.0 - p.x, 1.0 - p.y, p.x};
    std::array<double, 4> margins{};
    for (int i = 0; i < 4; ++i) margins[i] = distance[i] / std::fabs(i % 2 == 0 ? margin.y : margin.x);
    const int nearest = int(std::min_element(margins.begin(), margins.end()) - margins.begin());
    return margins[nearest] < 0.5 ? nearest : -1;
  }

  void fill(const Square& square) {
    const auto found = segments_.find(key(square));
    if (found == segments_.end()) {
      if (!inside(square.corner(0))) return;
      std::vector<std::uint32_t> polygon;
      for (int i = 0; i < 4; ++i) polygon.push_back(corner_vertex(square.corner(i)));
      return add_polygon(square, polygon);
    }
    std::vector<Segment> segments = found->second;
    std::array<int, 4> starting{-1, -1, -1, -1};  // segment that starts on each side
    for (int s = 0; s < int(segments.size()); ++s) {
      const int side = side_of(square, segments[s].first);
      if (side >= 0) starting[side] = s;
    }
    std::vector<bool> used(segments.size(), false);
    for (const int start : starting) {
      if (start < 0 || used[start]) continue;
      std::vector<std::uint32_t> polygon;
      for (int s = start; !used[s];) {
        used[s] = true;
        polygon.push_back(segments[s].first);
        const std::uint32_t end = segments[s].second;
        const auto next = std::ranges::find(segments, end, &Segment::first);
        if (next != segments.end()) {
          s = int(next - segments.begin());
          continue;
        }
        // Round the square's corners, which are inside, to where the next segment starts.
        polygon.push_back(end);
        int side = side_of(square, end);
        do {
          ++side;
          polygon.push_back(corner_vertex(square.corner(side)));
        } while (starting[side & 3] < 0);
        s = starting[side & 3];
      }
      add_polygon(square, polygon);
    }
  }

  /// The triangulation whose smallest triangle is largest, by dynamic programming: where all its triangles turn the
  /// right way it covers the polygon once, convex or not, and none is empty.
  void add_polygon(const Square& square, const std::vector<std::uint32_t>& polygon) {
    const std::size_t n = polygon.size();
    std::vector<Point2> at;
    for (const std::uint32_t vertex : polygon) at.push_back(place(square, index_of(vertex)));
    std::vector<std::vector<double>> smallest(n, std::vector<double>(n, std::numeric_limits<double>::infinity()));
    std::vector<std::vector<std::size_t>> apex(n, std::vector<std::size_t>(n, 0));
    for (std::size_t span = 2; span < n; ++span) {
      for (std::size_t i = 0; i + span < n; ++i) {
        const std::size_t j = i + span;
        smallest[i][j] = -std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k) {
          const double candidate = std::min({smallest[i][k], smallest[k][j], turn(at[i], at[k], at[j])});
          if (candidate <= smallest[i][j]) continue;
          smallest[i][j] = candidate;
          apex[i][j] = k;
        }
      }
    }
    const std::function<void(std::size_t, std::size_t)> collect = [&](std::size_t i, std::size_t j) {
      if (j - i < 2) return;
      const std::size_t k = apex[i][j];
      add_triangle(polygon[i], polygon[k], polygon[j]);
      collect(i, k);
      collect(k, j);
    };
    collect(0, n - 1);
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (level_set_.mirrored) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  IndexedMesh& mesh_;
  const VolumeView& volume_;
  const Lattice& lattice_;
  const LevelSet& level_set_;
  std::unordered_map<std::size_t, std::vector<Segment>> segments_;
  std::unordered_map<std::size_t, std::uint32_t> corner_vertices_;
};

}  // namespace

void cap_box(IndexedMesh& mesh, const VolumeView& volume, const LevelSet& level_set) {
  // Which side of a square a vertex lies on is read from its position.
  const double places = places_a_voxel(volume.lattice());
  if (!(places >= kPlacesEnough)) {
    const Vec3& origin = volume.lattice().frame.origin;
    throw InvalidInput(fmt::format(
        "{}: so far out as its origin ({}, {}, {}) a mesh's float coordinates tell {:.2g} places a voxel apart; a cap "
        "needs {}: move the origin nearer to 0",
        volume.name(), origin.x, origin.y, origin.z, places, kPlacesEnough));
  }
  BoxCap(mesh, volume, level_set).add();
}

void finish_mesh(IndexedMesh& mesh, const VolumeView& volume, const ExtractSettings& settings, const Run& run) {
  const PlainFloats plain;
  // Before there is a cap: the rim's normals are of the surface alone.
  if (settings.normals == NormalKind::kFaces) set_face_normals(mesh);
  if (settings.normals == NormalKind::kAccurate) set_accurate_normals(volume, settings.outer, run, mesh);
  if (settings.cap == CapKind::kBox) cap_box(mesh, volume, LevelSet(volume.lattice(), settings));
  if (settings.min_component > 0) drop_small_components(mesh, settings.min_component);
}

}  // namespace isolux::mc
