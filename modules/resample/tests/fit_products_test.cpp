// The wide products of the fit against the matrix that they are products of, at every instruction set.
#include <gtest/gtest.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "wide/fit_products.h"
#include "wide_targets.h"

namespace isolux {
namespace {

constexpr std::size_t kTexelsOfLines = 28;  // four lines of seven
constexpr std::size_t kTerms = kNearFieldSteps.size();
/// Some twenty products of numbers of size one are added in floats of 6e-8: 1e-6, with room.
constexpr double kRounding = 1e-5;

/// A line of six cells, or of one where the axis has a single texel, with no to five rows each.
struct Line {
  Line(std::size_t count, bool has_pairs) : numbers(count), pairs(has_pairs), random(7, count) {
    for (std::size_t p = 0; p < 4; ++p)
      for (std::size_t c = 0; c < 6; ++c) texels[p].push_back(std::uint32_t(7 * p + c));
    starts.push_back(0);
    for (std::size_t c = 0; c < (pairs ? 6 : 1); ++c) {
      const std::size_t here = pairs ? c % 4 * 5 / 3 : 5;
      for (std::size_t r = 0; r < here; ++r) add_row();
      starts.push_back(std::uint32_t(rows.size()));
    }
    isovalues = plane(1);
    inverse_breadths = plane(1);
    for (auto& normal : normals) normal = plane(1);
    x = plane(numbers);
  }

  float draw() { return 2.0f * random.uniform_float() - 1.0f; }
  std::vector<float> plane(std::size_t planes) {
    std::vector<float> all(planes * kTexelsOfLines);
    for (float& v : all) v = draw();
    return all;
  }
  void add_row() {
    FitRow row{};
    for (float& place : row.place) place = random.uniform_float();
    if (!pairs) row.place[0] = 0.0f;
    for (float& feature : row.feature) feature = draw();
    for (float& open : row.openness) open = draw();
    samples.push_back(std::uint32_t(rows.size()));
    rows.push_back(row);
    weights.push_back(0.5f + random.uniform_float());
    light.push_back(0.5f * draw());
  }

  [[nodiscard]] bool has_slopes() const { return numbers == 2 || numbers == 5; }
  [[nodiscard]] std::size_t first_normal() const { return has_slopes() ? 2 : 1; }
  [[nodiscard]] wide::FitCells cells() const {
    wide::FitCells all{.count = starts.size() - 1, .starts = starts.data(), .has_pairs = pairs};
    for (std::size_t p = 0; p < 4; ++p) all.texels[p] = texels[p].data();
    all.rows = rows.data();
    all.weights = weights.data();
    all.texel_count = kTexelsOfLines;
    all.isovalues = has_slopes() ? isovalues.data() : nullptr;
    return all;
  }
  [[nodiscard]] std::size_t texel(std::size_t cell, unsigned q) const {
    return texels[q >> 1][cell] + (pairs ? q & 1u : 0);
  }
  [[nodiscard]] static double weight(const FitRow& row, unsigned q) {
    double w = 1.0;
    for (unsigned a = 0; a < 3; ++a) w *= (q >> a & 1u) != 0 ? double(row.place[a]) : 1.0 - double(row.place[a]);
    return w;
  }
  /// What a texel's number counts at a row of a cell, its weight aside.
  [[nodiscard]] double feature(const FitRow& row, std::size_t cell, unsigned q, std::size_t k) const {
    if (k == 0) return 1.0;
    const auto own = double(row.feature[k - 1]);
    if (k >= first_normal()) return own;
    return own + double(isovalues[texels[0][cell]]) - double(isovalues[texel(cell, q)]);
  }
  /// Row by row of A: what each number and term counts.
  [[nodiscard]] std::vector<std::vector<double>> matrix() const {
    std::vector<std::vector<double>> all;
    for (std::size_t c = 0; c + 1 < starts.size(); ++c) {
      for (std::size_t r = starts[c]; r < starts[c + 1]; ++r) {
        std::vector<double> line(numbers * kTexelsOfLines + kTerms, 0.0);
        for (std::size_t k = 0; k < numbers; ++k)
          for (unsigned q = 0; q < 8; ++q)
            line[k * kTexelsOfLines + texel(c, q)] += weight(rows[r], q) * feature(rows[r], c, q, k);
        for (std::size_t t = 0; t < kTerms; ++t) line[numbers * kTexelsOfLines + t] = double(rows[r].openness[t]);
        all.push_back(line);
      }
    }
    return all;
  }
  [[nodiscard]] double read(const std::vector<double>& line) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += line[i] * double(x[i]);
    for (std::size_t t = 0; t < kTerms; ++t) sum += line[x.size() + t] * double(kX[t]);
    return sum;
  }

  static constexpr std::array<float, kTerms> kX = {0.3f, -0.2f, 0.5f, 0.1f};
  std::size_t numbers;
  bool pairs;
  RandomStream random;
  std::array<std::vector<std::uint32_t>, 4> texels;
  std::vector<std::uint32_t> starts;
  std::vector<std::uint32_t> samples;
  std::vector<FitRow> rows;
  std::vector<float> weights;
  std::vector<float> light;
  std::vector<float> isovalues;
  std::vector<float> inverse_breadths;
  std::array<std::vector<float>, 3> normals;
  std::vector<float> x;
};

class FitProducts : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { test::choose_target(GetParam()); }
  void TearDown() override { test::choose_target(0); }

