#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "fit_blocks.h"
#include "fit_rows.h"
#include "fit_texels.h"
#include "fit_vector.h"

namespace isolux {

/// How much a fit holds each of a texel's numbers to its prior, in samples; in the order of FitTerms.
using FitDamping = std::array<double, FitTerms::kMost>;

/// One channel of the samples' light.
struct FitChannel {
  const float* first = nullptr;  ///< the first sample's
  std::size_t stride = 1;        ///< from one sample's to the next one's
};

/// What a fit leaves, seen from where it stands.
struct FitRest {
  FitVector gradient;          ///< A^T W (light - reading) less what damping pulls back
  std::vector<float> weights;  ///< W of each row, small where the reading is clamped and does not follow the unknowns
};

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
  [[nodiscard]] FitVector prior(const FitChannel& light, std::vector<float>& coverage) const;
  /// What prior + x leaves of the samples, read as light within `bounds`.
  [[nodiscard]] FitRest rest(const FitChannel& light, const FitVector& prior, const FitVector& x,
                             const FitDamping& damping, const ValueRange& bounds) const;
  /// y = (A^T W A + damping) x. `moved` is room for work; that and y's are kept from call to call.
  void normal_product(const FitVector& x, const FitDamping& damping, std::span<const float> weights, FitVector& y,
                      std::vector<float>& moved) const;
  /// The inverses of the blocks of A^T W A + damping.
  [[nodiscard]] FitBlocks inverse_blocks(const FitDamping& damping, std::span<const float> weights) const;

  [[nodiscard]] const FitTexels& texels() const { return *texels_; }
  [[nodiscard]] const FitTerms& terms() const { return texels_->terms(); }
  [[nodiscard]] const FitRows& rows() const { return *rows_; }

 private:
  using Terms = FitRows::Terms;

  /// Calls visit(cells, layer) for every row of cells along x, with rows of these weights.
  template <class Visit>
  void for_each_line(std::span<const float> weights, const Visit& visit) const;
  /// Means of value(row) over the rows around each texel, by the weights with which they read it; their sums.
  template <class Value>
  [[nodiscard]] std::vector<float> texel_means(const Value& value, std::vector<float>& coverage) const;
  /// From what the kernels leave to a vector: adds the layers' terms in order, and sign * damping * the texels' weights
  /// * x.
  void finish(const std::vector<Terms>& layers, float sign, const FitDamping& damping, const FitVector& x,
              FitVector& y) const;

  wide::FitKernels kernels_;
  const Run& run_;
  std::optional<FitTexels> texels_;
  std::optional<FitRows> rows_;
  std::vector<float> texel_weights_;  ///< mean weight of each texel's rows, weighted as the reading does
};

}  // namespace isolux
