#pragma once

#include <isolux/bake/bake.h>
#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/iso_extractor.h>

#include <memory>
#include <optional>

#include "session.h"

namespace isolux {

/// Makes one mesh of a volume after the other, in the memory of the one before. Where there are several, what marching
/// cubes need of the volume is found once (IsoExtractor). The volume must outlive it.
class MeshMaker {
 public:
  /// \throw InvalidInput as Registry::create
  MeshMaker(const VolumeView& volume, const BackendChoice& choice, std::size_t meshes, const Session& session);

  /// The mesh is there until the next call. \throw as Extractor::extract
  [[nodiscard]] const IsoMesh& extract(const ExtractSettings& settings);

 private:
  VolumeView volume_;
  const Run& run_;
  std::unique_ptr<Extractor> extractor_;
  std::optional<IsoExtractor> sweep_;
  std::unique_ptr<IsoMesh> mesh_;
};

}  // namespace isolux
