#include "texel_near_field.h"

#include <isolux/core/parallel.h>
#include <isolux/resample/openness.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "near_field.h"
#include "texel_row.h"

namespace isolux {
namespace {

/// Half a step is one of a fit's but not one of these: at cell centres it says other things than elsewhere
/// (docs/resampling.md). Those that openness_before() promises.
constexpr std::array<double, 3> kSteps = {1.0, 2.0, 4.0};
/// Of the squared differences between texels, the part that terms must explain to be kept: it makes no visible
/// difference below.
constexpr double kLeastPart = 0.002;
/// Likewise, of what as many meaningless terms explain on average.
constexpr double kLeastOfChance = 10.0;
/// Of the light (root mean square of the texels), the most that all openness may be worth; volumes under a white sky
/// have .05 to .4 of its 1. Near a lamp inside the volume openness hardly changes, but as light does, with the
/// distance; weights that explain one by the other are tens of times the light.
constexpr double kMostOfLight = 2.0;
/// Of the moments' diagonal, added to it: openness at several steps may be all alike.
constexpr double kRidge = 1e-6;

/// A texel's openness at each step and its weight: level sets count by their area (the coarea formula), but less so
/// than that, since a single value of a steep place says little of the others; 0 if unlit.
struct Measured {
  Vec3f openness{0.0f};
  float weight = 0.0f;
};

/// Layers of texels, measured when they are wanted and let go after the next two.
class MeasuredLayers {
 public:
  MeasuredLayers(const NearField& near_field, double outwards, const ResampledGrid& texels)
      : outwards_(outwards),
        texels_(texels),
        layer_(std::size_t(texels.grid.lattice.size.x) * std::size_t(texels.grid.lattice.size.y)),
        row_(near_field, texels.grid.lattice) {}

  /// Layer k, by the texel's number within it. Good until layer k + 3.
  [[nodiscard]] const std::vector<Measured>& at(int k) {
    Kept& kept = kept_[std::size_t(k % 3)];
    if (kept.k != k) measure(k, kept);
    return kept.measured;
  }

 private:
  struct Kept {
    int k = -1;
    std::vector<Measured> measured;
  };

  void measure(int k, Kept& kept) {
    const Index3& size = texels_.grid.lattice.size;
    kept.k = k;
    kept.measured.assign(layer_, {});
    for (int j = 0; j < size.y; ++j) {
      const std::size_t row = std::size_t(j) * std::size_t(size.x);
      const std::uint8_t* const lit = texels_.lit.data() + std::size_t(k) * layer_ + row;
      columns_.clear();
      for (int i = 0; i < size.x; ++i)
        if (lit[i] != 0) columns_.push_back(i);
      row_.look(j, k, columns_);
      for (std::size_t n = 0; n < columns_.size(); ++n)
        kept.measured[row + std::size_t(columns_[n])].weight = float(std::sqrt(row_.ahead(n).fall));
      for (int s = 0; s < 3; ++s) {
        row_.find_openness(outwards_ * kSteps[std::size_t(s)]);
        for (std::size_t n = 0; n < columns_.size(); ++n)
          kept.measured[row + std::size_t(columns_[n])].openness[s] = row_.openness(n);
      }
    }
  }

  double outwards_;
  const ResampledGrid& texels_;
  std::size_t layer_;
  TexelRow row_;
  std::vector<int> columns_;
  std::array<Kept, 3> kept_;
};

/// Sums over texels, and over pairs of opposite neighbours of what a texel has more than these have on average.
struct Moments {
  Mat3 openness{0.0};                ///< squares and products
  std::array<Vec3, 3> by_channel{};  ///< of openness with light
  Vec3 light{0.0};                   ///< squares, by channel
  double rows = 0.0;
  Vec3 mean{0.0};     ///< openness of all texels
  Vec3 squares{0.0};  ///< of their light, by channel
  double texels = 0.0;

