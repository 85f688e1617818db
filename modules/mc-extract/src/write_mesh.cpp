#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "mesh_bytes.h"
#include "write_openmesh.h"

namespace isolux {

namespace mc {

void require_colours_fit(const IsoMesh& mesh, std::span<const Rgb8> colours) {
  if (!colours.empty() && colours.size() != mesh.n_vertices())
    throw InvalidInput(fmt::format("{} colours for a mesh of {} vertices: give one a vertex, or none", colours.size(),
                                   mesh.n_vertices()));
}

void write_bytes(const std::vector<char>& bytes, const std::string& path) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), std::streamsize(bytes.size()));
  file.close();
  if (!file) throw IoError(fmt::format("{}: writing failed: {}", path, reason_of(errno)));
}

}  // namespace mc

const std::vector<std::string>& mesh_extensions() {
  static const std::vector<std::string> extensions = {".ply", ".glb", ".obj", ".off", ".stl"};
  return extensions;
}

namespace {
/// In lower case, with its dot.
std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}
}  // namespace

void require_mesh_extension(const std::string& path) {
  if (std::ranges::find(mesh_extensions(), extension_of(path)) == mesh_extensions().end())
    throw InvalidInput(fmt::format("{}: meshes are written as {}", path, fmt::join(mesh_extensions(), ", ")));
}

void write_mesh(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path) {
  require_mesh_extension(path);
  const std::string extension = extension_of(path);
  if (extension == ".ply") return write_ply(mesh, colours, path);
  if (extension == ".glb") return write_glb(mesh, colours, path);
  if (extension == ".obj") return write_obj(mesh, colours, path);
  mc::require_colours_fit(mesh, colours);
  mc::write_with_openmesh(mesh, colours, extension, path);
}

}  // namespace isolux
