#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "fit_texels.h"
#include "near_field.h"

namespace isolux {

/// Steps of the near-field terms, in mean grid spacings: one and two are as much as reads fast (docs/resampling.md).
inline constexpr std::array<double, 4> kNearFieldSteps = {0.5, 1.0, 2.0, 4.0};

/// What a fit solves for, or any vector of that shape: FitTerms::count() numbers for each texel used and a few weights
/// for all.
struct FitVector {
  std::vector<float> numbers;                          ///< slopes per unit of the texels' breadths
  std::array<double, kNearFieldSteps.size()> terms{};  ///< zero without near field
};

/// How much a fit holds each of a texel's numbers to its prior, in samples; in the order of FitTerms.
using FitDamping = std::array<double, FitTerms::kMost>;

/// What a fit leaves, seen from where it stands.
struct FitRest {
  FitVector gradient;          ///< A^T W (light - reading) less what damping pulls back
  std::vector<float> weights;  ///< W of each row, small where the reading is clamped and does not follow the unknowns
};

enum class NearFieldUse { kNone, kFitted };

/// The least squares problem of texels that, read as LightReader does, give the samples: A is the reading but for its
/// clamping, one row a sample. Rows weigh as the root of the field's steepness, so that level sets count by their area
/// where they lie dense, if less than by all of it; damping weighs as a texel's own rows.
/// Rows are kept by cell of the texel lattice and A is never formed. Products are summed in a fixed order: cells of one
/// layer after another, even layers before odd ones, which write apart.
class FitSystem {
 public:
  FitSystem(const Volume& volume, const SampleSet& samples, const Lattice& texels, const FitTerms& terms,
            NearFieldUse near_field, const Run& run);

  [[nodiscard]] FitVector zero() const;
  /// Mean light of the samples around each texel, weighted as the reading does, as the values of a vector. Where
  /// `coverage` is 0, no sample is.
  [[nodiscard]] FitVector prior(std::span<const float> light, std::vector<float>& coverage) const;
  /// What prior + x leaves of the samples, read as light within `bounds`.
  [[nodiscard]] FitRest rest(std::span<const float> light, const FitVector& prior, const FitVector& x,
                             const FitDamping& damping, const ValueRange& bounds) const;
  /// (A^T W A + damping) x.
  [[nodiscard]] FitVector normal_product(const FitVector& x, const FitDamping& damping,
                                         std::span<const float> weights) const;
  /// The diagonal of A^T W A + damping.
  [[nodiscard]] FitVector diagonal(const FitDamping& damping, std::span<const float> weights) const;

  [[nodiscard]] const FitTexels& texels() const { return *texels_; }
  [[nodiscard]] const FitTerms& terms() const { return terms_; }
  /// Mean openness over the samples.
  [[nodiscard]] const std::array<double, kNearFieldSteps.size()>& mean_openness() const { return mean_openness_; }
  [[nodiscard]] std::span<const double> steps() const { return steps_; }

 private:
  struct Row {
    FitPoint at;
    std::array<float, kNearFieldSteps.size()> openness;  ///< less the mean
    float weight;
    std::uint32_t sample;
  };

  void sort_rows(const Volume& volume, const SampleSet& samples, const Lattice& texels, const Run& run);
  /// Weights of the rows, their features, and their openness where it is fitted.
  void measure(const Volume& volume, const SampleSet& samples, const Run& run);
  void centre_rows(const std::array<double, kNearFieldSteps.size() + 1>& sums);
  void weigh_texels();
  /// damping * the texels' weights * x, or those alone.
  [[nodiscard]] FitVector damped(const FitDamping& damping, const FitVector* x) const;
  /// Calls visit(corners, rows, first row's number, layer) for every cell with rows.
  template <class Visit>
  void for_each_cell(const Visit& visit) const;
  /// Means of value(row) over the rows around each texel, by the weights with which they read it; their sums.
  template <class Value>
  [[nodiscard]] std::vector<float> texel_means(const Value& value, std::vector<float>& coverage) const;
  /// Adds per-layer sums of the near-field terms in order.
  [[nodiscard]] std::array<double, kNearFieldSteps.size()> sum_layers(
      const std::vector<std::array<double, kNearFieldSteps.size()>>& layers) const;

  FitTerms terms_;
  NearFieldUse near_field_;
  const Run& run_;
  std::vector<std::uint32_t> starts_;  ///< of each cell's rows, and the end
  std::vector<Row> rows_;
  std::optional<FitTexels> texels_;
  std::vector<float> texel_weights_;  ///< mean weight of each texel's rows, weighted as the reading does
  std::array<double, kNearFieldSteps.size()> mean_openness_{};
  std::array<double, kNearFieldSteps.size()> steps_ = kNearFieldSteps;
};

}  // namespace isolux
