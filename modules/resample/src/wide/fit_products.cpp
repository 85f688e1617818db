// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/fit_products.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include <algorithm>

#include "wide/corners-inl.h"
#include "wide/eight-inl.h"
#include "wide/fit_products.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {

/// The trilinear weights of the corners: along each axis 1 - x at the lower ones, x at the upper ones.
template <class Real>
struct Weights {
  Several<Real, 8> base[3];
  Several<Real, 8> slope[3];

  HWY_INLINE Weights() {
    for (unsigned a = 0; a < 3; ++a) {
      HWY_ALIGN Real lower[8];
      HWY_ALIGN Real turn[8];
      for (unsigned q = 0; q < 8; ++q) {
        lower[q] = (q >> a & 1u) != 0 ? Real(0) : Real(1);
        turn[q] = (q >> a & 1u) != 0 ? Real(1) : Real(-1);
      }
      base[a] = load<8>(lower, Real());
      slope[a] = load<8>(turn, Real());
    }
  }
  [[nodiscard]] HWY_INLINE Several<Real, 8> at(const FitRow& row) const {
    const auto x = mul_add(all<Real, 8>(Real(row.place[0])), slope[0], base[0]);
    const auto y = mul_add(all<Real, 8>(Real(row.place[1])), slope[1], base[1]);
    const auto z = mul_add(all<Real, 8>(Real(row.place[2])), slope[2], base[2]);
    return mul(mul(x, y), z);
  }
};

/// Those with slopes, which are the second number.
template <std::size_t kNumbers>
inline constexpr bool kHasSlopes = kNumbers == 2 || kNumbers == FitTerms::kMost;

/// The isovalues of a cell's corners less its reference, from which the rows' count.
HWY_INLINE Several<float, 8> isovalues_of(const FitCells& cells, const Corners& corners) {
  return sub(corners.load_from(cells.isovalues), all<float, 8>(cells.isovalues[corners.first[0]]));
}

/// A cell's numbers, their light at a row, and the transpose of that. The isovalues from which slopes count are moved
/// into the values here, cell by cell: in the whole volume's isovalues small differences of light would be lost.
template <class Real, std::size_t kNumbers>
struct Cell {
  Several<Real, 8> number[kNumbers];

  HWY_INLINE Cell() {
    ISOLUX_UNROLL
    for (std::size_t k = 0; k < kNumbers; ++k) number[k] = all<Real, 8>(Real(0));
  }
  [[nodiscard]] HWY_INLINE Several<Real, 8> light(const FitRow& row) const {
    Several<Real, 8> sum = number[0];
    ISOLUX_UNROLL
    for (std::size_t k = 1; k < kNumbers; ++k) sum = mul_add(all<Real, 8>(Real(row.feature[k - 1])), number[k], sum);
    return sum;
  }
  HWY_INLINE void add_row(const FitRow& row, const Several<Real, 8>& weighted) {
    number[0] = add(number[0], weighted);
    ISOLUX_UNROLL
    for (std::size_t k = 1; k < kNumbers; ++k)
      number[k] = mul_add(all<Real, 8>(Real(row.feature[k - 1])), weighted, number[k]);
  }
  /// -isovalue * slope to the value, or the transpose.
  HWY_INLINE void move(std::size_t from, std::size_t to, const Several<Real, 8>& isovalue) {
    number[to] = sub(number[to], mul(isovalue, number[from]));
  }
};

template <std::size_t kNumbers>
HWY_INLINE Cell<float, kNumbers> gather(const FitCells& cells, const Corners& corners, const float* numbers) {
  Cell<float, kNumbers> cell;
  ISOLUX_UNROLL
  for (std::size_t k = 0; k < kNumbers; ++k) cell.number[k] = corners.load_from(numbers + k * cells.texel_count);
  return cell;
}

