#include <isolux/mc_extract/left_out_components.h>
#include <isolux/mc_extract/vertex_resolution.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "components.h"

namespace isolux {

struct LeftOutComponents::CellRange {
  Index3 low;
  Index3 high;

  void widen(const Index3& cells) {
    low = glm::max(low - 1, Index3(0));
    high = glm::min(high + 1, cells - 1);
  }
  /// Calls `work` with the number of each.
  template <class Work>
  void each(const Lattice& lattice, const Work& work) const {
    for (int k = low.z; k <= high.z; ++k)
      for (int j = low.y; j <= high.y; ++j)
        for (int i = low.x; i <= high.x; ++i) work(lattice.offset(i, j, k));
  }
};

namespace {

/// Squared, of a point from a triangle: Ericson, Real-Time Collision Detection (2005), 5.1.5.
double squared_distance(const Vec3& p, const std::array<Vec3f, 3>& corners) {
  const Vec3 a(corners[0]);
  const Vec3 ab = Vec3(corners[1]) - a;
  const Vec3 ac = Vec3(corners[2]) - a;
  const Vec3 ap = p - a;
  const double d1 = glm::dot(ab, ap);
  const double d2 = glm::dot(ac, ap);
  const double d3 = d1 - glm::dot(ab, ab);
  const double d4 = d2 - glm::dot(ac, ab);
  const double d5 = d1 - glm::dot(ab, ac);
  const double d6 = d2 - glm::dot(ac, ac);
  const auto from = [&](double u, double v) {
    const Vec3 q = ap - u * ab - v * ac;
    return glm::dot(q, q);
  };
  if (d1 <= 0.0 && d2 <= 0.0) return from(0.0, 0.0);
  if (d3 >= 0.0 && d4 <= d3) return from(1.0, 0.0);
  if (d6 >= 0.0 && d5 <= d6) return from(0.0, 1.0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return from(d1 / (d1 - d3), 0.0);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return from(0.0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return from(1.0 - w, w);
  }
  const double sum = va + vb + vc;
  return from(vb / sum, vc / sum);
}

Vec3 middle_of(const std::array<Vec3f, 3>& corners) {
  return (Vec3(corners[0]) + Vec3(corners[1]) + Vec3(corners[2])) / 3.0;
}

}  // namespace

LeftOutComponents::LeftOutComponents(IsoExtractor& extractor, const Lattice& lattice, const ExtractSettings& settings,
                                     const Run& run)
    // Vertices keep a margin from grid points: further away no triangle of another cell counts.
    : lattice_(lattice), reach_(vertex_margin(lattice)) {
  ExtractSettings all = settings;
  all.min_component = 0;
  IndexedMesh mesh;
  extractor.extract(all, run, mesh);
  const std::vector<bool> small = mc::small_components(mesh, settings.min_component);
  kept_.resize(lattice_.count());
  nearby_.resize(lattice_.count());
  for (const Triangle& triangle : mesh.triangles) {
    if (!small[triangle[0]]) continue;
    CellRange cells = cells_at(middle_of(corners_of(mesh, triangle)));
    cells.widen(lattice_.size - 1);
    cells.each(lattice_, [&](std::size_t cell) { nearby_[cell] = true; });
  }
  for (const Triangle& triangle : mesh.triangles) {
    const std::array<Vec3f, 3> corners = corners_of(mesh, triangle);
    cells_at(middle_of(corners)).each(lattice_, [&](std::size_t cell) {
      if (!small[triangle[0]]) kept_[cell] = true;
      if (nearby_[cell]) pieces_.push_back({.cell = cell, .corners = corners, .left_out = small[triangle[0]]});
    });
  }
  std::stable_sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return a.cell < b.cell; });
}

std::array<Vec3f, 3> LeftOutComponents::corners_of(const IndexedMesh& mesh, const Triangle& triangle) const {
  std::array<Vec3f, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) corners[i] = Vec3f(lattice_.frame.index(Vec3(mesh.positions[triangle[i]])));
  return corners;
}

LeftOutComponents::CellRange LeftOutComponents::cells_at(const Vec3& index) const {
  const Index3 last = lattice_.size - 2;
  return {.low = glm::clamp(Index3(glm::floor(index - reach_)), Index3(0), last),
          .high = glm::clamp(Index3(glm::floor(index + reach_)), Index3(0), last)};
}

bool LeftOutComponents::leaves_nothing() const {
  return !pieces_.empty() && std::find(kept_.begin(), kept_.end(), true) == kept_.end();
}

bool LeftOutComponents::contain(const Vec3& index) const {
  double nearest = std::numeric_limits<double>::infinity();
  bool is_left_out = true;
  cells_at(index).each(lattice_, [&](std::size_t cell) {
    if (!nearby_[cell]) {
      // The cells about a place touch each other: then none of them holds what is left out.
      is_left_out = is_left_out && !kept_[cell];
      return;
    }
    const auto before = [](const Piece& piece, std::size_t number) { return piece.cell < number; };
    auto piece = std::lower_bound(pieces_.begin(), pieces_.end(), cell, before);
    for (; piece != pieces_.end() && piece->cell == cell; ++piece) {
      const double distance = squared_distance(index, piece->corners);
      if (distance >= nearest) continue;
      nearest = distance;
      is_left_out = piece->left_out;
    }
  });
  return is_left_out;
}

}  // namespace isolux
