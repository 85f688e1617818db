#include <isolux/mc_extract/iso_extractor.h>

namespace isolux {

namespace {

/// Marching cubes (Lorensen & Cline 1987) with a case table made by rule so that the result is always a manifold; by
/// rows, as fast as memory allows: see IsoExtractor, which also serves again.
class MarchingCubes final : public Extractor {
 public:
  using Options = NoOptions;
  explicit MarchingCubes(const Options& /*options*/) {}

  [[nodiscard]] IsoMesh extract(const VolumeView& volume, const ExtractSettings& settings,
                                const Run& run) const override {
    IsoMesh mesh;
    IsoExtractor(volume, run, IsoExtractor::Index::kNone).extract(settings, run, mesh);
    return mesh;
  }
};

}  // namespace

namespace backends {
void marching_cubes(Registry<Extractor>& registry) {
  registry.add<MarchingCubes>("marching_cubes",
                              "marching cubes, consistent on ambiguous faces: always a manifold; fast");
}
}  // namespace backends

}  // namespace isolux
