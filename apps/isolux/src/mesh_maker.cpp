#include "mesh_maker.h"

namespace isolux {

MeshMaker::MeshMaker(const VolumeView& volume, const BackendChoice& choice, std::size_t meshes, const Session& session)
    : volume_(volume), run_(session.run), extractor_(session.stages.extractors.create(choice.name, choice.settings)) {
  if (meshes > 1 && session.stages.extractors.info(choice.name).name == "marching_cubes") sweep_.emplace(volume, run_);
}

void MeshMaker::extract(const ExtractSettings& settings, IsoMesh& mesh) {
  if (sweep_) return sweep_->extract(settings, run_, mesh);
  mesh = extractor_->extract(volume_, settings, run_);
}

}  // namespace isolux
