#pragma once

#include <isolux/core/vec.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// Points scattered through the volume, each on its own level set. Structure of arrays, all of one length.
struct Sites {
  std::vector<Vec3f> positions;  ///< index space; as floats they are the sites exactly, not an approximation of them
  std::vector<float> isovalues;  ///< f(position), the level set that a ray from here may meet
  std::vector<Vec3f> normals;    ///< world space, unit, towards the outer side

  [[nodiscard]] std::size_t size() const { return positions.size(); }
};

/// Sites and the light found at them: e = irradiance/pi of the outer side (a radiance), see docs/theory.md.
struct SampleSet {
  Sites sites;
  int channels = 1;             ///< 1 (grey) or 3 (RGB)
  std::vector<float> radiance;  ///< e; `channels` values a site, channel fastest
  std::vector<float> variance;  ///< squared standard error of e, mean over the channels; one a site

  [[nodiscard]] std::size_t size() const { return sites.size(); }
};

}  // namespace isolux
