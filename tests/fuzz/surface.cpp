// Surfaces of small volumes of any values, by every backend: what docs/extraction.md and the stage's contract promise.
#include <isolux/mc_extract.h>

#include <map>
#include <memory>
#include <optional>

#include "mesh_laws.h"
#include "small_volume.h"

namespace {

using namespace isolux;
using fuzz::require;
namespace laws = isolux::testing;

void check_open(IsoMesh& mesh, const Volume& volume, const std::string& backend) {
  require(bool(laws::is_manifold(mesh)), backend + ": a mesh is 2-manifold");
  require(bool(laws::openmesh_accepts(mesh)), backend + ": a mesh has no complex edge");
  require(bool(laws::is_open_only_at_the_box(mesh, volume.lattice())), backend + ": a mesh is open at the box only");
  require(bool(laws::normals_are_unit(mesh)), backend + ": normals are of unit length");
}

using Backends = std::map<std::string, std::unique_ptr<Extractor>>;

Backends all_backends() {
  Backends all;
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends()) all[info.name] = registry.create(info.name);
  return all;
}

/// The same voxels in their own type, where they are whole numbers of 16 bits.
std::optional<StoredVolume> narrow(const Volume& volume) {
  StoredVolume stored;
  stored.name = volume.name;
  std::vector<std::int16_t> values;
  for (const float value : volume.values.values()) {
    if (!(value >= -32768.0f && value <= 32767.0f) || value != std::floor(value)) return std::nullopt;
    values.push_back(std::int16_t(value));
  }
  stored.values = Grid<std::int16_t>(volume.lattice(), std::move(values));
  return stored;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Backends backends = all_backends();
  fuzz::Bytes bytes(data, size);
  ExtractSettings settings;
  settings.outer = bytes.below(2) == 0 ? OuterSide::kLower : OuterSide::kHigher;
  settings.normals = NormalKind(bytes.below(3));
  settings.min_component = std::size_t(bytes.below(4)) * 2;
  const Volume volume = fuzz::small_volume(bytes, 4);
  settings.isovalue = fuzz::some_isovalue(bytes, volume);
  if (!std::isfinite(settings.isovalue)) return 0;  // which commands refuse
  if (fuzz::refused([&] { require_usable(volume); })) return 0;
  const std::optional<StoredVolume> stored = narrow(volume);
  for (const auto& [name, extractor] : backends) {
    settings.cap = CapKind::kNone;
    IsoMesh open = extractor->extract(volume, settings, fuzz::alone());
    check_open(open, volume, name);
    if (stored)
      require(laws::identical(open, extractor->extract(*stored, settings, fuzz::alone())),
              name + ": the voxels' type changes nothing");
    if (name == "marching_cubes") {
      IsoMesh swept;
      IsoExtractor(volume, fuzz::alone()).extract(settings, fuzz::alone(), swept);
      require(laws::identical(open, swept), "an index of bricks changes nothing");
    }
    settings.cap = CapKind::kBox;
    IsoMesh closed = extractor->extract(volume, settings, fuzz::alone());
    require(bool(laws::is_manifold(closed)), name + ": a capped mesh is 2-manifold");
    require(laws::boundary_edges(closed) == 0, name + ": a capped mesh is closed");
    require(bool(laws::normals_are_unit(closed)), name + ": normals of a cap are of unit length");
  }
  return 0;
}
