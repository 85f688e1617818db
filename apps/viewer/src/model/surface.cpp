#include "model/surface.h"

#include <isolux/core/error.h>
#include <isolux/core/stopwatch.h>

#include <new>
#include <stdexcept>
#include <utility>

namespace isolux::viewer {
SurfaceMaker::SurfaceMaker(std::shared_ptr<const ViewedVolume> volume, const Registry<Extractor>& extractors,
                           const BackendChoice& choice)
    : volume_(std::move(volume)), extractor_(extractors.create(choice.name, choice.settings)) {
  if (extractors.info(choice.name).name == "marching_cubes") extractor_.reset();
}

Surface SurfaceMaker::make(const ExtractSettings& settings, IndexedMesh memory, const Run& run) {
  Surface surface;
  surface.settings = settings;
  surface.mesh = std::move(memory);
  const Stopwatch watch;
  try {
    extract(settings, run, surface.mesh);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    surface.mesh = {};
    surface.error = error.what();
  } catch (const std::bad_alloc&) {
    surface.mesh = {};
    surface.error = "not enough memory for this surface";
  } catch (const std::length_error&) {
    surface.mesh = {};
    surface.error = "this surface is larger than memory can be";
  }
  surface.seconds = watch.seconds();
  return surface;
}

void SurfaceMaker::extract(const ExtractSettings& settings, const Run& run, IndexedMesh& mesh) {
  if (extractor_) {
    mesh = indexed_mesh(extractor_->extract(volume_->stored(), settings, run));
    return;
  }
  if (!fast_) fast_.emplace(volume_->stored(), run);
  fast_->extract(settings, run, mesh);
}

}  // namespace isolux::viewer
