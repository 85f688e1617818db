#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isolux {

/// What a fit says of a texel beside its value.
struct FitTerms {
  bool slopes = false;   ///< how its light changes with the isovalue
  bool normals = false;  ///< and with the three components of the normal

  static constexpr std::size_t kMost = 5;
  /// Numbers a texel: the value, the slope, x, y and z, as far as they are there.
  [[nodiscard]] std::size_t count() const { return first_normal() + (normals ? 3 : 0); }
  [[nodiscard]] std::size_t first_normal() const { return slopes ? 2 : 1; }
};

/// Where a sample lies in a cell of texels, 0 to 1, and what the terms are multiplied with there: 1, the isovalue less
/// the cell's reference, and the normal, in the order of FitTerms.
struct FitPoint {
  std::array<float, 3> place;
  std::array<float, FitTerms::kMost> feature;
};

template <class Real>
using PerCorner = std::array<Real, 8>;

/// The trilinear weights of a cell's corners.
inline PerCorner<float> corner_weights(const std::array<float, 3>& place) {
  const std::array<float, 4> xy = {(1.0f - place[0]) * (1.0f - place[1]), place[0] * (1.0f - place[1]),
                                   (1.0f - place[0]) * place[1], place[0] * place[1]};
  PerCorner<float> w{};
  for (unsigned q = 0; q < 4; ++q) {
    w[q] = xy[q] * (1.0f - place[2]);
    w[q + 4] = xy[q] * place[2];
  }
  return w;
}

/// Light in one cell as the samples see it: sum over features of feature * (sum over corners of weight * number). The
/// corners' own isovalues and normals, from which a texel's slope and normal terms count, are moved into the values, so
/// that they are not asked for at every sample.
template <class Real>
class CellLight {
 public:
  explicit CellLight(std::size_t count) : count_(count) {}

  [[nodiscard]] Real read(const FitPoint& at, const PerCorner<float>& w) const {
    PerCorner<Real> light = numbers_[0];
    for (std::size_t k = 1; k < count_; ++k)
      for (unsigned q = 0; q < 8; ++q) light[q] += Real(at.feature[k]) * numbers_[k][q];
    // Four sums side by side, which fit a vector.
    std::array<Real, 4> parts{};
    for (unsigned q = 0; q < 4; ++q) parts[q] = Real(w[q]) * light[q] + Real(w[q + 4]) * light[q + 4];
    return (parts[0] + parts[1]) + (parts[2] + parts[3]);
  }
  /// The transpose of read().
  void add(const FitPoint& at, const PerCorner<float>& w, Real amount) {
    PerCorner<Real> light{};
    for (unsigned q = 0; q < 8; ++q) light[q] = Real(w[q]) * amount;
    for (unsigned q = 0; q < 8; ++q) numbers_[0][q] += light[q];
    for (std::size_t k = 1; k < count_; ++k)
      for (unsigned q = 0; q < 8; ++q) numbers_[k][q] += Real(at.feature[k]) * light[q];
  }

  [[nodiscard]] PerCorner<Real>& operator[](std::size_t number) { return numbers_[number]; }
  [[nodiscard]] const PerCorner<Real>& operator[](std::size_t number) const { return numbers_[number]; }

 private:
  std::array<PerCorner<Real>, FitTerms::kMost> numbers_{};
  std::size_t count_;
};

/// The eight texels around a cell of texels, by their numbers among those used, and from where their terms count.
struct FitCorners {
  std::array<std::uint32_t, 8> texel{};
  float reference = 0.0f;       ///< an isovalue of the cell
  PerCorner<float> isovalue{};  ///< less the reference
  PerCorner<float> inverse_breadth{};
  std::array<PerCorner<float>, 3> normal{};

  /// From `numbers` of all texels, FitTerms::count() each.
  template <class Real>
  [[nodiscard]] CellLight<Real> gather(const FitTerms& terms, const float* numbers) const {
    CellLight<Real> cell(terms.count());
    for (unsigned q = 0; q < 8; ++q) {
      const float* from = numbers + std::size_t(texel[q]) * terms.count();
      Real value(from[0]);
      if (terms.slopes) {
        cell[1][q] = Real(inverse_breadth[q]) * Real(from[1]);
        value -= Real(isovalue[q]) * cell[1][q];
      }
      for (std::size_t a = 0; terms.normals && a < 3; ++a) {
        const std::size_t k = terms.first_normal() + a;
        cell[k][q] = Real(from[k]);
        value -= Real(normal[a][q]) * cell[k][q];
      }
      cell[0][q] = value;
    }
    return cell;
  }

  /// The transpose of gather(), added to all texels' numbers.
  template <class Real>
  void scatter(const FitTerms& terms, const CellLight<Real>& cell, float* numbers) const {
    for (unsigned q = 0; q < 8; ++q) {
      float* to = numbers + std::size_t(texel[q]) * terms.count();
      const Real value = cell[0][q];
      to[0] += float(value);
      if (terms.slopes) to[1] += float(Real(inverse_breadth[q]) * (cell[1][q] - Real(isovalue[q]) * value));
      for (std::size_t a = 0; terms.normals && a < 3; ++a) {
        const std::size_t k = terms.first_normal() + a;
        to[k] += float(cell[k][q] - Real(normal[a][q]) * value);
      }
    }
  }

  /// What number k of corner q counts at a sample, its trilinear weight aside.
  [[nodiscard]] float factor(const FitTerms& terms, const FitPoint& at, std::size_t k, unsigned q) const {
    if (k == 0) return 1.0f;
    if (terms.slopes && k == 1) return (at.feature[1] - isovalue[q]) * inverse_breadth[q];
    return at.feature[k] - normal[k - terms.first_normal()][q];
  }
};

}  // namespace isolux