template <std::size_t kNumbers>
HWY_INLINE void scatter(const FitCells& cells, const Corners& corners, const Cell<float, kNumbers>& cell, float* sums) {
  ISOLUX_UNROLL
  for (std::size_t k = 0; k < kNumbers; ++k) corners.add_to(sums + k * cells.texel_count, cell.number[k]);
}

template <std::size_t kNumbers>
void product(const FitCells& cells, const float* numbers, const FitTermSums<float>& terms, float* sums,
             FitTermSums<double>& term_sums) {
  const Weights<float> weights;
  const auto from_terms = load<4>(terms.data(), 0.0f);
  auto to_terms = load<4>(term_sums.data(), 0.0);
  for (std::size_t c = 0; c < cells.count; ++c) {
    const std::size_t end = cells.starts[c + 1];
    if (cells.starts[c] == end) continue;
    const Corners corners(cells, c);
    auto from = gather<kNumbers>(cells, corners, numbers);
    if constexpr (kHasSlopes<kNumbers>) from.move(1, 0, isovalues_of(cells, corners));
    Cell<float, kNumbers> to;
    auto cell_terms = all<float, 4>(0.0f);
    for (std::size_t r = cells.starts[c]; r < end; ++r) {
      const FitRow& row = cells.rows[r];
      const auto w = weights.at(row);
      const auto openness = load<4>(row.openness.data(), 0.0f);
      const float read = cells.weights[r] * sum(mul_add(openness, from_terms, fold(mul(w, from.light(row)))));
      to.add_row(row, mul(w, all<float, 8>(read)));
      cell_terms = mul_add(openness, all<float, 4>(read), cell_terms);
    }
    if constexpr (kHasSlopes<kNumbers>) to.move(0, 1, isovalues_of(cells, corners));
    scatter(cells, corners, to, sums);
    to_terms = add(to_terms, promoted(cell_terms));
  }
  store(to_terms, term_sums.data());
}

template <std::size_t kNumbers>
void left(const FitCells& cells, const FitLight& light, const float* numbers, const FitTermSums<double>& terms,
          float* sums, FitTermSums<double>& term_sums, float* follows) {
  const Weights<double> weights;
  const auto from_terms = load<4>(terms.data(), 0.0);
  auto to_terms = load<4>(term_sums.data(), 0.0);
  const auto low = double(light.low);
  const auto high = double(light.high);
  for (std::size_t c = 0; c < cells.count; ++c) {
    const std::size_t end = cells.starts[c + 1];
    if (cells.starts[c] == end) continue;
    const Corners corners(cells, c);
    const auto floats = gather<kNumbers>(cells, corners, numbers);
    Cell<double, kNumbers> from;
    ISOLUX_UNROLL
    for (std::size_t k = 0; k < kNumbers; ++k) from.number[k] = promoted(floats.number[k]);
    if constexpr (kHasSlopes<kNumbers>) from.move(1, 0, promoted(isovalues_of(cells, corners)));
    Cell<double, kNumbers> to;
    for (std::size_t r = cells.starts[c]; r < end; ++r) {
      const FitRow& row = cells.rows[r];
      const auto w = weights.at(row);
      const auto openness = load<4>(row.openness.data(), 0.0);
      const double read = sum(mul_add(openness, from_terms, fold(mul(w, from.light(row)))));
      const float weight = cells.weights[r];
      follows[r] = read > low && read < high ? weight : light.clamped_part * weight;
      const double error =
          double(weight) * (double(light.light[light.samples[r] * light.stride]) - std::clamp(read, low, high));
      to.add_row(row, mul(w, all<double, 8>(error)));
      to_terms = mul_add(openness, all<double, 4>(error), to_terms);
    }
    if constexpr (kHasSlopes<kNumbers>) to.move(0, 1, promoted(isovalues_of(cells, corners)));
    Cell<float, kNumbers> demoted_to;
    ISOLUX_UNROLL
    for (std::size_t k = 0; k < kNumbers; ++k) demoted_to.number[k] = demoted(to.number[k]);
    scatter(cells, corners, demoted_to, sums);
  }
  store(to_terms, term_sums.data());
}

