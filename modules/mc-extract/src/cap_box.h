#pragma once

#include <isolux/mc_extract/indexed_mesh.h>

#include "level_set.h"

namespace isolux::mc {

/// Closes a level set's mesh by the part of the box's faces that is inside (CapKind::kBox), whichever way it was
/// extracted: square by square of the faces, between the mesh's boundary edges there and the corners that are inside.
void cap_box(IndexedMesh& mesh, const VolumeView& volume, const LevelSet& level_set);

/// What the settings ask of an extracted mesh beyond its surface: other normals, then the cap, then leaving out small
/// components. \throw Cancelled
void finish_mesh(IndexedMesh& mesh, const VolumeView& volume, const ExtractSettings& settings, const Run& run);

}  // namespace isolux::mc
