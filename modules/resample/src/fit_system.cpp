#include "fit_system.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "cell_places.h"

namespace isolux {
namespace {

constexpr std::size_t kTerms = kNearFieldSteps.size();
using Terms = std::array<double, kTerms>;
static_assert(kTerms == 4, "terms are added beside four corners");

/// Of the mean weight: no sample counts for nothing.
constexpr double kLeastWeight = 1e-3;
/// Of a row's weight where its reading is clamped. None would be Newton's method, whose step knows no bound where all
/// rows around a texel are.
constexpr float kClampedPart = 0.1f;

}  // namespace

FitSystem::FitSystem(const Volume& volume, const SampleSet& samples, const Lattice& texels, SlopeTerms slopes,
                     NearFieldUse near_field, const Run& run)
    : slope_terms_(slopes), near_field_(near_field), run_(run) {
  sort_rows(volume, samples, texels, run);
  texels_.emplace(volume, texels, starts_, slopes, run);
  measure(volume, samples, run);
  weigh_texels();
}

void FitSystem::sort_rows(const Volume& volume, const SampleSet& samples, const Lattice& texels, const Run& run) {
  CellPlaces sorted = sort_by_cells(volume, samples.sites, texels, run);
  starts_ = std::move(sorted.starts);
  rows_.resize(samples.size());
  parallel_blocks(rows_.size(), 65536, run, "", [&](const Block& block) {
    for (std::size_t r = block.begin; r < block.end; ++r) {
      const CellPlace& place = sorted.places[r];
      rows_[r] = {.place = place.in_cell,
                  .isovalue = samples.sites.isovalues[place.site],
                  .openness = {},
                  .weight = 1.0f,
                  .sample = place.site};
    }
  });
}

void FitSystem::measure(const Volume& volume, const SampleSet& samples, const Run& run) {
  const NearField near_field(volume);
  const double outwards = near_field.outwards(samples.sites);
  for (double& step : steps_) step *= outwards;

  using Sums = std::array<double, kTerms + 1>;
  std::vector<Sums> blocks(block_count(rows_.size(), 4096), Sums{});
  parallel_blocks(rows_.size(), 4096, run, "", [&](const Block& block) {
    Sums& sums = blocks[block.index];
    for (std::size_t r = block.begin; r < block.end; ++r) {
      Row& row = rows_[r];
      const Vec3 position(samples.sites.positions[row.sample]);
      const NearField::Ahead ahead = near_field.ahead(position);
      row.weight = float(std::sqrt(ahead.fall));
      sums[kTerms] += double(row.weight);
      if (near_field_ == NearFieldUse::kNone) continue;
      for (std::size_t t = 0; t < kTerms; ++t) {
        row.openness[t] = near_field.openness(position, ahead, double(row.isovalue), steps_[t]);
        sums[t] += double(row.openness[t]);
      }
    }
  });
  Sums sums{};
  for (const Sums& block : blocks) {
    for (std::size_t t = 0; t <= kTerms; ++t) sums[t] += block[t];
  }
  centre_rows(sums);
}

void FitSystem::centre_rows(const std::array<double, kTerms + 1>& sums) {
  const auto count = double(rows_.size());
  const double weight = sums[kTerms] / count;
  for (std::size_t t = 0; t < kTerms; ++t) mean_openness_[t] = sums[t] / count;
  for (Row& row : rows_) {
    for (std::size_t t = 0; t < kTerms; ++t) row.openness[t] -= float(mean_openness_[t]);
    row.weight = weight > 0.0 ? float(std::max(double(row.weight) / weight, kLeastWeight)) : 1.0f;
  }
}

void FitSystem::weigh_texels() {
  std::vector<float> coverage;
  texel_weights_ = texel_means([](const Row& row) { return row.weight; }, coverage);
}

Terms FitSystem::sum_layers(const std::vector<Terms>& layers) const {
  Terms sum{};
  for (const Terms& layer : layers) {
    for (std::size_t t = 0; t < kTerms; ++t) sum[t] += layer[t];
  }
  return sum;
}

template <class Visit>
void FitSystem::for_each_cell(const Visit& visit) const {
  const Index3 size = texels_->cells();
  const auto layer = [&](int k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const std::size_t cell =
            (std::size_t(k) * std::size_t(size.y) + std::size_t(j)) * std::size_t(size.x) + std::size_t(i);
        const std::span rows(rows_.data() + starts_[cell], starts_[cell + 1] - starts_[cell]);
        if (rows.empty()) continue;
        visit(texels_->corners(i, j, k), rows, std::size_t(starts_[cell]), std::size_t(k));
      }
    }
  };
  for (int parity = 0; parity < 2; ++parity) {
    const int layers = (size.z - parity + 1) / 2;
    parallel_blocks(std::size_t(layers), 1, run_, "",
                    [&](const Block& block) { layer(parity + 2 * int(block.begin)); });
  }
}

