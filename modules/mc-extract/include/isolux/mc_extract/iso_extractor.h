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
  /// What to make beforehand. The surface is the same bit for bit.
  enum class Index : std::uint8_t {
    /// An index of bricks, made in one pass that costs about one extraction: 1/128 of the memory of a volume in floats,
    /// 1/32 of one in bytes.
    kBricks,
    /// Nothing: for a single isovalue.
    kNone
  };

  /// Looks at `volume`, which must stay where it is. In bytes a volume costs a sixth to a third less time an isovalue
  /// than in floats. \pre require_usable(volume). \throw InvalidInput if a plane of the volume
  /// has more than 2^29 grid points, or more than 65536 along x or y; along z there may be any number.
  explicit IsoExtractor(const VolumeView& volume, const Run& run = {}, Index index = Index::kBricks);
  explicit IsoExtractor(Volume&& volume, const Run& run = {}, Index index = Index::kBricks) = delete;
  explicit IsoExtractor(StoredVolume&& volume, const Run& run = {}, Index index = Index::kBricks) = delete;
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
