#include "fit_blocks.h"

#include <isolux/core/parallel.h>

#include <algorithm>

namespace isolux {
namespace {

constexpr std::size_t kBlocksTogether = 4096;
/// Of its diagonal element: below that a pivot is what rounding left of it.
constexpr double kLeastPivot = 1e-6;

template <std::size_t kSize>
using Square = std::array<std::array<double, kSize>, kSize>;

/// The symmetric matrix of an upper triangle as U^T D U, U unit upper, which take its place (Golub & Van Loan, "Matrix
/// computations"); the inverse of D. Pivots are held up, so that they are positive whatever rounding did; those of rows
/// of zeros are left out.
template <std::size_t kSize>
std::array<double, kSize> factorise(Square<kSize>& m) {
  std::array<double, kSize> least{};
  std::array<double, kSize> inverse{};
  for (std::size_t k = 0; k < kSize; ++k) least[k] = kLeastPivot * m[k][k];
  for (std::size_t k = 0; k < kSize; ++k) {
    const double pivot = std::max(m[k][k], least[k]);
    inverse[k] = pivot > 0.0 ? 1.0 / pivot : 0.0;
    for (std::size_t i = k + 1; i < kSize; ++i) {
      const double u = m[k][i] * inverse[k];
      for (std::size_t l = i; l < kSize; ++l) m[i][l] -= u * m[k][l];
    }
    for (std::size_t i = k + 1; i < kSize; ++i) m[k][i] *= inverse[k];
  }
  return inverse;
}

template <std::size_t kSize>
void invert_symmetric(Square<kSize>& m) {
  const std::array<double, kSize> inverse_pivot = factorise(m);
  // U by its inverse V, from the last row up.
  for (std::size_t k = kSize; k-- > 0;) {
    for (std::size_t i = kSize; i-- > k + 1;) {
      double sum = m[k][i];
      for (std::size_t j = k + 1; j < i; ++j) sum += m[k][j] * m[j][i];
      m[k][i] = -sum;
    }
    m[k][k] = 1.0;
  }
  // V D^-1 V^T. Element (j, k) needs no columns before k, and is the last to need its own place in row j.
  for (std::size_t j = 0; j < kSize; ++j) {
    for (std::size_t k = j; k < kSize; ++k) {
      double sum = 0.0;
      for (std::size_t i = k; i < kSize; ++i) sum += m[j][i] * inverse_pivot[i] * m[k][i];
      m[j][k] = sum;
    }
  }
}

}  // namespace

FitBlocks::FitBlocks(std::size_t texels, std::size_t numbers)
    : texels_(texels), numbers_(numbers), planes_(texels * numbers * (numbers + 1) / 2, 0.0f) {}

template <std::size_t kNumbers>
void FitBlocks::invert_texels(const Run& run) {
  parallel_blocks(texels_, kBlocksTogether, run, "", [&](const Block& block) {
    Square<kNumbers> m{};
    for (std::size_t n = block.begin; n < block.end; ++n) {
      for (std::size_t j = 0; j < kNumbers; ++j)
        for (std::size_t k = j; k < kNumbers; ++k) m[j][k] = double(plane(j, k)[n]);
      invert_symmetric(m);
      for (std::size_t j = 0; j < kNumbers; ++j)
        for (std::size_t k = j; k < kNumbers; ++k) plane(j, k)[n] = float(m[j][k]);
    }
  });
}

void FitBlocks::invert(const Run& run) {
  switch (numbers_) {
    case 1:
      invert_texels<1>(run);
      break;
    case 2:
      invert_texels<2>(run);
      break;
    case 4:
      invert_texels<4>(run);
      break;
    default:
      invert_texels<FitTerms::kMost>(run);
  }
  invert_symmetric(terms_);
}

void FitBlocks::apply(const FitVector& x, FitVector& y, const Run& run) const {
  y.numbers.assign(x.numbers.size(), 0.0f);
  y.terms.fill(0.0);
  parallel_blocks(texels_, kBlocksTogether, run, "", [&](const Block& block) {
    for (std::size_t j = 0; j < numbers_; ++j) {
      float* to = &y.numbers[j * texels_];
      for (std::size_t k = 0; k < numbers_; ++k) {
        const float* element = &planes_[pair(std::min(j, k), std::max(j, k)) * texels_];
        const float* from = &x.numbers[k * texels_];
        for (std::size_t n = block.begin; n < block.end; ++n) to[n] += element[n] * from[n];
      }
    }
  });
  for (std::size_t s = 0; s < y.terms.size(); ++s)
    for (std::size_t t = 0; t < y.terms.size(); ++t) y.terms[s] += terms_[std::min(s, t)][std::max(s, t)] * x.terms[t];
}

}  // namespace isolux
