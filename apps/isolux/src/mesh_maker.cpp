#include "mesh_maker.h"

namespace isolux {

MeshMaker::MeshMaker(const VolumeView& volume, const BackendChoice& choice, std::size_t meshes, const Session& session)
    : volume_(volume), run_(session.run), extractor_(session.stages.extractors.create(choice.name, choice.settings)) {
  if (meshes > 1 && session.stages.extractors.info(choice.name).name == "marching_cubes") sweep_.emplace(volume, run_);
}

const IsoMesh& MeshMaker::extract(const ExtractSettings& settings) {
  if (sweep_) {
    if (!mesh_) mesh_ = std::make_unique<IsoMesh>();
    sweep_->extract(settings, run_, *mesh_);
  } else {
    mesh_.reset();
    // Made where it stays: OpenMesh moves no mesh, and a copy for which memory ends frees what is not its own.
    mesh_ = std::unique_ptr<IsoMesh>(new IsoMesh(extractor_->extract(volume_, settings, run_)));
  }
  return *mesh_;
}

}  // namespace isolux
