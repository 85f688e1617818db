#include <isolux/mc_extract/extractor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "build_mesh.h"
#include "cell_polygons.h"
#include "cube.h"
#include "surface_builder.h"
#include "trilinear_cell.h"

namespace isolux {

namespace {

using mc::CellPolygon;
using mc::EdgeTriangle;
using mc::TrilinearCell;

/// A polygon of a case and its triangles; none where it needs a vertex inside the cell.
struct Patch {
  CellPolygon polygon;
  std::vector<EdgeTriangle> triangles;
};

/// The patches of a case, by its inside corners and joined faces: 654 of the 16384 combinations exist.
class Patches {
 public:
  Patches() : of_case_(std::size_t(256) * 64) {
    for (int inside = 0; inside < 256; ++inside) {
      int ambiguous = 0;
      for (int face = 0; face < 6; ++face) ambiguous |= int(mc::face_segments(inside, face) == 2) << face;
      for (int joined = 0; joined < 64; ++joined) {
        if ((joined & ~ambiguous) != 0) continue;
        for (CellPolygon& polygon : mc::cell_polygons(inside, joined)) {
          std::vector<EdgeTriangle> triangles = mc::triangulate(polygon);
          of_case_[number(inside, joined)].push_back({std::move(polygon), std::move(triangles)});
        }
      }
    }
  }
  [[nodiscard]] const std::vector<Patch>& of(int inside, int joined) const { return of_case_[number(inside, joined)]; }

 private:
  static std::size_t number(int inside, int joined) { return std::size_t(inside) * 64 + std::size_t(joined); }
  std::vector<std::vector<Patch>> of_case_;
};

/// A vertex of a polygon or ring: its number and its place in the cell.
struct PlacedVertex {
  std::uint32_t id;
  Vec3 place;
};
using Ring = std::vector<PlacedVertex>;

/// The triangles of a strip between a polygon and a ring that runs beside it.
struct Strip {
  double cost = std::numeric_limits<double>::infinity();
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// From polygon vertex 0 opposite ring vertex `start`, once round both, with the least sum of squared lengths across,
/// and neither more than half a round ahead of the other: a vertex that met the whole other side would meet one of its
/// vertices twice.
Strip strip_from(const Ring& polygon, const Ring& ring, std::size_t start) {
  const std::size_t n = polygon.size();
  const std::size_t m = ring.size();
  const auto at = [&](std::size_t i) -> const PlacedVertex& { return polygon[i % n]; };
  const auto opposite = [&](std::size_t j) -> const PlacedVertex& { return ring[(start + j) % m]; };
  const auto across = [&](std::size_t i, std::size_t j) {
    const Vec3 d = at(i).place - opposite(j).place;
    return glm::dot(d, d);
  };
  std::vector<std::vector<double>> cost(n + 1, std::vector<double>(m + 1, 0.0));
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= m; ++j) {
      constexpr double kNever = std::numeric_limits<double>::infinity();
      if (i + j == 0) continue;
      const std::size_t ahead = i * m > j * n ? i * m - j * n : j * n - i * m;
      cost[i][j] = 2 * ahead >= n * m
                       ? kNever
                       : std::min(i > 0 ? cost[i - 1][j] : kNever, j > 0 ? cost[i][j - 1] : kNever) + across(i, j);
    }
  }
  Strip strip{.cost = cost[n][m], .triangles = {}};
  for (std::size_t i = n, j = m; i + j > 0;) {
    if (j == 0 || (i > 0 && cost[i - 1][j] <= cost[i][j - 1])) {
      strip.triangles.push_back({at(i - 1).id, at(i).id, opposite(j).id});
      --i;
    } else {
      strip.triangles.push_back({at(i).id, opposite(j).id, opposite(j - 1).id});
      --j;
    }
  }
  return strip;
}

Strip best_strip(const Ring& polygon, const Ring& ring) {
  Strip best;
  for (std::size_t start = 0; start < ring.size(); ++start) {
    Strip candidate = strip_from(polygon, ring, start);
    if (candidate.cost < best.cost) best = std::move(candidate);
  }
  return best;
}

/// What one cell adds to the surface.
class CellSurface {
 public:
  CellSurface(mc::SurfaceBuilder& surface, const Index3& cell, int inside, const Patches& patches)
      : surface_(surface), cell_(cell), inside_(inside), field_(relative_corners(surface, cell)) {
    patches_ = &patches.of(inside, field_.joined_faces());
  }

