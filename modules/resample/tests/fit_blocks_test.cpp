#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <cmath>

#include "fit_blocks.h"

namespace isolux {
namespace {

constexpr std::size_t kTexelsOfBlocks = 20;

// Blocks of more samples than numbers, times their inverses, of any vector: the vector. In floats of 6e-8 and of blocks
// whose condition is some hundred, hence 1e-4.
TEST(FitBlocks, InvertEachTexelsBlock) {
  for (const std::size_t numbers : {1, 2, 4, 5}) {
    FitBlocks blocks(kTexelsOfBlocks, numbers);
    FitVector x{.numbers = std::vector<float>(kTexelsOfBlocks * numbers), .terms = {0.4, -0.7, 0.2, 1.0}};
    FitVector product{.numbers = std::vector<float>(kTexelsOfBlocks * numbers, 0.0f), .terms = {}};
    RandomStream random(3, numbers);
    for (float& v : x.numbers) v = random.uniform_float();
    const auto add_sample = [&](const auto& row, const auto& add) {
      for (std::size_t j = 0; j < row.size(); ++j)
        for (std::size_t k = 0; k < row.size(); ++k) add(j, k, row[j] * row[k]);
    };
    for (std::size_t n = 0; n < kTexelsOfBlocks; ++n) {
      for (int sample = 0; sample < 20; ++sample) {
        std::vector<double> row(numbers);
        for (double& v : row) v = 2.0 * random.uniform_double() - 1.0;
        add_sample(row, [&](std::size_t j, std::size_t k, double v) {
          if (j <= k) blocks.plane(j, k)[n] += float(v);
          product.numbers[j * kTexelsOfBlocks + n] += float(v) * x.numbers[k * kTexelsOfBlocks + n];
        });
      }
    }
    for (int sample = 0; sample < 20; ++sample) {
      std::array<double, kNearFieldSteps.size()> row{};
      for (double& v : row) v = 2.0 * random.uniform_double() - 1.0;
      add_sample(row, [&](std::size_t s, std::size_t t, double v) {
        blocks.terms()[s][t] += v;
        product.terms[s] += v * x.terms[t];
      });
    }
    blocks.invert({});
    FitVector back;
    blocks.apply(product, back, {});
    for (std::size_t i = 0; i < x.numbers.size(); ++i) EXPECT_NEAR(back.numbers[i], x.numbers[i], 1e-4f);
    for (std::size_t t = 0; t < x.terms.size(); ++t) EXPECT_NEAR(back.terms[t], x.terms[t], 1e-9);
  }
}

// One sample says nothing of five numbers apart from each other, none says nothing at all: what comes of that is
// finite, and no way up (x . A x >= 0), or conjugate gradients would go astray.
TEST(FitBlocks, StayPositiveOfTooFewSamples) {
  FitBlocks blocks(2, 5);
  for (std::size_t j = 0; j < 5; ++j)
    for (std::size_t k = j; k < 5; ++k) blocks.plane(j, k)[0] = (0.3f + float(j)) * (0.3f + float(k));
  blocks.invert({});
  RandomStream random(3, 0);
  for (int tries = 0; tries < 100; ++tries) {
    FitVector x{.numbers = std::vector<float>(10), .terms = {1.0, 1.0, 1.0, 1.0}};
    for (float& v : x.numbers) v = 2.0f * random.uniform_float() - 1.0f;
    FitVector y;
    blocks.apply(x, y, {});
    for (std::size_t i = 0; i < 10; ++i) EXPECT_TRUE(std::isfinite(y.numbers[i]));
    for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(y.numbers[2 * k + 1], 0.0f);
    for (const double term : y.terms) EXPECT_EQ(term, 0.0);
    EXPECT_GE(product(x, y, {}), 0.0);
  }
}

}  // namespace
}  // namespace isolux
