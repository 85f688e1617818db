#pragma once

#include <isolux/core/field.h>
#include <isolux/core/random.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace isolux::testing {

/// A volume of `size` grid points of `spacing` whose values are `f` of the grid point.
inline Volume make_volume(Index3 size, const Vec3& spacing, const std::function<double(const Vec3&)>& f) {
  Lattice lattice{.size = size, .frame = {}};
  for (int a = 0; a < 3; ++a) lattice.frame.axes[a][a] = spacing[a];
  Volume volume;
  volume.values = Grid<float>(lattice);
  volume.name = "test";
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) volume.values(i, j, k) = float(f({i, j, k}));
  return volume;
}

inline Volume ramp_volume(Index3 size, const Vec3& spacing = Vec3(1.0)) {
  return make_volume(size, spacing, [](const Vec3& p) { return p.x + 0.25 * p.y - 0.5 * p.z; });
}

/// Waves of some seven voxels and a slope.
inline Volume wavy_volume() {
  return make_volume({12, 10, 9}, {1.0, 0.7, 2.0}, [](const Vec3& p) {
    return std::sin(0.9 * p.x) + 0.8 * std::cos(0.8 * p.y + 0.3 * p.z) + 0.1 * p.z;
  });
}

/// One sample: position in index space, everything else plausible.
inline void add_sample(SampleSet& set, const Volume& volume, const Vec3& position, const std::vector<float>& radiance,
                       float variance = 0.0f) {
  const TrilinearField field(volume);
  set.sites.positions.emplace_back(position);
  set.sites.isovalues.push_back(float(field.value(Vec3(Vec3f(position)))));
  set.sites.normals.emplace_back(field.normal(position, OuterSide::kLower, GradientKind::kCentralDifferences));
  set.channels = int(radiance.size());
  set.radiance.insert(set.radiance.end(), radiance.begin(), radiance.end());
  set.variance.push_back(variance);
}

using Light = std::function<float(const Vec3& index, int channel)>;

/// `count` samples at random places of the box.
inline SampleSet random_samples(const Volume& volume, std::size_t count, int channels, const Light& light,
                                std::uint64_t seed = 1) {
  SampleSet set;
  for (std::size_t s = 0; s < count; ++s) {
    RandomStream random(seed, s);
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = random.uniform_float() * float(volume.lattice().size[a] - 1);
    std::vector<float> radiance(std::size_t(channels), 0.0f);
    for (int c = 0; c < channels; ++c) radiance[std::size_t(c)] = light(p, c);
    add_sample(set, volume, p, radiance);
  }
  return set;
}

}  // namespace isolux::testing