  template <class Check>
  static void for_each_line(const Check& check) {
    for (const std::size_t numbers : {1, 2, 4, 5}) {
      for (const bool pairs : {true, false}) {
        SCOPED_TRACE(std::to_string(numbers) + (pairs ? " numbers" : " numbers, one texel an axis"));
        check(Line(numbers, pairs));
      }
    }
  }
  static void expect_near(const std::vector<double>& expected, const std::vector<float>& numbers,
                          const std::array<double, kTerms>& terms) {
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_NEAR(double(numbers[i]), expected[i], kRounding) << i;
    for (std::size_t t = 0; t < kTerms; ++t) EXPECT_NEAR(terms[t], expected[numbers.size() + t], kRounding);
  }
};

TEST_P(FitProducts, AreThoseOfTheMatrix) {
  for_each_line([](const Line& line) {
    std::vector<double> expected(line.x.size() + kTerms, 0.0);
    const auto matrix = line.matrix();
    for (std::size_t r = 0; r < matrix.size(); ++r)
      for (std::size_t i = 0; i < expected.size(); ++i)
        expected[i] += double(line.weights[r]) * line.read(matrix[r]) * matrix[r][i];
    std::vector<float> sums(line.x.size(), 0.0f);
    std::array<double, kTerms> terms{};
    wide::fit_kernels(line.numbers).product(line.cells(), line.x.data(), Line::kX, sums.data(), terms);
    expect_near(expected, sums, terms);
  });
}

// Light within .5 read between -.4 and .4: some rows are clamped, and keep a tenth of their weights.
TEST_P(FitProducts, LeaveWhatIsNotRead) {
  for_each_line([](const Line& line) {
    std::vector<double> expected(line.x.size() + kTerms, 0.0);
    std::vector<double> follows;
    const auto matrix = line.matrix();
    for (std::size_t r = 0; r < matrix.size(); ++r) {
      const double read = line.read(matrix[r]);
      const double clamped = std::clamp(read, double(-0.4f), double(0.4f));
      follows.push_back(double(line.weights[r]) * (read == clamped ? 1.0 : 0.1));
      for (std::size_t i = 0; i < expected.size(); ++i)
        expected[i] += double(line.weights[r]) * (double(line.light[r]) - clamped) * matrix[r][i];
    }
    std::vector<float> sums(line.x.size(), 0.0f);
    std::array<double, kTerms> terms{};
    std::array<double, kTerms> x{};
    std::copy(Line::kX.begin(), Line::kX.end(), x.begin());
    std::vector<float> weights(line.rows.size());
    const wide::FitLight light{
        .light = line.light.data(), .samples = line.samples.data(), .low = -0.4f, .high = 0.4f, .clamped_part = 0.1f};
    wide::fit_kernels(line.numbers).left(line.cells(), light, line.x.data(), x, sums.data(), terms, weights.data());
    expect_near(expected, sums, terms);
    for (std::size_t r = 0; r < weights.size(); ++r) EXPECT_NEAR(double(weights[r]), follows[r], kRounding);
  });
}

TEST_P(FitProducts, HaveTheMatrixsBlocks) {
  for_each_line([](const Line& line) {
    const std::size_t pairs = line.numbers * (line.numbers + 1) / 2;
    std::vector<double> expected(pairs * kTexelsOfLines, 0.0);
    std::array<std::array<double, kTerms>, kTerms> expected_terms{};
    for (std::size_t c = 0; c + 1 < line.starts.size(); ++c) {
      for (std::size_t r = line.starts[c]; r < line.starts[c + 1]; ++r) {
        const FitRow& row = line.rows[r];
        const auto weight = double(line.weights[r]);
        for (unsigned q = 0; q < 8; ++q) {
          std::array<double, FitTerms::kMost> counts{};
          for (std::size_t k = 0; k < line.numbers; ++k) {
            counts[k] = line.feature(row, c, q, k);
            if (k > 0 && k < line.first_normal()) counts[k] *= double(line.inverse_breadths[line.texel(c, q)]);
            if (k >= line.first_normal()) counts[k] -= double(line.normals[k - line.first_normal()][line.texel(c, q)]);
          }
          std::size_t pair = 0;
          for (std::size_t j = 0; j < line.numbers; ++j)
            for (std::size_t k = j; k < line.numbers; ++k)
              expected[kTexelsOfLines * pair++ + line.texel(c, q)] +=
                  weight * std::pow(Line::weight(row, q), 2.0) * counts[j] * counts[k];
        }
        for (std::size_t s = 0; s < kTerms; ++s)
          for (std::size_t t = 0; t < kTerms; ++t)
            expected_terms[s][t] += weight * double(row.openness[s]) * double(row.openness[t]);
      }
    }
    std::vector<float> sums(expected.size(), 0.0f);
    std::array<std::array<double, kTerms>, kTerms> terms{};
    wide::FitCentres centres{.inverse_breadths = line.inverse_breadths.data()};
    for (std::size_t a = 0; a < 3; ++a) centres.normals[a] = line.normals[a].data();
    wide::fit_kernels(line.numbers).moments(line.cells(), centres, sums.data(), terms);
    for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(double(sums[i]), expected[i], kRounding) << i;
    for (std::size_t s = 0; s < kTerms; ++s)
      for (std::size_t t = 0; t < kTerms; ++t) EXPECT_NEAR(terms[s][t], expected_terms[s][t], kRounding);
  });
}

INSTANTIATE_TEST_SUITE_P(EveryTarget, FitProducts, ::testing::ValuesIn(test::wide_targets()), test::wide_target_name);

}  // namespace
}  // namespace isolux