  void operator+=(const Moments& more) {
    openness += more.openness;
    for (std::size_t c = 0; c < 3; ++c) by_channel[c] += more.by_channel[c];
    light += more.light;
    rows += more.rows;
    mean += more.mean;
    squares += more.squares;
    texels += more.texels;
  }
};

/// A texel and two opposite neighbours of it: their numbers and what was measured there.
struct Pair {
  std::array<std::size_t, 3> texels;  ///< before, here, after
  std::array<const Measured*, 3> measured;
};

void add_pair(const std::vector<float>& values, int channels, const Pair& pair, Moments& sum) {
  const auto& [before, here, after] = pair.measured;
  if (!(before->weight > 0.0f && after->weight > 0.0f)) return;
  const Vec3 more = Vec3(here->openness) - 0.5 * (Vec3(before->openness) + Vec3(after->openness));
  const auto weight = double(here->weight);
  sum.openness += weight * glm::outerProduct(more, more);
  const auto n = std::size_t(channels);
  for (int c = 0; c < channels; ++c) {
    const auto e = [&](std::size_t t) { return double(values[pair.texels[t] * n + std::size_t(c)]); };
    const double lighter = e(1) - 0.5 * (e(0) + e(2));
    sum.by_channel[std::size_t(c)] += weight * lighter * more;
    sum.light[c] += weight * lighter * lighter;
  }
  sum.rows += 1.0;
}

Moments moments_of_layer(const IlluminationGrid& grid, MeasuredLayers& layers, int k) {
  const Index3& size = grid.lattice.size;
  const std::size_t stride[3] = {1, std::size_t(size.x), std::size_t(size.x) * std::size_t(size.y)};
  const std::size_t first = grid.lattice.offset(0, 0, k);
  const auto channels = std::size_t(grid.channels);
  const bool is_between = k > 0 && k + 1 < size.z;
  const std::vector<Measured>* below = is_between ? &layers.at(k - 1) : nullptr;
  const std::vector<Measured>& here = layers.at(k);
  const std::vector<Measured>* above = is_between ? &layers.at(k + 1) : nullptr;
  Moments sum;
  std::size_t n = 0;
  for (int j = 0; j < size.y; ++j) {
    for (int i = 0; i < size.x; ++i, ++n) {
      if (!(here[n].weight > 0.0f)) continue;
      sum.mean += Vec3(here[n].openness);
      sum.texels += 1.0;
      for (std::size_t c = 0; c < channels; ++c) {
        const auto e = double(grid.values[(first + n) * channels + c]);
        sum.squares[int(c)] += e * e;
      }
      const std::size_t t = first + n;
      const auto add = [&](std::size_t step, const Measured& before, const Measured& after) {
        add_pair(grid.values, grid.channels, {{t - step, t, t + step}, {&before, &here[n], &after}}, sum);
      };
      if (i > 0 && i + 1 < size.x) add(stride[0], here[n - 1], here[n + 1]);
      if (j > 0 && j + 1 < size.y) add(stride[1], here[n - stride[1]], here[n + stride[1]]);
      if (is_between) add(stride[2], (*below)[n], (*above)[n]);
    }
  }
  return sum;
}

/// Layers that follow each other on one thread measure what lies between them once.
std::size_t layers_a_block(std::size_t layers, const Run& run) {
  return std::clamp<std::size_t>(layers / (4 * std::size_t(thread_count(run))), 4, 32);
}

Moments moments(const NearField& near_field, double outwards, const ResampledGrid& texels, const Run& run) {
  std::vector<Moments> by_layer(std::size_t(texels.grid.lattice.size.z));
  parallel_blocks(by_layer.size(), layers_a_block(by_layer.size(), run), run, "", [&](const Block& block) {
    MeasuredLayers layers(near_field, outwards, texels);
    for (std::size_t k = block.begin; k < block.end; ++k) by_layer[k] = moments_of_layer(texels.grid, layers, int(k));
  });
  Moments all;
  for (const Moments& layer : by_layer) all += layer;
  return all;
}

/// The weights of one channel's terms; none if they explain too little, or by more than there is.
std::optional<Vec3> weights(const Moments& sum, int channel) {
  Vec3 scale(0.0);
  for (int s = 0; s < 3; ++s) scale[s] = sum.openness[s][s] > 0.0 ? 1.0 / std::sqrt(sum.openness[s][s]) : 0.0;
  Mat3 scaled(kRidge);
  for (int s = 0; s < 3; ++s)
    for (int t = 0; t < 3; ++t) scaled[s][t] += scale[s] * sum.openness[s][t] * scale[t];
  const Vec3& products = sum.by_channel[std::size_t(channel)];
  const Vec3 weight = scale * (glm::inverse(scaled) * (scale * products));
  const double explained = 2.0 * glm::dot(weight, products) - glm::dot(weight, sum.openness * weight);
  const double least = std::max(kLeastPart, kLeastOfChance * double(kSteps.size()) / std::max(sum.rows, 1.0));
  if (!(explained > least * sum.light[channel])) return {};
  const double light = std::sqrt(sum.squares[channel] / std::max(sum.texels, 1.0));
  const Vec3 worth = glm::abs(weight);
  if (worth.x + worth.y + worth.z > kMostOfLight * light) return {};
  return weight;
}

}  // namespace

void estimate_near_field(const Volume& volume, double outwards, ResampledGrid& texels, const Run& run) {
  const NearField near_field(volume);
  IlluminationGrid& grid = texels.grid;
  const Moments sum = moments(near_field, outwards, texels, run);
  std::vector<NearFieldTerm> terms;
  for (int s = 0; s < 3; ++s) {
    terms.push_back({.step = float(outwards * kSteps[std::size_t(s)]),
                     .mean = float(sum.mean[s] / std::max(sum.texels, 1.0)),
                     .weight = Vec3f(0.0f)});
  }
  bool any = false;
  for (int c = 0; c < grid.channels; ++c) {
    const std::optional<Vec3> weight = weights(sum, c);
    if (!weight) continue;
    any = true;
    for (int s = 0; s < 3; ++s) {
      Vec3f& of_term = terms[std::size_t(s)].weight;
      if (grid.channels == 1) of_term = Vec3f(float((*weight)[s]));
      of_term[c] = float((*weight)[s]);
    }
  }
  if (!any) return;
  grid.detail.near_field = std::move(terms);
  grid.detail.texel_light = TexelLight::kOwn;
  // Texels without light are 0 as yet, those around them will give them theirs.
  grid.detail.ceiling = *std::max_element(grid.values.begin(), grid.values.end());
}

void take_off_near_field(const Volume& volume, IlluminationGrid& light, const Run& run) {
  const NearField near_field(volume);
  const Index3& size = light.lattice.size;
  const std::optional<ValueRange>& lit = light.detail.isovalues;
  const auto channels = std::size_t(light.channels);
  parallel_blocks(std::size_t(size.z) * std::size_t(size.y), 8, run, "", [&](const Block& block) {
    TexelRow row(near_field, light.lattice);
    std::vector<int> columns(static_cast<std::size_t>(size.x));
    std::vector<Vec3> sums;
    for (std::size_t r = block.begin; r < block.end; ++r) {
      const int j = int(r % std::size_t(size.y));
      const int k = int(r / std::size_t(size.y));
      columns.resize(std::size_t(size.x));
      std::iota(columns.begin(), columns.end(), 0);
      row.look(j, k, columns);
      row.keep_lit(lit, columns);
      sums.assign(columns.size(), Vec3(0.0));
      for (const NearFieldTerm& term : light.detail.near_field) {
        row.find_openness(double(term.step));
        for (std::size_t n = 0; n < columns.size(); ++n)
          sums[n] += Vec3(term.weight) * double(row.openness(n) - term.mean);
      }
      for (std::size_t n = 0; n < columns.size(); ++n) {
        const std::size_t t = light.lattice.offset(columns[n], j, k);
        for (std::size_t c = 0; c < channels; ++c) {
          float& value = light.values[t * channels + c];
          value = float(double(value) - sums[n][int(c)]);
        }
      }
    }
  });
  light.detail.texel_light = TexelLight::kReduced;
}

std::vector<Vec3f> openness_before(const Volume& volume, const Sites& sites) {
  const NearField near_field(volume);
  const double outwards = near_field.outwards(sites);
  std::vector<Vec3f> openness(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const Vec3 index(sites.positions[s]);
    const NearField::Ahead ahead = near_field.ahead(index);
    for (std::size_t t = 0; t < kSteps.size(); ++t)
      openness[s][int(t)] = near_field.openness(index, ahead, double(sites.isovalues[s]), outwards * kSteps[t]);
  }
  return openness;
}

}  // namespace isolux
