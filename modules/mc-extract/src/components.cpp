#include "components.h"

#include <limits>

namespace isolux::mc {

std::vector<bool> small_components(const IndexedMesh& mesh, std::size_t triangles) {
  VertexSets sets(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<std::size_t> size(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) ++size[sets.find(t[0])];
  std::vector<bool> small(mesh.positions.size());
  for (std::uint32_t v = 0; v < small.size(); ++v) small[v] = size[sets.find(v)] < triangles;
  return small;
}

void drop_small_components(IndexedMesh& mesh, std::size_t triangles) {
  const std::vector<bool> small = small_components(mesh, triangles);
  constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(mesh.positions.size(), kGone);
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < renumbered.size(); ++v) {
    if (small[v]) continue;
    mesh.positions[kept] = mesh.positions[v];
    mesh.normals[kept] = mesh.normals[v];
    renumbered[v] = kept++;
  }
  mesh.positions.resize(kept);
  mesh.normals.resize(kept);
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return renumbered[t[0]] == kGone; });
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = renumbered[v];
}

}  // namespace isolux::mc