template <std::size_t kNumbers>
void moments(const FitCells& cells, const FitCentres& centres, float* sums,
             std::array<FitTermSums<double>, 4>& term_sums) {
  constexpr std::size_t kPairs = kNumbers * (kNumbers + 1) / 2;
  constexpr std::size_t kFirstNormal = kHasSlopes<kNumbers> ? 2 : 1;
  const Weights<float> weights;
  for (std::size_t c = 0; c < cells.count; ++c) {
    const std::size_t end = cells.starts[c + 1];
    if (cells.starts[c] == end) continue;
    const Corners corners(cells, c);
    Several<float, 8> centre[kNumbers];
    Several<float, 8> breadth;
    if constexpr (kHasSlopes<kNumbers>) {
      centre[1] = isovalues_of(cells, corners);
      breadth = corners.load_from(centres.inverse_breadths);
    }
    ISOLUX_UNROLL
    for (std::size_t k = kFirstNormal; k < kNumbers; ++k)
      centre[k] = corners.load_from(centres.normals[k - kFirstNormal]);
    Several<float, 8> pairs[kPairs];
    ISOLUX_UNROLL
    for (std::size_t i = 0; i < kPairs; ++i) pairs[i] = all<float, 8>(0.0f);
    Several<float, 4> terms[4];
    ISOLUX_UNROLL
    for (std::size_t t = 0; t < 4; ++t) terms[t] = all<float, 4>(0.0f);
    for (std::size_t r = cells.starts[c]; r < end; ++r) {
      const FitRow& row = cells.rows[r];
      const auto w = weights.at(row);
      Several<float, 8> feature[kNumbers];
      feature[0] = all<float, 8>(1.0f);
      ISOLUX_UNROLL
      for (std::size_t k = 1; k < kNumbers; ++k) feature[k] = sub(all<float, 8>(row.feature[k - 1]), centre[k]);
      if constexpr (kHasSlopes<kNumbers>) feature[1] = mul(feature[1], breadth);
      const auto both = mul(mul(w, w), all<float, 8>(cells.weights[r]));
      std::size_t pair = 0;
      ISOLUX_UNROLL
      for (std::size_t j = 0; j < kNumbers; ++j) {
        const auto weighted = mul(both, feature[j]);
        ISOLUX_UNROLL
        for (std::size_t k = j; k < kNumbers; ++k, ++pair) pairs[pair] = mul_add(weighted, feature[k], pairs[pair]);
      }
      const auto openness = load<4>(row.openness.data(), 0.0f);
      ISOLUX_UNROLL
      for (std::size_t t = 0; t < 4; ++t)
        terms[t] = mul_add(openness, all<float, 4>(cells.weights[r] * row.openness[t]), terms[t]);
    }
    ISOLUX_UNROLL
    for (std::size_t i = 0; i < kPairs; ++i) corners.add_to(sums + i * cells.texel_count, pairs[i]);
    for (std::size_t t = 0; t < 4; ++t)
      store(add(load<4>(term_sums[t].data(), 0.0), promoted(terms[t])), term_sums[t].data());
  }
}

template <std::size_t kNumbers>
FitKernels kernels_of() {
  return {.product = product<kNumbers>, .left = left<kNumbers>, .moments = moments<kNumbers>};
}

FitKernels kernels(std::size_t numbers) {
  switch (numbers) {
    case 1:
      return kernels_of<1>();
    case 2:
      return kernels_of<2>();
    case 4:
      return kernels_of<4>();
    default:
      return kernels_of<FitTerms::kMost>();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(kernels);

FitKernels fit_kernels(std::size_t numbers) { return HWY_DYNAMIC_DISPATCH(kernels)(numbers); }

}  // namespace isolux::wide
#endif
