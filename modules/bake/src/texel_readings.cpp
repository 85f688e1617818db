#include "texel_readings.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <unordered_map>

namespace isolux {
namespace {

constexpr std::size_t kUnlit = std::numeric_limits<std::size_t>::max();

/// Finds the sites at texels, each once.
class TexelSiteFinder {
 public:
  TexelSiteFinder(const Volume& volume, OuterSide outer, const Lattice& texels, GradientKind gradient)
      : field_(volume),
        outer_(outer),
        gradient_(gradient),
        texels_(texels),
        to_volume_(index_to_index(texels, volume.lattice())) {}

  /// kUnlit if there is none, as samplers see it.
  std::size_t at(const Index3& texel) {
    const auto [known, is_new] = numbers_.try_emplace(texels_.offset(texel.x, texel.y, texel.z), kUnlit);
    if (!is_new) return known->second;
    const Vec3f position(to_volume_.world(Vec3(texel)));
    const Vec3 place(position);
    const Vec3 normal = field_.normal(place, outer_, gradient_);
    if (normal == Vec3(0.0) || field_.is_flat_around(place)) return kUnlit;
    sites_.positions.push_back(position);
    sites_.isovalues.push_back(float(field_.value(place)));
    sites_.normals.emplace_back(normal);
    return known->second = sites_.size() - 1;
  }
  [[nodiscard]] bool holds(const Index3& texel) const {
    return glm::all(glm::greaterThanEqual(texel, Index3(0))) && glm::all(glm::lessThan(texel, texels_.size));
  }
  [[nodiscard]] Sites take() && { return std::move(sites_); }

 private:
  TrilinearField field_;
  OuterSide outer_;
  GradientKind gradient_;
  const Lattice& texels_;
  IndexToWorld to_volume_;
  std::unordered_map<std::size_t, std::size_t> numbers_;
  Sites sites_;
};

/// What one point reads.
class PointParts {
 public:
  void add(std::size_t site, double weight, double own) {
    const auto same = std::find_if(parts_.begin(), parts_.end(), [&](const auto& part) { return part.site == site; });
    auto& part = same == parts_.end() ? parts_.emplace_back() : *same;
    part.site = site;
    part.weight += weight;
    part.own += own;
  }
  /// Adds them as those of a point. \return the weight that is missing
  double append_to(std::vector<TexelsAround::Part>& all, std::size_t point) {
    double rest = 1.0;
    for (TexelsAround::Part& part : parts_) {
      part.point = point;
      rest -= part.weight;
      all.push_back(part);
    }
    parts_.clear();
    return std::max(0.0, rest);
  }

 private:
  std::vector<TexelsAround::Part> parts_;
};

/// What the texel is filled with: its lit neighbours by the inverse square of their distance (fill_unlit).
void add_neighbours(const Index3& texel, const Vec3& spacing, double weight, TexelSiteFinder& sites,
                    PointParts& parts) {
  std::vector<std::pair<std::size_t, double>> lit;
  double sum = 0.0;
  for (int q = 0; q < 27; ++q) {
    const Index3 step(q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1);
    if (step == Index3(0) || !sites.holds(texel + step)) continue;
    const std::size_t site = sites.at(texel + step);
    if (site == kUnlit) continue;
    const Vec3 apart = Vec3(step) * (spacing / spacing.x);
    lit.emplace_back(site, 1.0 / glm::dot(apart, apart));
    sum += lit.back().second;
  }
  for (const auto& [site, share] : lit) parts.add(site, weight * share / sum, 0.0);
}

}  // namespace

TexelsAround texels_around(const Volume& volume, OuterSide outer, const Lattice& texels, const Sites& points,
                           GradientKind gradient) {
  const IndexToWorld to_texels = index_to_index(volume.lattice(), texels);
  const Vec3 spacing = texels.frame.spacing();
  const Vec3 last(texels.size - 1);
  TexelSiteFinder sites(volume, outer, texels, gradient);
  TexelsAround around;
  PointParts parts;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3 at = glm::clamp(to_texels.world(Vec3(points.positions[p])), Vec3(0.0), last);
    const Vec3 low = glm::floor(at);
    for (unsigned q = 0; q < 8; ++q) {
      const Vec3 step(q & 1u, q >> 1 & 1u, q >> 2);
      const Vec3 part = glm::mix(1.0 - (at - low), at - low, step);
      const double weight = part.x * part.y * part.z;
      if (weight == 0.0) continue;
      const Index3 texel(glm::min(low + step, last));
      const std::size_t site = sites.at(texel);
      if (site != kUnlit) {
        parts.add(site, weight, weight);
      } else {
        add_neighbours(texel, spacing, weight, sites, parts);
      }
    }
    around.rest.push_back(parts.append_to(around.parts, p));
  }
  around.sites = std::move(sites).take();
  return around;
}

Readings read_between(const TexelsAround& around, const SampleSet& texels, const std::vector<Vec3f>& openness,
                      const Vec3& usual_openness) {
  const auto channels = std::size_t(texels.channels);
  const std::size_t points = around.rest.size();
  Readings read{.light = std::vector<double>(points * channels),
                .variance = std::vector<double>(points),
                .openness = std::vector<Vec3>(openness.empty() ? 0 : points, usual_openness)};
  for (std::size_t c = 0; c < channels; ++c) {
    double mean = 0.0;
    for (std::size_t s = 0; s < texels.size(); ++s) mean += double(texels.radiance[s * channels + c]);
    mean /= double(texels.size());
    for (std::size_t p = 0; p < points; ++p) read.light[p * channels + c] = around.rest[p] * mean;
  }
  for (const auto& [point, site, weight, own] : around.parts) {
    for (std::size_t c = 0; c < channels; ++c)
      read.light[point * channels + c] += weight * double(texels.radiance[site * channels + c]);
    read.variance[point] += weight * weight * double(texels.variance[site]);
    if (!read.openness.empty()) read.openness[point] += own * (Vec3(openness[site]) - usual_openness);
    read.own += own / double(points);
  }
  return read;
}

}  // namespace isolux
