#pragma once

#include <isolux/mc_extract/indexed_mesh.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace isolux::mc {

/// Disjoint sets of vertices, joined by union by smaller number with path halving (Tarjan & van Leeuwen 1984).
class VertexSets {
 public:
  explicit VertexSets(std::size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0U); }

  [[nodiscard]] std::uint32_t find(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// For each vertex whether its connected component has fewer than `triangles` triangles.
[[nodiscard]] std::vector<bool> small_components(const IndexedMesh& mesh, std::size_t triangles);

/// Leaves out the connected components of fewer than `triangles` triangles; the order of what stays is kept.
void drop_small_components(IndexedMesh& mesh, std::size_t triangles);

}  // namespace isolux::mc
