#include "fit_vector.h"

#include <isolux/core/parallel.h>

namespace isolux {
namespace {

constexpr std::size_t kNumbersABlock = 16384;

/// In sums side by side, which need not wait for each other.
double block_product(const float* x, const float* y, std::size_t count) {
  std::array<double, 8> sums{};
  std::size_t i = 0;
  for (; i + sums.size() <= count; i += sums.size())
    for (std::size_t j = 0; j < sums.size(); ++j) sums[j] += double(x[i + j]) * double(y[i + j]);
  for (; i < count; ++i) sums[0] += double(x[i]) * double(y[i]);
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

}  // namespace

void add_scaled(FitVector& y, double a, const FitVector& x, const Run& run) {
  parallel_blocks(y.numbers.size(), kNumbersABlock, run, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) y.numbers[i] += float(a) * x.numbers[i];
  });
  for (std::size_t t = 0; t < y.terms.size(); ++t) y.terms[t] += a * x.terms[t];
}

void add_to_scaled(FitVector& y, double a, const FitVector& x, const Run& run) {
  parallel_blocks(y.numbers.size(), kNumbersABlock, run, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) y.numbers[i] = x.numbers[i] + float(a) * y.numbers[i];
  });
  for (std::size_t t = 0; t < y.terms.size(); ++t) y.terms[t] = x.terms[t] + a * y.terms[t];
}

double product(const FitVector& x, const FitVector& y, const Run& run) {
  std::vector<double> sums(block_count(x.numbers.size(), kNumbersABlock), 0.0);
  parallel_blocks(x.numbers.size(), kNumbersABlock, run, "", [&](const Block& block) {
    sums[block.index] = block_product(&x.numbers[block.begin], &y.numbers[block.begin], block.end - block.begin);
  });
  double sum = 0.0;
  for (const double part : sums) sum += part;
  for (std::size_t t = 0; t < x.terms.size(); ++t) sum += x.terms[t] * y.terms[t];
  return sum;
}

}  // namespace isolux
