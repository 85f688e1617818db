#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/run.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cell_level.h"

namespace isolux {

/// What is known of the light in a cell between traced texels, from their differences from their surroundings.
struct CellFigures {
  double roughness = 0.0;  ///< mean squared difference of light, without noise, from its mean over a neighbourhood
  double noise = 0.0;      ///< variance of that difference by the rays' noise

  /// How much of the difference is light: Wiener's filter.
  [[nodiscard]] double kept() const { return roughness > 0.0 ? roughness / (roughness + noise) : 0.0; }
};

/// Light that is traced at some texels and predicted between them. The texels are cut into cells of 4^3 texels, whose
/// corners are traced; a refined cell falls apart into eight, down to single texels. A traced value is the mean over
/// its surroundings, which takes noise out, and as much of its difference from that mean as is not noise; pairs of
/// opposite neighbours keep linear light as it is. Between the corners of a cell light is interpolated trilinearly.
class TexelPyramid {
 public:
  static constexpr int kLevels = 3;
  static constexpr int stride(int level) { return 4 >> level; }

  /// Light of the traced texels, in the order of texels().
  struct Traced {
    std::span<const float> light;  ///< `channels` a texel
    std::span<const float> variance;
    std::span<const std::uint32_t> rays;
  };
  struct Cell {
    int level = 0;
    Index3 at{0};
  };

  /// Which of some texels, rising, can be lit: one flag each.
  using FindLit = std::function<std::vector<std::uint8_t>(std::span<const std::size_t> texels)>;

  /// Cells with a corner that cannot be lit are refined at once. Only corners of cells are asked for: what lies between
  /// lit ones counts as lit.
  TexelPyramid(const Lattice& texels, int channels, FindLit find_lit);

  /// Texels that have come to be wanted since the last call, rising; from now on the last ones of texels().
  [[nodiscard]] std::vector<std::size_t> wanted();
  /// The traced texels, by when they were wanted.
  [[nodiscard]] std::span<const std::uint32_t> texels() const { return traced_texels_; }
  void refine(std::span<const Cell> cells);
  /// Every texel that can be lit is wanted; there are no cells any more, and light stays as it was traced.
  void refine_all();
  [[nodiscard]] bool is_all_traced() const { return is_all_traced_; }
  /// Flags of the texels that have light, or will have.
  [[nodiscard]] std::vector<std::uint8_t> lit() const;

  /// Figures anew, from light of all texels(), which must live until the next time.
  void update(const Traced& traced, const Run& run);
  [[nodiscard]] const Traced& traced() const { return traced_; }
  /// The cells that are not refined, in a fixed order.
  void for_each_cell(const std::function<void(const Cell&, const CellFigures&)>& visit) const;
  /// The traced texels by their place in texels(), with the level of the finest cell around and figures: roughness as
  /// of the cells around, noise half of them and half its own. Cost: some .1 microseconds a texel, on all threads but
  /// for the visits.
  void for_each_traced(const Run& run,
                       const std::function<void(std::size_t place, int level, const CellFigures&)>& visit) const;
  /// Cells of a level by number.
  [[nodiscard]] std::uint32_t number_of(const Cell& cell) const {
    return levels_[std::size_t(cell.level)].number(cell.at);
  }
  [[nodiscard]] Cell cell_of(int level, std::uint32_t number) const;
  /// At every texel `figure` of the cell that it lies in, of the one above it if on a face.
  [[nodiscard]] std::vector<float> of_cells(const std::function<float(const Cell&, const CellFigures&)>& figure) const;
  /// The corner texels of a cell.
  [[nodiscard]] std::array<std::size_t, 8> corners(const Cell& cell) const;
  [[nodiscard]] std::size_t texels_of(const Cell& cell) const;

  /// Light of all lit texels, `channels` each.
  [[nodiscard]] std::vector<float> light(const Run& run) const;
  /// Completes the labels of the traced texels: a predicted texel gets that of a corner of its cell, drawn by the
  /// weight that the corner has in the prediction, so that on average over texels the corners' values are the
  /// prediction. Texels that cannot be lit get the label of a nearest one.
  void draw_labels(std::span<std::uint32_t> labels, std::uint64_t seed, const Run& run) const;

 private:
  using Figures = CellLevel::Figures;

  static constexpr std::size_t kBlock = 8192;  ///< texels or cells a task

  /// What numbers_ holds of texels that have no place in texels() (yet).
  enum Site : std::uint32_t { kUnknown = 0xFFFFFFFFu, kUnlit = kUnknown - 1, kLit = kUnknown - 2 };

  [[nodiscard]] bool is_lit(std::size_t texel) const {
    return numbers_[texel] != kUnlit && numbers_[texel] != kUnknown;
  }
  void find_sites(std::vector<std::size_t> unknown);
  void ask(std::span<const Cell> cells);
  [[nodiscard]] bool has_all_corners(const Cell& cell) const;
  void add_children(const Cell& cell, std::vector<Cell>& children);
  void want(std::size_t texel, int level);
  void make_leaves(std::span<const Cell> cells);
  [[nodiscard]] Index3 first_texel(const Cell& cell) const;
  [[nodiscard]] Index3 last_texel(const Cell& cell) const;
  template <class Visit>
  void for_each_texel(const Cell& cell, const Visit& visit) const;
  void differ(std::size_t place);
  void sum_corners(int level, std::size_t place);
  void sum_neighbours(int level, std::size_t place);
  [[nodiscard]] CellFigures figures_at(std::size_t texel) const;
  [[nodiscard]] bool is_predicted(std::size_t texel) const { return level_[texel] < 0 && numbers_[texel] != kUnlit; }
  void predict(const Cell& cell, std::vector<float>& light) const;
  /// Calls visit for the cells that predict texels, on all threads.
  void for_each_predicting(const Run& run, const std::function<void(const Cell&)>& visit) const;

  Lattice texels_;
  std::size_t channels_;
  FindLit find_lit_;
  std::vector<std::uint32_t> numbers_;  ///< of a texel, its place in texels(), or a Site
  std::vector<std::int8_t> level_;      ///< finest of the cells around a texel; -1: not traced
  std::vector<std::size_t> wanted_;
  std::vector<std::uint32_t> traced_texels_;
  std::array<CellLevel, kLevels> levels_;
  bool is_all_traced_ = false;
  Traced traced_;
  std::vector<float> difference_;  ///< of traced texels, from the surroundings
  std::vector<float> noise_;       ///< its variance
};

}  // namespace isolux
