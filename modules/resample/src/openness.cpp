#include <isolux/resample/openness.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "near_field.h"
#include "texel_near_field.h"

namespace isolux {
namespace {

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
constexpr double kAddedToDiagonal = 1e-6;

}  // namespace

std::vector<Vec3f> openness_before(const Volume& volume, const Sites& sites) {
  const NearField near_field(volume);
  const double outwards = near_field.outwards(sites);
  std::vector<Vec3f> openness(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const Vec3 index(sites.positions[s]);
    const NearField::Ahead ahead = near_field.ahead(index);
    for (std::size_t t = 0; t < kOwnSteps.size(); ++t)
      openness[s][int(t)] = near_field.openness(index, ahead, double(sites.isovalues[s]), outwards * kOwnSteps[t]);
  }
  return openness;
}

void NearFieldFit::operator+=(const NearFieldFit& more) {
  openness_ += more.openness_;
  for (std::size_t c = 0; c < 3; ++c) by_channel_[c] += more.by_channel_[c];
  light_ += more.light_;
  rows_ += more.rows_;
}

std::optional<Vec3> NearFieldFit::weights(int channel, double light, double rows) const {
  Vec3 scale(0.0);
  for (int s = 0; s < 3; ++s) scale[s] = openness_[s][s] > 0.0 ? 1.0 / std::sqrt(openness_[s][s]) : 0.0;
  Mat3 scaled(kAddedToDiagonal);
  for (int s = 0; s < 3; ++s)
    for (int t = 0; t < 3; ++t) scaled[s][t] += scale[s] * openness_[s][t] * scale[t];
  const Vec3& products = by_channel_[std::size_t(channel)];
  const Vec3 weight = scale * (glm::inverse(scaled) * (scale * products));
  const double explained = 2.0 * glm::dot(weight, products) - glm::dot(weight, openness_ * weight);
  const double least = std::max(kLeastPart, kLeastOfChance * double(kOwnSteps.size()) / std::max(rows, 1.0));
  if (!(explained > least * light_[channel])) return {};
  const Vec3 worth = glm::abs(weight);
  if (worth.x + worth.y + worth.z > kMostOfLight * light) return {};
  return weight;
}

}  // namespace isolux
