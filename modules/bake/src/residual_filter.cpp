#include "residual_filter.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace isolux {
namespace {

constexpr float kReach = 1.5f;        // grid steps; about thirty vertices of a mesh
constexpr float kLeastCosine = 0.5f;  // of normals: the other sheet of a thin wall has other light
constexpr std::uint64_t kAxis = 1u << 21;

/// Sites by the cell that they lie in; cells of one row follow each other.
class CellOrder {
 public:
  explicit CellOrder(const std::vector<Vec3f>& positions) : order_(positions.size()) {
    for (std::size_t s = 0; s < positions.size(); ++s) order_[s] = {key(Index3(positions[s])), std::uint32_t(s)};
    std::sort(order_.begin(), order_.end());
  }

  /// Calls visit(site) for the sites of the cells within two of a point's.
  template <class Visit>
  void around(const Vec3f& point, const Visit& visit) const {
    const Index3 low = glm::max(Index3(glm::floor(point - kReach)), Index3(0));
    const Index3 high(point + kReach);
    for (int k = low.z; k <= high.z; ++k) {
      for (int j = low.y; j <= high.y; ++j) {
        auto it = std::lower_bound(order_.begin(), order_.end(), Entry{key({low.x, j, k}), 0});
        const std::uint64_t last = key({high.x, j, k});
        for (; it != order_.end() && it->first <= last; ++it) visit(it->second);
      }
    }
  }

 private:
  using Entry = std::pair<std::uint64_t, std::uint32_t>;
  static std::uint64_t key(const Index3& cell) {
    return (std::uint64_t(cell.z) * kAxis + std::uint64_t(cell.y)) * kAxis + std::uint64_t(cell.x);
  }
  std::vector<Entry> order_;
};

/// Weighted sums over the sites around one.
struct LocalSums {
  double weight = 0.0;
  double squared_weight = 0.0;
  double variance = 0.0;
  std::array<double, 3> residual{};
  std::array<double, 3> squared_residual{};

  void add(double w, const float* residuals, std::size_t channels, double noise) {
    weight += w;
    squared_weight += w * w;
    variance += w * noise;
    for (std::size_t c = 0; c < channels; ++c) {
      const auto r = double(residuals[c]);
      residual[c] += w * r;
      squared_residual[c] += w * r * r;
    }
  }
};

}  // namespace

FilteredResiduals filter_residuals(const Sites& sites, std::span<const float> residuals, int channel_count,
                                   std::span<const float> variance, const Run& run) {
  const auto channels = std::size_t(channel_count);
  const CellOrder order(sites.positions);
  FilteredResiduals result{.residuals = std::vector<float>(residuals.size()),
                           .variance = std::vector<float>(sites.size())};
  parallel_blocks(sites.size(), 1024, run, "", [&](const Block& block) {
    for (std::size_t s = block.begin; s < block.end; ++s) {
      LocalSums sums;
      order.around(sites.positions[s], [&](std::uint32_t n) {
        const float cosine = glm::dot(sites.normals[s], sites.normals[n]);
        const Vec3f apart = (sites.positions[n] - sites.positions[s]) / kReach;
        const float closeness = 1.0f - glm::dot(apart, apart);
        if (cosine < kLeastCosine || closeness <= 0.0f) return;
        const auto w = double(closeness * cosine);
        sums.add(w, &residuals[n * channels], channels, double(variance[n]));
      });
      double spread = 0.0;
      for (std::size_t c = 0; c < channels; ++c) {
        const double mean = sums.residual[c] / sums.weight;
        spread += (sums.squared_residual[c] / sums.weight - mean * mean) / double(channels);
      }
      const double noise = sums.variance / sums.weight;
      const double kept = spread > noise ? (spread - noise) / spread : 0.0;
      for (std::size_t c = 0; c < channels; ++c) {
        const double mean = sums.residual[c] / sums.weight;
        result.residuals[s * channels + c] = float(mean + kept * (double(residuals[s * channels + c]) - mean));
      }
      const double in_mean = sums.squared_weight / (sums.weight * sums.weight);
      const double smoothed_away = (1.0 - kept) * (1.0 - kept) * std::max(0.0, spread - noise);
      result.variance[s] = float(noise * (kept * kept + (1.0 - kept * kept) * in_mean) + smoothed_away);
    }
  });
  return result;
}

}  // namespace isolux
