#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <utility>

#include "mesh_bytes.h"
#include "write_openmesh.h"

namespace isolux {

namespace mc {

void require_fit(const IsoMesh& mesh, std::span<const Rgb8> colours, const MeshExtras& extras) {
  if (!colours.empty() && colours.size() != mesh.n_vertices())
    throw InvalidInput(fmt::format("{} colours for a mesh of {} vertices: give one a vertex, or none", colours.size(),
                                   mesh.n_vertices()));
  if (extras.light.empty()) return;
  const bool is_light = extras.light_channels == 1 || extras.light_channels == 3;
  if (!is_light || extras.light.size() != mesh.n_vertices() * std::size_t(extras.light_channels))
    throw InvalidInput(
        fmt::format("{} numbers of light of {} channels for a mesh of {} vertices: give 1 or 3 a vertex, or none",
                    extras.light.size(), extras.light_channels, mesh.n_vertices()));
}

std::vector<std::string> note_lines(const MeshExtras& extras) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : extras.notes) {
    std::string line = fmt::format("{}={}", key, value);
    std::ranges::replace_if(
        line, [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    lines.push_back(std::move(line));
  }
  return lines;
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

bool holds_colours(const std::string& path) { return extension_of(path) != ".stl"; }

bool holds_light(const std::string& path) { return extension_of(path) == ".ply"; }

void write_mesh(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path, const MeshExtras& extras) {
  require_mesh_extension(path);
  const std::string extension = extension_of(path);
  if (extension == ".ply") return write_ply(mesh, colours, path, extras);
  if (extension == ".glb") return write_glb(mesh, colours, path, extras);
  if (extension == ".obj") return write_obj(mesh, colours, path, extras);
  mc::require_fit(mesh, colours, extras);
  mc::write_with_openmesh(mesh, colours, extension, path);
}

}  // namespace isolux
