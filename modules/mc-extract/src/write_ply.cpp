#include <fmt/format.h>

#include "mesh_bytes.h"

namespace isolux {

void write_ply(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path) {
  mc::require_colours_fit(mesh, colours);
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment isolux\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.n_vertices(), colours.empty() ? "" : "property uchar red\nproperty uchar green\nproperty uchar blue\n",
      mesh.n_faces());
  std::vector<char> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + mesh.n_vertices() * 27 + mesh.n_faces() * 13);
  for (const auto v : mesh.vertices()) {
    mc::put(bytes, mesh.point(v));
    mc::put(bytes, mesh.normal(v));
    if (!colours.empty()) mc::put(bytes, colours[std::size_t(v.idx())]);
  }
  for (const auto f : mesh.faces()) {
    mc::put(bytes, std::uint8_t(3));
    for (const auto v : mesh.fv_range(f)) mc::put(bytes, std::int32_t(v.idx()));
  }
  mc::write_bytes(bytes, path);
}

}  // namespace isolux
