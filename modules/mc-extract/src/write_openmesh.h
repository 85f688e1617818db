#pragma once

#include <isolux/mc_extract/write_mesh.h>

namespace isolux::mc {

/// Through OpenMesh's writers: `.off` or `.stl`. \throw IoError naming path.
void write_with_openmesh(const IsoMesh& mesh, std::span<const Rgb8> colours, const std::string& extension,
                         const std::string& path);

}  // namespace isolux::mc
