#include "texel_near_field.h"

#include <isolux/core/parallel.h>
#include <isolux/core/texel_mask.h>
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

/// A texel's openness at each step and its weight: level sets count by their area (the coarea formula), but less so
/// than that, since a single value of a steep place says little of the others; 0 if unlit.
struct Measured {
  Vec3f openness{0.0f};
  float weight = 0.0f;
};

float weight_of(const NearField::Ahead& ahead) { return float(std::sqrt(ahead.fall)); }

/// most_weight() of the lit texels; of many, of those of rows spread evenly over them.
float most_weight_of(const NearField& near_field, const ResampledGrid& texels) {
  constexpr std::size_t kTexelsEnough = 65536;
  const Index3& size = texels.grid.lattice.size;
  const auto nx = std::size_t(size.x);
  std::size_t step = std::max<std::size_t>(1, texels.lit.size() / kTexelsEnough);
  while (std::gcd(step, std::size_t(size.y)) > 1) ++step;  // rows of all j
  TexelRow row(near_field, texels.grid.lattice);
  std::vector<int> columns;
  std::vector<float> weights;
  for (std::size_t r = 0; r < texels.lit.size() / nx; r += step) {
    columns.clear();
    for (int i = 0; i < size.x; ++i)
      if (texels.lit[r * nx + std::size_t(i)] != 0) columns.push_back(i);
    row.look(int(r % std::size_t(size.y)), int(r / std::size_t(size.y)), columns);
    for (std::size_t n = 0; n < columns.size(); ++n) weights.push_back(weight_of(row.ahead(n)));
  }
  return most_weight(weights);
}

/// Layers of texels, measured when they are wanted and let go after the next two.
class MeasuredLayers {
 public:
  MeasuredLayers(const NearField& near_field, double outwards, float most_weight, const ResampledGrid& texels)
      : outwards_(outwards),
        most_weight_(most_weight),
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
        kept.measured[row + std::size_t(columns_[n])].weight = std::min(weight_of(row_.ahead(n)), most_weight_);
      for (int s = 0; s < 3; ++s) {
        row_.find_openness(outwards_ * kOwnSteps[std::size_t(s)]);
        for (std::size_t n = 0; n < columns_.size(); ++n)
          kept.measured[row + std::size_t(columns_[n])].openness[s] = row_.openness(n);
      }
    }
  }

  double outwards_;
  float most_weight_;
  const ResampledGrid& texels_;
  std::size_t layer_;
  TexelRow row_;
  std::vector<int> columns_;
  std::array<Kept, 3> kept_;
};

/// Sums over texels, and what is found of pairs of opposite neighbours: what a texel has more than these on average.
struct Moments {
  NearFieldFit pairs;
  Vec3 mean{0.0};     ///< openness of all texels
  Vec3 squares{0.0};  ///< of their light, by channel
  double texels = 0.0;

  void operator+=(const Moments& more) {
    pairs += more.pairs;
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
  const auto n = std::size_t(channels);
  Vec3 lighter(0.0);
  for (int c = 0; c < channels; ++c) {
    const auto e = [&](std::size_t t) { return double(values[pair.texels[t] * n + std::size_t(c)]); };
    lighter[c] = e(1) - 0.5 * (e(0) + e(2));
  }
  sum.pairs.add(more, lighter, channels, double(here->weight));
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
  const float most = most_weight_of(near_field, texels);
  std::vector<Moments> by_layer(std::size_t(texels.grid.lattice.size.z));
  parallel_blocks(by_layer.size(), layers_a_block(by_layer.size(), run), run, "", [&](const Block& block) {
    MeasuredLayers layers(near_field, outwards, most, texels);
    for (std::size_t k = block.begin; k < block.end; ++k) by_layer[k] = moments_of_layer(texels.grid, layers, int(k));
  });
  Moments all;
  for (const Moments& layer : by_layer) all += layer;
  return all;
}

}  // namespace

void estimate_near_field(const Volume& volume, double outwards, ResampledGrid& texels, const Run& run) {
  const NearField near_field(volume);
  IlluminationGrid& grid = texels.grid;
  const Moments sum = moments(near_field, outwards, texels, run);
  std::vector<NearFieldTerm> terms;
  for (int s = 0; s < 3; ++s) {
    terms.push_back({.step = float(outwards * kOwnSteps[std::size_t(s)]),
                     .mean = float(sum.mean[s] / std::max(sum.texels, 1.0)),
                     .weight = Vec3f(0.0f)});
  }
  bool any = false;
  for (int c = 0; c < grid.channels; ++c) {
    const double light = std::sqrt(sum.squares[c] / std::max(sum.texels, 1.0));
    const std::optional<Vec3> weight = sum.pairs.weights(c, light, sum.pairs.rows());
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
  std::optional<TexelMask> only;
  if (light.detail.isovalues) only = texels_read_by(volume, light.lattice, *light.detail.isovalues, run);
  const auto channels = std::size_t(light.channels);
  parallel_blocks(std::size_t(size.z) * std::size_t(size.y), 8, run, "", [&](const Block& block) {
    TexelRow row(near_field, light.lattice);
    std::vector<int> columns;
    std::vector<Vec3> sums;
    for (std::size_t r = block.begin; r < block.end; ++r) {
      const int j = int(r % std::size_t(size.y));
      const int k = int(r / std::size_t(size.y));
      columns.clear();
      for (int i = 0; i < size.x; ++i)
        if (!only || (*only)[light.lattice.offset(i, j, k)]) columns.push_back(i);
      row.look(j, k, columns);
      row.keep_lit(columns);
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

}  // namespace isolux
