// Volumes that the tests share.
#pragma once

#include <isolux/core/random.h>
#include <isolux/core/volume.h>

#include <functional>
#include <glm/geometric.hpp>

namespace isolux::testing {

/// The frame of an n^3 grid on the unit cube.
inline IndexToWorld unit_cube(int n) { return {.origin = Vec3(0.0), .axes = Mat3(1.0 / (n - 1))}; }

/// f(world) at every grid point.
inline Volume sampled(const Index3& size, const IndexToWorld& frame, const std::function<double(const Vec3&)>& f) {
  Volume volume;
  volume.values = Grid<float>(Lattice{.size = size, .frame = frame});
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) volume.values(i, j, k) = float(f(frame.world(Vec3(i, j, k))));
  return volume;
}

/// Minus the distance to the centre of the unit cube: the level set -r is a sphere of radius r, higher inside.
inline Volume ball(int n) {
  return sampled(Index3(n), unit_cube(n), [](const Vec3& p) { return -glm::distance(p, Vec3(0.5)); });
}

inline Volume gyroid(int n) {
  return sampled(Index3(n), unit_cube(n), [](const Vec3& p) {
    const Vec3 x = p * 12.566370614359172;
    return std::sin(x.x) * std::cos(x.y) + std::sin(x.y) * std::cos(x.z) + std::sin(x.z) * std::cos(x.x);
  });
}

/// Uniform noise in [0, 1), or integers 0 .. levels - 1 where `levels` is given.
inline Volume noise(const Index3& size, std::uint64_t seed, int levels = 0) {
  RandomStream random(seed, 0);
  return sampled(size, {}, [&](const Vec3& /*p*/) {
    const double u = random.uniform_float();
    return levels > 0 ? std::floor(u * levels) : u;
  });
}

/// 2 to 9 grid points an axis.
inline Index3 random_size(std::uint64_t seed) {
  RandomStream random(seed, 1);
  const auto axis = [&] { return 2 + int(random.next_bits() % 8); };
  const int x = axis();
  const int y = axis();
  return {x, y, axis()};
}

}  // namespace isolux::testing
