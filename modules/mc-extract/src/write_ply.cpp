#include <fmt/format.h>

#include "mesh_bytes.h"

namespace isolux {

namespace {

std::string light_properties(const MeshExtras& extras) {
  if (extras.light.empty()) return "";
  if (extras.light_channels == 1) return "property float quality\n";
  return "property float e_r\nproperty float e_g\nproperty float e_b\n";
}

std::string header_of(const IsoMesh& mesh, bool has_colours, const MeshExtras& extras) {
  std::string comments = "comment isolux\n";
  for (const std::string& line : mc::note_lines(extras)) comments += fmt::format("comment {}\n", line);
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\n{}element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n{}{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      comments, mesh.n_vertices(), has_colours ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "",
      light_properties(extras), mesh.n_faces());
}

}  // namespace

void write_ply(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path, const MeshExtras& extras) {
  mc::require_fit(mesh, colours, extras);
  const std::string header = header_of(mesh, !colours.empty(), extras);
  std::vector<char> bytes(header.begin(), header.end());
  const std::size_t channels = extras.light.empty() ? 0 : std::size_t(extras.light_channels);
  bytes.reserve(bytes.size() + mesh.n_vertices() * (27 + 4 * channels) + mesh.n_faces() * 13);
  for (const auto v : mesh.vertices()) {
    const auto number = std::size_t(v.idx());
    mc::put(bytes, mesh.point(v));
    mc::put(bytes, mesh.normal(v));
    if (!colours.empty()) mc::put(bytes, colours[number]);
    for (const float e : extras.light.subspan(number * channels, channels)) mc::put(bytes, e);
  }
  for (const auto f : mesh.faces()) {
    mc::put(bytes, std::uint8_t(3));
    for (const auto v : mesh.fv_range(f)) mc::put(bytes, std::int32_t(v.idx()));
  }
  mc::write_bytes(bytes, path);
}

}  // namespace isolux