  void add() {
    std::array<const Patch*, 2> mouths{};
    if (patches_->size() > 1)
      if (const auto tunnel = field_.tunnel()) mouths = tunnel_mouths(*tunnel);
    if (mouths[0] != nullptr) add_tunnel(*mouths[0], *mouths[1]);
    for (const Patch& patch : *patches_) {
      if (&patch == mouths[0] || &patch == mouths[1]) continue;
      if (patch.triangles.empty())
        add_fan(patch.polygon);
      else
        for (const EdgeTriangle& t : patch.triangles) surface_.add_triangle(vertex(t[0]), vertex(t[1]), vertex(t[2]));
    }
  }

 private:
  /// Corner values less the isovalue, positive inside; a value equal to it counts as inside.
  static std::array<double, 8> relative_corners(const mc::SurfaceBuilder& surface, const Index3& cell) {
    std::array<double, 8> corners{};
    const double sign = surface.level_set().outer == OuterSide::kLower ? 1.0 : -1.0;
    for (int c = 0; c < 8; ++c)
      corners[c] = sign * (double(surface.value(cell + Index3(c & 1, c >> 1 & 1, c >> 2))) -
                           double(surface.level_set().isovalue));
    return corners;
  }

  [[nodiscard]] std::uint32_t vertex(int edge) const {
    const mc::CubeEdge& e = mc::kCubeEdges[edge];
    return surface_.edge_vertex(cell_ + Index3(e.low & 1, e.low >> 1 & 1, e.low >> 2), 1 << e.axis);
  }
  [[nodiscard]] Vec3 place(int edge) const {
    const mc::CubeEdge& e = mc::kCubeEdges[edge];
    Vec3 p(e.low & 1, e.low >> 1 & 1, e.low >> 2);
    const Index3 low = cell_ + Index3(p);
    Index3 high = low;
    ++high[e.axis];
    p[e.axis] = surface_.level_set().fraction(surface_.value(low), surface_.value(high), 1 << e.axis);
    return p;
  }
  [[nodiscard]] Ring placed(const CellPolygon& polygon) const {
    Ring ring;
    for (const mc::PolygonStep& step : polygon) ring.push_back({vertex(step.edge), place(step.edge)});
    return ring;
  }

  /// The patches that a tunnel opens: between the pieces it joins and the one piece of the other side that both touch.
  [[nodiscard]] std::array<const Patch*, 2> tunnel_mouths(const TrilinearCell::Tunnel& tunnel) const {
    const std::array<int, 8> region = field_.boundary_regions();
    const int joined_side = inside_ >> tunnel.from & 1;
    const auto region_beside = [&](const Patch& patch, int side) {
      const mc::CubeEdge& e = mc::kCubeEdges[patch.polygon[0].edge];
      return region[(inside_ >> e.low & 1) == side ? e.low : e.high()];
    };
    for (const Patch& a : *patches_)
      for (const Patch& b : *patches_)
        if (region_beside(a, joined_side) == region[tunnel.from] &&
            region_beside(b, joined_side) == region[tunnel.to] &&
            region_beside(a, 1 - joined_side) == region_beside(b, 1 - joined_side))
          return {&a, &b};
    return {};
  }