FitVector FitSystem::zero() const {
  FitVector x;
  x.values.assign(texels_->size(), 0.0f);
  if (slope_terms_ == SlopeTerms::kByIsovalue) x.slopes.assign(texels_->size(), 0.0f);
  return x;
}

template <class Value>
std::vector<float> FitSystem::texel_means(const Value& value, std::vector<float>& coverage) const {
  std::vector<float> means(texels_->size(), 0.0f);
  std::vector<double> sum(texels_->size(), 0.0);
  std::vector<double> total(texels_->size(), 0.0);
  for_each_cell(
      [&](const FitCorners& corners, std::span<const Row> rows, std::size_t /*first*/, std::size_t /*layer*/) {
        std::array<float, 8> w{};
        std::array<float, 8> s{};
        for (const Row& row : rows) {
          corners.weights(row.place, row.isovalue, w, s);
          for (unsigned q = 0; q < 8; ++q) {
            sum[corners.texel[q]] += double(w[q]) * double(value(row));
            total[corners.texel[q]] += double(w[q]);
          }
        }
      });
  coverage.resize(texels_->size());
  for (std::size_t t = 0; t < sum.size(); ++t) {
    coverage[t] = float(total[t]);
    if (total[t] > 0.0) means[t] = float(sum[t] / total[t]);
  }
  return means;
}

FitVector FitSystem::prior(std::span<const float> light, std::vector<float>& coverage) const {
  FitVector x = zero();
  x.values = texel_means([light](const Row& row) { return light[row.sample]; }, coverage);
  return x;
}

FitRest FitSystem::rest(std::span<const float> light, const FitVector& prior, const FitVector& x,
                        const FitDamping& damping, const ValueRange& bounds) const {
  FitRest rest{.gradient = zero(), .weights = std::vector<float>(rows_.size(), 0.0f)};
  FitVector& y = rest.gradient;
  for (std::size_t t = 0; t < x.values.size(); ++t)
    y.values[t] = -float(damping.value) * texel_weights_[t] * x.values[t];
  for (std::size_t t = 0; t < x.slopes.size(); ++t)
    y.slopes[t] = -float(damping.slope) * texel_weights_[t] * x.slopes[t];
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  const bool sloped = slope_terms_ == SlopeTerms::kByIsovalue;
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t layer) {
    std::array<float, 8> w{};
    std::array<float, 8> s{};
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      corners.weights(row.place, row.isovalue, w, s);
      double read = 0.0;
      for (unsigned q = 0; q < 8; ++q) {
        const std::uint32_t t = corners.texel[q];
        read += double(w[q]) * (double(prior.values[t]) + double(x.values[t]));
        if (sloped) read += double(s[q]) * double(x.slopes[t]);
      }
      for (std::size_t t = 0; t < kTerms; ++t) read += double(row.openness[t]) * x.terms[t];
      const bool follows = read > double(bounds.low) && read < double(bounds.high);
      rest.weights[first + r] = follows ? row.weight : kClampedPart * row.weight;
      const auto left =
          row.weight * float(double(light[row.sample]) - std::clamp(read, double(bounds.low), double(bounds.high)));
      for (unsigned q = 0; q < 8; ++q) {
        y.values[corners.texel[q]] += w[q] * left;
        if (sloped) y.slopes[corners.texel[q]] += s[q] * left;
      }
      for (std::size_t t = 0; t < kTerms; ++t) layers[layer][t] += double(row.openness[t]) * double(left);
    }
  });
  y.terms = sum_layers(layers);
  return rest;
}

