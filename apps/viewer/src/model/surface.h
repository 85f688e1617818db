#pragma once

#include <isolux/bake/bake.h>
#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/iso_extractor.h>

#include <memory>
#include <optional>
#include <string>

#include "model/viewed_volume.h"

namespace isolux::viewer {

/// One isosurface, ready to be drawn.
struct Surface {
  ExtractSettings settings;
  IndexedMesh mesh;
  double seconds = 0.0;  ///< that the extraction took
  std::string error;     ///< one line if it failed; then there are no triangles
};

/// Makes one surface of a volume after the other. For one thread at a time.
class SurfaceMaker {
 public:
  /// With marching cubes ("" or "marching_cubes") through IsoExtractor, whose index is made with the first surface;
  /// with other backends through the registry. \throw InvalidInput as Registry::create
  SurfaceMaker(std::shared_ptr<const ViewedVolume> volume, const Registry<Extractor>& extractors,
               const BackendChoice& choice);

  /// What goes wrong is in Surface::error. The mesh's memory is that of `memory` where it is large enough.
  /// \throw Cancelled
  [[nodiscard]] Surface make(const ExtractSettings& settings, IndexedMesh memory, const Run& run);

 private:
  void extract(const ExtractSettings& settings, const Run& run, IndexedMesh& mesh);

  std::shared_ptr<const ViewedVolume> volume_;
  std::unique_ptr<Extractor> extractor_;  ///< none: the fast one
  std::optional<IsoExtractor> fast_;
};

}  // namespace isolux::viewer
