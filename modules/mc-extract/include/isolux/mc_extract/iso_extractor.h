#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>

#include <memory>

namespace isolux {

/// Marching cubes for many isovalues of one volume: the same surface as the backend marching_cubes, with everything
/// kept that can be kept. An index of the values of small bricks (made once, in one pass, 1/128 of the volume's memory)
/// lets each extraction read only what the level set passes through; its buffers and the memory of the mesh that is
/// written to serve again. Of a volume of whole numbers from 0 to 255 the index comes with a copy in bytes (a quarter
/// of the volume's memory), which is read in its place. Not for use from several threads at once.
class IsoExtractor {
 public:
  /// Whether to make the index: it costs about one extraction, so leave it out for a single isovalue.
  enum class Index : std::uint8_t { kBricks, kNone };

  /// Keeps a reference to `volume`. \pre require_usable(volume). \throw InvalidInput if two planes of the volume have
  /// more than 2^30 grid points or an axis more than 65536.
  explicit IsoExtractor(const Volume& volume, const Run& run = {}, Index index = Index::kBricks);
  ~IsoExtractor();
  IsoExtractor(IsoExtractor&& other) noexcept;
  IsoExtractor& operator=(IsoExtractor&& other) noexcept;

  /// The level set into `mesh`, whose memory is used again where it is large enough. Nothing else of it is kept.
  /// \throw Cancelled (the mesh is then in no useful state); InvalidInput if it would not fit 2^31 triangle corners, or
  /// 2^31 half-edges. Every field of the settings is honoured, but `min_component` and `cap` cost a rebuilding.
  void extract(const ExtractSettings& settings, const Run& run, IndexedMesh& mesh);
  void extract(const ExtractSettings& settings, const Run& run, IsoMesh& mesh);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace isolux
