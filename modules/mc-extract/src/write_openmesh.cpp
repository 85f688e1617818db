// OpenMesh grows its colour arrays by T(), of which GCC 12 thinks that it may be read uninitialised.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include "write_openmesh.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <cerrno>
#include <fstream>
#include <locale>

namespace isolux::mc {

namespace {

/// OpenMesh's writers talk on its log and error streams; a library does not print.
class QuietOpenMesh {
 public:
  QuietOpenMesh() : log_(omlog().is_enabled()), errors_(omerr().is_enabled()) {
    omlog().disable();
    omerr().disable();
  }
  ~QuietOpenMesh() {
    if (log_) omlog().enable();
    if (errors_) omerr().enable();
  }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;

 private:
  bool log_;
  bool errors_;
};

}  // namespace

void write_with_openmesh(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& extension,
                         const std::string& path) {
  using OpenMesh::IO::Options;
  constexpr std::streamsize kDigits = 9;  // as many as tell any two floats apart
  const QuietOpenMesh quiet;
  // OpenMesh reports success where a file cannot be opened and where the disk is full: it gets a stream to be asked.
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.imbue(std::locale::classic());
  Options options;
  if (extension == ".stl")
    options += Options::Binary;
  else
    options += Options::VertexNormal;
  bool written = false;
  if (extension != ".stl" && !colours.empty()) {
    options += Options::VertexColor;
    IsoMesh coloured = mesh;
    coloured.request_vertex_colors();
    for (const auto v : coloured.vertices()) {
      const Rgb8& c = colours[std::size_t(v.idx())];
      coloured.set_color(v, {c[0], c[1], c[2]});
    }
    written = OpenMesh::IO::write_mesh(coloured, file, extension, options, kDigits);
  } else if (extension == ".stl") {
    // Its writer asks for normals of faces.
    IsoMesh with_faces = mesh;
    with_faces.request_face_normals();
    with_faces.update_face_normals();
    written = OpenMesh::IO::write_mesh(with_faces, file, extension, options, kDigits);
  } else {
    written = OpenMesh::IO::write_mesh(mesh, file, extension, options, kDigits);
  }
  file.close();
  if (!written || !file) throw IoError(fmt::format("{}: writing failed: {}", path, reason_of(errno)));
}

}  // namespace isolux::mc