FitVector FitSystem::normal_product(const FitVector& x, const FitDamping& damping,
                                    std::span<const float> weights) const {
  FitVector y = zero();
  for (std::size_t t = 0; t < x.values.size(); ++t)
    y.values[t] = float(damping.value) * texel_weights_[t] * x.values[t];
  for (std::size_t t = 0; t < x.slopes.size(); ++t)
    y.slopes[t] = float(damping.slope) * texel_weights_[t] * x.slopes[t];
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  const bool sloped = slope_terms_ == SlopeTerms::kByIsovalue;
  const std::array<float, kTerms> terms = [&] {
    std::array<float, kTerms> result{};
    for (std::size_t t = 0; t < kTerms; ++t) result[t] = float(x.terms[t]);
    return result;
  }();
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t layer) {
    std::array<float, 8> w{};
    std::array<float, 8> s{};
    std::array<float, 8> values{};
    std::array<float, 8> slopes{};
    std::array<float, 8> value_sums{};
    std::array<float, 8> slope_sums{};
    Terms term_sums{};
    for (unsigned q = 0; q < 8; ++q) {
      values[q] = x.values[corners.texel[q]];
      slopes[q] = sloped ? x.slopes[corners.texel[q]] : 0.0f;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const float weight = weights[first + r];
      corners.weights(row.place, row.isovalue, w, s);
      // Four sums side by side, which fit a vector.
      std::array<float, 4> parts{};
      for (unsigned q = 0; q < 4; ++q)
        parts[q] = (w[q] * values[q] + s[q] * slopes[q]) + (w[q + 4] * values[q + 4] + s[q + 4] * slopes[q + 4]) +
                   row.openness[q] * terms[q];
      const float read = weight * ((parts[0] + parts[1]) + (parts[2] + parts[3]));
      for (unsigned q = 0; q < 8; ++q) {
        value_sums[q] += w[q] * read;
        slope_sums[q] += s[q] * read;
      }
      for (std::size_t t = 0; t < kTerms; ++t) term_sums[t] += double(row.openness[t]) * double(read);
    }
    for (std::size_t t = 0; t < kTerms; ++t) layers[layer][t] += term_sums[t];
    for (unsigned q = 0; q < 8; ++q) {
      y.values[corners.texel[q]] += value_sums[q];
      if (sloped) y.slopes[corners.texel[q]] += slope_sums[q];
    }
  });
  y.terms = sum_layers(layers);
  return y;
}

FitVector FitSystem::diagonal(const FitDamping& damping, std::span<const float> weights) const {
  FitVector d = zero();
  for (std::size_t t = 0; t < d.values.size(); ++t) d.values[t] = float(damping.value) * texel_weights_[t];
  for (std::size_t t = 0; t < d.slopes.size(); ++t) d.slopes[t] = float(damping.slope) * texel_weights_[t];
  std::vector<Terms> layers(std::size_t(texels_->cells().z), Terms{});
  for_each_cell([&](const FitCorners& corners, std::span<const Row> rows, std::size_t first, std::size_t layer) {
    std::array<float, 8> w{};
    std::array<float, 8> s{};
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const float weight = weights[first + r];
      corners.weights(row.place, row.isovalue, w, s);
      for (unsigned q = 0; q < 8; ++q) {
        d.values[corners.texel[q]] += weight * w[q] * w[q];
        if (!d.slopes.empty()) d.slopes[corners.texel[q]] += weight * s[q] * s[q];
      }
      for (std::size_t t = 0; t < kTerms; ++t) {
        layers[layer][t] += double(weight) * double(row.openness[t]) * double(row.openness[t]);
      }
    }
  });
  d.terms = sum_layers(layers);
  return d;
}

}  // namespace isolux
