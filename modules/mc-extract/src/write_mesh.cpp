#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract/write_mesh.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

static_assert(std::endian::native == std::endian::little, "the writers put numbers as they lie in memory");

namespace isolux {

namespace {

template <class T>
void put(std::vector<char>& bytes, const T& value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

void require_colours_fit(const IsoMesh& mesh, std::span<const Rgb8> colours) {
  if (!colours.empty() && colours.size() != mesh.n_vertices())
    throw InvalidInput(fmt::format("{} colours for a mesh of {} vertices: give one a vertex, or none", colours.size(),
                                   mesh.n_vertices()));
}

}  // namespace

void write_ply(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path) {
  require_colours_fit(mesh, colours);
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
    put(bytes, mesh.point(v));
    put(bytes, mesh.normal(v));
    if (!colours.empty()) put(bytes, colours[std::size_t(v.idx())]);
  }
  for (const auto f : mesh.faces()) {
    put(bytes, std::uint8_t(3));
    for (const auto v : mesh.fv_range(f)) put(bytes, std::int32_t(v.idx()));
  }
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), std::streamsize(bytes.size()));
  file.close();
  if (!file) throw IoError(fmt::format("{}: cannot be written", path));
}

}  // namespace isolux
