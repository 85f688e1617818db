#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/mc_extract/indexed_mesh.h>

#include <memory>

namespace isolux {

/// Marching cubes for many isovalues of one volume: the same surface as the backend marching_cubes, with everything
/// kept that can be kept. An index of the values of small bricks lets each extraction read only what a small level set
/// passes through; buffers and the memory of the mesh that is written to serve again. Not for use from several threads
/// at once.
class IsoExtractor {
 public:
  /// What to make beforehand, memory for speed. The surface is the same bit for bit.
  enum class Index : std::uint8_t {
    /// An index of bricks, made in one pass that costs about one extraction: 1/128 of the volume's memory.
    kBricks,
    /// The same, and a copy in bytes where all values are whole numbers from 0 to 255 and there is memory for it (else
    /// nothing more): a quarter of the volume's memory, for a sixth to a quarter less time an isovalue.
    kBricksAndBytes,
    /// The same, and where bytes do not do a copy in 16 bits of whole numbers from -32768 to 32767: half of the
    /// volume's memory, for a tenth to a sixth less time an isovalue.
    kBricksAndShorts,
    /// Nothing: for a single isovalue.
    kNone
  };

  /// Keeps a reference to `volume`. \pre require_usable(volume). \throw InvalidInput if two planes of the volume have
  /// more than 2^30 grid points or an axis more than 65536.
  explicit IsoExtractor(const Volume& volume, const Run& run = {}, Index index = Index::kBricks);
  ~IsoExtractor();
  IsoExtractor(IsoExtractor&& other) noexcept;
  IsoExtractor& operator=(IsoExtractor&& other) noexcept;

  /// The level set into `mesh`, whose memory is used again where it is large enough. Nothing else of it is kept.
  /// \throw Cancelled; InvalidInput if it would not fit 2^31 triangle corners, or 2^31 half-edges. The mesh is then in
  /// no useful state. Every field of the settings is honoured, but `min_component` and `cap` cost a rebuilding.
  void extract(const ExtractSettings& settings, const Run& run, IndexedMesh& mesh);
  void extract(const ExtractSettings& settings, const Run& run, IsoMesh& mesh);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace isolux
