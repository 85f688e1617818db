#include "ray_values.h"

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <variant>

namespace isolux {

RayValues::Scratch::Scratch(std::size_t rays) {
  for (auto& channel : sky) channel.resize(rays);
  for (auto& channel : reflected) channel.resize(rays + 1);  // one behind the last is looked at
}

RayValues::RayValues(const Scene& scene, const TargetLight& e)
    : scene_(scene),
      e_(e),
      environment_(scene.environment),
      uniform_(std::get_if<UniformEnvironment>(&scene.environment)),
      sky_(std::get_if<SkyEnvironment>(&scene.environment)) {
  if (sky_ != nullptr) up_ = Vec3f(glm::normalize(Vec3(sky_->up)));
}

std::optional<wide::NetMean::Moments> RayValues::known_moments(const LinkRound& round, const LinkBlock& block,
                                                               std::size_t place, float isovalue) const {
  if (uniform_ == nullptr || !e_.empty()) return std::nullopt;
  const auto hits = double(round.hits(block, place));
  const Vec3 sky(uniform_->radiance);
  const Vec3 emission(scene_.emission.at(isovalue));
  return wide::NetMean::Moments{
      .sum = (double(round.rays) - hits) * sky + hits * emission,
      .differences = double(round.changes(block, place)) * (sky - emission) * (sky - emission)};
}

void RayValues::see_sky(const LinkRound& round, const LinkBlock& block, std::size_t place,
                        const std::array<const float*, 3>& towards, Scratch& scratch) const {
  if (sky_ != nullptr) {
    // All rays, those that hit too, without a branch: it is quicker than to choose.
    const Vec3f up = up_;
    const std::size_t rays = round.rays;
    const auto [x, y, z] = towards;
    for (std::size_t c = 0; c < e_.channels; ++c) {
      const float ground = sky_->ground[int(c)];
      const float horizon = sky_->horizon[int(c)];
      const float change = sky_->zenith[int(c)] - horizon;
      float* const sky = scratch.sky[c].data();
      for (std::size_t k = 0; k < rays; ++k) {
        const float sine = x[k] * up.x + y[k] * up.y + z[k] * up.z;
        const float above = horizon + sine * change;
        sky[k] = sine < 0.0f ? ground : above;
      }
    }
    return;
  }
  for (std::size_t at = 0; at < round.rays; ++at) {
    if (round.hit(block, place, at)) continue;
    const std::uint32_t k = round.order[at];
    const Vec3 radiance = environment_.radiance({towards[0][k], towards[1][k], towards[2][k]});
    for (std::size_t c = 0; c < e_.channels; ++c) scratch.sky[c][k] = float(radiance[int(c)]);
  }
}

wide::NetMean::Moments RayValues::moments(const LinkRound& round, const LinkBlock& block, std::size_t place,
                                          float isovalue, const std::array<const float*, 3>& towards,
                                          Scratch& scratch) const {
  if (uniform_ == nullptr) see_sky(round, block, place, towards, scratch);
  const Vec3f albedo(scene_.albedo.at(isovalue));
  const Vec3f emission(scene_.emission.at(isovalue));
  const std::uint32_t* targets = block.targets.data() + block.begins[place];
  const std::size_t count = block.begins[place + 1] - block.begins[place];
  const std::uint64_t* hits = &block.hits[place * round.words()];
  wide::NetMean::Moments result;
  for (std::size_t c = 0; c < e_.channels; ++c) {
    float* reflected = scratch.reflected[c].data();
    if (e_.empty()) {
      std::fill_n(reflected, round.rays, emission[int(c)]);
    } else {
      for (std::size_t i = 0; i < count; ++i)
        reflected[i] = emission[int(c)] + albedo[int(c)] * e_.at(targets[i], c, isovalue);
    }
    if (uniform_ != nullptr) std::fill_n(scratch.sky[c].data(), round.rays, uniform_->radiance[int(c)]);
    const float* sky = scratch.sky[c].data();
    double sum = 0.0;
    double differences = 0.0;
    double last = 0.0;
    for (std::size_t at = 0; at < round.rays; ++at) {
      // Hits are a matter of chance: no branch waits for them.
      const std::uint64_t hit = hits[at / 64] >> at % 64 & 1;
      const float brought[2] = {sky[round.order[at]], *reflected};
      const auto value = double(brought[hit]);
      reflected += hit;
      sum += value;
      const double step = at > 0 ? value - last : 0.0;
      differences += step * step;
      last = value;
    }
    result.sum[int(c)] = sum;
    result.differences[int(c)] = differences;
  }
  return result;
}

}  // namespace isolux
