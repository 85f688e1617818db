#pragma once

#include <isolux/core/volume.h>
#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>

#include <string>

namespace isolux::viewer {

/// One isosurface, ready to be drawn.
struct Surface {
  ExtractSettings settings;
  IndexedMesh mesh;
  double seconds = 0.0;  ///< that the extraction took
  std::string error;     ///< one line if it failed; then there are no triangles
};

/// Makes the surface. What goes wrong is in `error`. \throw Cancelled
[[nodiscard]] Surface extract_surface(const Extractor& extractor, const Volume& volume, const ExtractSettings& settings,
                                      const Run& run);

}  // namespace isolux::viewer
