#include "site_maker.h"

#include <isolux/core/field_points.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace isolux {
namespace {

/// Positions whose field is asked for at once: what is said of them stays in the first cache.
constexpr std::size_t kAtOnce = 256;

bool is_finite(const Vec3f& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

SiteMaker::SiteMaker(const Volume& volume, const SiteRequest& request)
    : field_(volume), request_(request), last_(volume.lattice().size - 1) {}

void SiteMaker::make(std::span<const Vec3f> positions, const Visit& visit) const {
  std::vector<std::size_t> numbers;
  Points points;
  PointSamples samples;
  for (std::size_t begin = 0; begin < positions.size(); begin += kAtOnce) {
    numbers.clear();
    points.clear();
    for (std::size_t i = begin; i < std::min(begin + kAtOnce, positions.size()); ++i) {
      if (!is_finite(positions[i])) continue;
      numbers.push_back(i);
      points.push_back(Vec3(glm::clamp(positions[i], Vec3f(0.0f), last_)));
    }
    sample_field(field_, points, samples);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const Vec3 index = points.at(i);
      const auto isovalue = float(samples.values[i]);
      if (request_.isovalues && !(isovalue >= request_.isovalues->low && isovalue <= request_.isovalues->high))
        continue;
      const double magnitude = std::max(std::fabs(double(samples.least[i])), std::fabs(double(samples.largest[i])));
      const bool is_smooth = request_.gradient == GradientKind::kCentralDifferences;
      const Vec3 gradient = is_smooth ? samples.gradient(i) : field_.cell_gradient(index);
      const Vec3 normal = field_.normal_of(gradient, magnitude, request_.outer);
      if (normal == Vec3(0.0)) continue;
      if (samples.least[i] == samples.largest[i] && field_.is_flat_around(index)) continue;
      visit(numbers[i], {.position = Vec3f(index), .isovalue = isovalue, .normal = Vec3f(normal)});
    }
  }
}

void SiteMaker::append(std::span<const Vec3f> positions, Sites& sites) const {
  make(positions, [&](std::size_t, const Site& site) {
    sites.positions.push_back(site.position);
    sites.isovalues.push_back(site.isovalue);
    sites.normals.push_back(site.normal);
  });
}

}  // namespace isolux
