#pragma once

#include <isolux/mc_extract/iso_mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isolux {

/// A colour as a screen shows it (sRGB).
using Rgb8 = std::array<std::uint8_t, 3>;

/// What a file may say besides the mesh and its colours.
struct MeshExtras {
  /// e of the vertices, `light_channels` (1 or 3) numbers each, or none. Only .ply has it: as float properties, the
  /// scalar `quality` that MeshLab shows, or e_r, e_g and e_b.
  std::span<const float> light{};
  int light_channels = 1;
  /// Keys and values: comments `key=value` of .ply and .obj, `extras` of glTF's node. Control characters become blanks.
  std::vector<std::pair<std::string, std::string>> notes{};
  std::string name{};  ///< of glTF's mesh and node
};

/// Writes binary little-endian PLY: world coordinates, float vertex normals and, if `colours` is not empty (one a
/// vertex), `uchar red green blue`. Not atomic: see write_atomically_by_name of volume-io. \throw IoError naming path;
/// InvalidInput if there are colours or light, but not one a vertex.
void write_ply(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path,
               const MeshExtras& extras = {});

/// Writes binary glTF 2.0: one mesh with normals and, if there are colours, vertex colours in linear light and a
/// material that is shown unlit (KHR_materials_unlit), for they are the light. Coordinates are the world's as they are;
/// viewers take y as up. \throw as write_ply; InvalidInput beyond the format's 4 GiB.
void write_glb(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path,
               const MeshExtras& extras = {});

/// Writes Wavefront OBJ: text that reads back as the same floats, normals, and colours as fractions behind the
/// coordinates. \throw as write_ply.
void write_obj(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path,
               const MeshExtras& extras = {});

/// Writes the format that the path's extension names: `.ply`, `.glb`, `.obj`, or through OpenMesh `.off` (text; normals
/// and colours) and `.stl` (binary; neither), these two without extras. \throw as write_ply; InvalidInput for another
/// extension.
void write_mesh(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path,
                const MeshExtras& extras = {});

/// Whether the format that the path's extension names has colours: all but .stl.
[[nodiscard]] bool holds_colours(const std::string& path);
/// Whether it has MeshExtras::light: .ply alone.
[[nodiscard]] bool holds_light(const std::string& path);

/// For finding out before the work that write_mesh would refuse a path's extension. \throw InvalidInput naming path and
/// the extensions there are.
void require_mesh_extension(const std::string& path);

/// The extensions that write_mesh knows, with their dots.
[[nodiscard]] const std::vector<std::string>& mesh_extensions();

}  // namespace isolux
