#pragma once

#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <array>
#include <glm/matrix.hpp>
#include <optional>
#include <vector>

namespace isolux {

/// How open the level sets are in front of sites (index space, with isovalues and outer normals): one, two and four
/// mean grid spacings along the normal, -1 (closed) to 1 (open), 0 where there is no gradient. The openness with which
/// texels' own light (TexelLight::kOwn) is read between them. Some tenths of a microsecond a site, on one thread.
[[nodiscard]] std::vector<Vec3f> openness_before(const Volume& volume, const Sites& sites);

/// Weighted least squares for the weights of texels' near-field terms: what places have more of openness than their
/// surroundings, and what of light.
class NearFieldFit {
 public:
  /// \pre openness at the three steps of openness_before(); light of so many channels
  void add(const Vec3& openness, const Vec3& light, int channels, double weight) {
    openness_ += weight * glm::outerProduct(openness, openness);
    for (int c = 0; c < channels; ++c) {
      by_channel_[std::size_t(c)] += weight * light[c] * openness;
      light_[c] += weight * light[c] * light[c];
    }
    rows_ += 1.0;
  }
  void operator+=(const NearFieldFit& more);

  /// The weights of a channel's terms; none if they explain no more than chance would with so many `rows` in all, or
  /// are worth more than there is of `light` (root mean square): near a lamp inside the volume openness hardly changes,
  /// but as light does.
  [[nodiscard]] std::optional<Vec3> weights(int channel, double light, double rows) const;
  /// Places added.
  [[nodiscard]] double rows() const { return rows_; }

 private:
  Mat3 openness_{0.0};                ///< squares and products
  std::array<Vec3, 3> by_channel_{};  ///< of openness with light
  Vec3 light_{0.0};                   ///< squares, by channel
  double rows_ = 0.0;
};

}  // namespace isolux
