#include <fmt/format.h>

#include <iterator>

#include "mesh_bytes.h"

namespace isolux {

void write_obj(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path, const MeshExtras& extras) {
  mc::require_fit(mesh, colours, extras);
  std::vector<char> text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# isolux\n");
  for (const std::string& line : mc::note_lines(extras)) fmt::format_to(out, "# {}\n", line);
  for (const auto v : mesh.vertices()) {
    // {} of a float gives the fewest digits that read back as the same float.
    const auto& p = mesh.point(v);
    const auto& n = mesh.normal(v);
    fmt::format_to(out, "v {} {} {}", p[0], p[1], p[2]);
    if (!colours.empty()) {
      const Rgb8& c = colours[std::size_t(v.idx())];
      fmt::format_to(out, " {:.4f} {:.4f} {:.4f}", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
    }
    fmt::format_to(out, "\nvn {} {} {}\n", n[0], n[1], n[2]);
  }
  for (const auto f : mesh.faces()) {
    fmt::format_to(out, "f");
    for (const auto v : mesh.fv_range(f)) fmt::format_to(out, " {0}//{0}", v.idx() + 1);
    fmt::format_to(out, "\n");
  }
  mc::write_bytes(text, path);
}

}  // namespace isolux
