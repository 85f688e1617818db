#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cell_places.h"
#include "fit_texels.h"
#include "near_field.h"

namespace isolux {

enum class NearFieldUse { kNone, kFitted };

/// The samples of a fit by the cells of texels they lie in, as its products read them.
class FitRows {
 public:
  using Terms = std::array<double, kNearFieldSteps.size()>;

  FitRows(const Volume& volume, const SampleSet& samples, const TexelCells& cells, CellOrder order,
          const FitTexels& texels, NearFieldUse near_field, const Run& run);

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  /// Numbers of each cell's first row, and the end.
  [[nodiscard]] std::span<const std::uint32_t> starts() const { return starts_; }
  [[nodiscard]] const FitRow* data() const { return rows_.get(); }
  /// Numbers of the rows' samples.
  [[nodiscard]] std::span<const std::uint32_t> samples() const { return samples_; }
  /// The root of the field's steepness there, if it is no spike's; one in the mean.
  [[nodiscard]] std::span<const float> weights() const { return weights_; }
  /// Of the near-field terms, with the sign of the outer side.
  [[nodiscard]] const Terms& steps() const { return steps_; }
  [[nodiscard]] const Terms& mean_openness() const { return mean_openness_; }

 private:
  void measure(const NearField& near_field, const SampleSet& samples, const TexelCells& cells, const FitTexels& texels,
               NearFieldUse use, const Run& run);
  /// From the terms' openness, of all rows together, to its mean, and from steepness to weights.
  void centre(const Terms& openness, const Run& run);

  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> samples_;
  std::unique_ptr<FitRow[]> rows_;
  std::vector<float> weights_;
  Terms steps_ = kNearFieldSteps;
  Terms mean_openness_{};
};

}  // namespace isolux
