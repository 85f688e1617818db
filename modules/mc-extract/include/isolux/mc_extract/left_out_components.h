#pragma once

#include <isolux/mc_extract/iso_extractor.h>

#include <array>
#include <cstddef>
#include <vector>

namespace isolux {

/// Which places of a level set lie on the components that ExtractSettings::min_component leaves out of its mesh: for
/// what shows the level set itself. Components and their triangles are those of marching cubes, a cap's included where
/// there is one; where one that is left out comes near another, the nearest triangle tells. A place without a triangle
/// in any cell that it touches is on none of them and left out, too: on plateaus of the isovalue the level set is a
/// solid. Immutable, callable from many threads.
class LeftOutComponents {
 public:
  /// `extractor` is one of the volume that `lattice` is of. Cost: an extraction, and some 100 bytes for each triangle
  /// that is left out. \throw as IsoExtractor::extract
  LeftOutComponents(IsoExtractor& extractor, const Lattice& lattice, const ExtractSettings& settings, const Run& run);

  /// Whether a place (index space) on the level set or its cap is left out. Cost: a bit to look up away from what is
  /// left out.
  [[nodiscard]] bool contain(const Vec3& index) const;
  /// Whether there are components, and none is large enough.
  [[nodiscard]] bool leaves_nothing() const;

 private:
  /// A triangle in one of the cells that it touches.
  struct Piece {
    std::size_t cell;
    std::array<Vec3f, 3> corners;  ///< index space
    bool left_out;
  };
  struct CellRange;
  [[nodiscard]] CellRange cells_at(const Vec3& index) const;
  [[nodiscard]] std::array<Vec3f, 3> corners_of(const IndexedMesh& mesh, const Triangle& triangle) const;

  Lattice lattice_;
  Vec3 reach_;                 ///< how far from a cell, along each axis, a place still touches it
  std::vector<bool> kept_;     ///< for each cell whether it holds what is kept
  std::vector<bool> nearby_;   ///< whether it or one next to it holds what is left out
  std::vector<Piece> pieces_;  ///< of these cells, by their numbers
};

}  // namespace isolux