  void add_tunnel(const Patch& a, const Patch& b) {
    const auto hexagon = field_.hexagon();
    // A tunnel so narrow that rounding denies its ring is left out: two discs instead.
    if (!hexagon) {
      for (const Patch* patch : {&a, &b}) add_fan(patch->polygon);
      return;
    }
    Ring ring;
    for (const Vec3& p : spread(*hexagon)) ring.push_back({surface_.add_vertex(Vec3(cell_) + p), p});
    const Ring backwards(ring.rbegin(), ring.rend());
    const Ring from = placed(a.polygon);
    const Ring to = placed(b.polygon);
    const std::array<Strip, 2> one_way = {best_strip(from, ring), best_strip(to, backwards)};
    const std::array<Strip, 2> other_way = {best_strip(from, backwards), best_strip(to, ring)};
    const bool first = one_way[0].cost + one_way[1].cost <= other_way[0].cost + other_way[1].cost;
    for (const Strip& strip : first ? one_way : other_way)
      for (const auto& t : strip.triangles) surface_.add_triangle(t[0], t[1], t[2]);
  }

  /// A narrow ring widened until floats can tell its points apart.
  [[nodiscard]] std::array<Vec3, 6> spread(std::array<Vec3, 6> ring) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double margin = surface_.level_set().margin[axis];
      double low = 1.0;
      double high = 0.0;
      for (const Vec3& p : ring) {
        low = std::min(low, p[axis]);
        high = std::max(high, p[axis]);
      }
      const double middle = std::clamp(0.5 * (low + high), 1.5 * margin, 1.0 - 1.5 * margin);
      const double half = std::max(0.5 * (high - low), 0.5 * margin);
      for (Vec3& p : ring)
        p[axis] = std::clamp(p[axis] > 0.5 * (low + high) ? middle + half : middle - half, margin, 1.0 - margin);
    }
    return ring;
  }

  /// Triangles to one vertex inside the cell, near the polygon's middle and, if two steps along the gradient get there,
  /// on the trilinear surface.
  void add_fan(const CellPolygon& polygon) {
    const Ring ring = placed(polygon);
    Vec3 middle(0.0);
    for (const PlacedVertex& v : ring) middle += v.place / double(ring.size());
    for (int i = 0; i < 2; ++i) {
      const Vec3 g = field_.gradient(middle);
      const double squared = glm::dot(g, g);
      if (!(squared > 0.0)) break;
      const Vec3 closer = glm::clamp(middle - g * (field_.value(middle) / squared), Vec3(0.05), Vec3(0.95));
      if (std::fabs(field_.value(closer)) < std::fabs(field_.value(middle))) middle = closer;
    }
    const Vec3 margin(surface_.level_set().margin);
    const std::uint32_t centre = surface_.add_vertex(Vec3(cell_) + glm::clamp(middle, margin, 1.0 - margin));
    for (std::size_t i = 0; i < ring.size(); ++i)
      surface_.add_triangle(ring[i].id, ring[(i + 1) % ring.size()].id, centre);
  }

  mc::SurfaceBuilder& surface_;
  Index3 cell_;
  int inside_;
  TrilinearCell field_;
  const std::vector<Patch>* patches_;
};

/// Marching cubes with the topology of the trilinear interpolant: faces by the asymptotic decider, tunnels through
/// cells by Morse theory (see TrilinearCell) in place of the case analysis of MC33, their necks built on the ring of
/// straight lines that the surface holds (Grosso, "Construction of topologically correct and manifold isosurfaces", CGF
/// 2016).
class MarchingCubesTopological final : public Extractor {
 public:
  using Options = NoOptions;
  explicit MarchingCubesTopological(const Options& /*options*/) {}

  [[nodiscard]] IsoMesh extract(const VolumeView& volume, const ExtractSettings& settings,
                                const Run& run) const override {
    return mc::build_mesh(
        mc::build_surface(volume, settings, run, [this](mc::SurfaceBuilder& surface, const Index3& cell, int inside) {
          CellSurface(surface, cell, inside, patches_).add();
        }));
  }

 private:
  Patches patches_;
};

}  // namespace

namespace backends {
void marching_cubes_topological(Registry<Extractor>& registry) {
  registry.add<MarchingCubesTopological>(
      "marching_cubes_topological", "the exact topology of the trilinear interpolant, tunnels inside cells included");
}
}  // namespace backends

}  // namespace isolux
