#include "local_fit.h"

#include <cmath>

namespace isolux {

template <std::size_t kCoordinates>
void LocalFit<kCoordinates>::add(double weight, const Coordinates& at, const float* values, std::size_t channels) {
  std::array<double, kUnknowns> row{1.0};
  for (std::size_t i = 0; i < kCoordinates; ++i) row[i + 1] = at[i];
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weight * row[i] * row[j];
    for (std::size_t c = 0; c < channels; ++c) right_[i][c] += weight * row[i] * double(values[c]);
  }
}

template <std::size_t kCoordinates>
auto LocalFit<kCoordinates>::at_origin(double ridge, float* values, std::size_t channels) const -> Influence {
  // Slopes are eliminated first, so that what is left in the last row is the value's own equation. The light is taken
  // relative to its mean, which keeps constants exact.
  const double total = matrix_[0][0];
  std::array<double, 3> mean{};
  for (std::size_t c = 0; c < channels; ++c) mean[c] = right_[0][c] / total;

  constexpr std::size_t kSlopes = kCoordinates;
  std::array<std::array<double, kUnknowns>, kUnknowns> a{};
  std::array<std::array<double, 3>, kUnknowns> b{};
  double spread = 0.0;
  for (std::size_t i = 0; i < kSlopes; ++i) spread += matrix_[i + 1][i + 1];
  const double held = ridge * spread / double(kSlopes) + 1e-30 * total;
  const auto entry = [&](std::size_t i, std::size_t j) { return i < j ? matrix_[j][i] : matrix_[i][j]; };
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const std::size_t from = (i + 1) % kUnknowns;
    for (std::size_t j = 0; j < kUnknowns; ++j) a[i][j] = entry(from, (j + 1) % kUnknowns);
    for (std::size_t c = 0; c < channels; ++c) b[i][c] = right_[from][c] - matrix_[from][0] * mean[c];
    if (i < kSlopes) a[i][i] += held;
  }
  for (std::size_t c = 0; c < channels; ++c) b[kSlopes][c] = 0.0;
  for (std::size_t p = 0; p < kSlopes; ++p) {
    // Positive by the ridge, unless every sample sits at the origin.
    if (!(a[p][p] > 0.0)) continue;
    for (std::size_t i = p + 1; i < kUnknowns; ++i) {
      const double factor = a[i][p] / a[p][p];
      for (std::size_t j = p; j < kUnknowns; ++j) a[i][j] -= factor * a[p][j];
      for (std::size_t c = 0; c < channels; ++c) b[i][c] -= factor * b[p][c];
    }
  }
  const double pivot = a[kSlopes][kSlopes];
  const bool sound = pivot > 1e-6 * total;
  for (std::size_t c = 0; c < channels; ++c) values[c] = float(mean[c] + (sound ? b[kSlopes][c] / pivot : 0.0));
  Influence influence{.there = 1.0 / (sound ? pivot : total)};
  if (!sound) return influence;
  // The matrix's inverse times the value's unit vector, of which elimination has left the last row alone.
  for (std::size_t p = kSlopes; p-- > 0;) {
    if (!(a[p][p] > 0.0)) continue;
    double sum = a[p][kSlopes] * influence.there;
    for (std::size_t j = p + 1; j < kSlopes; ++j) sum += a[p][j] * influence.slopes[j];
    influence.slopes[p] = -sum / a[p][p];
  }
  return influence;
}

template class LocalFit<4>;
template class LocalFit<10>;

}  // namespace isolux
