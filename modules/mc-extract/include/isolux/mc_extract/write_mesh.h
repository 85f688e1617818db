#pragma once

#include <isolux/mc_extract/iso_mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace isolux {

using Rgb8 = std::array<std::uint8_t, 3>;

/// Writes binary little-endian PLY: world coordinates, float vertex normals and, if `colours` is not empty (one a
/// vertex), `uchar red green blue`. Not atomic: see write_atomically_by_name of volume-io. \throw IoError naming path.
void write_ply(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& path);

}  // namespace isolux
