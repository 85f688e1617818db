// Volumes sampled from formulas, for the tests and benches of every module.
#pragma once

#include <isolux/core/random.h>
#include <isolux/core/volume.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>

namespace isolux::test {

/// A volume of `size` grid points whose value at world position p is field(p); any frame.
template <class Field>
[[nodiscard]] Volume sampled(const Lattice& lattice, Field&& field, std::string name = "test") {
  Volume volume{.values = Grid<float>(lattice), .name = std::move(name)};
  for (int k = 0; k < lattice.size.z; ++k)
    for (int j = 0; j < lattice.size.y; ++j)
      for (int i = 0; i < lattice.size.x; ++i) volume.values(i, j, k) = float(field(lattice.frame.world({i, j, k})));
  return volume;
}

/// n^3 grid points over the unit cube, first and last on its faces, as the gen: volumes have them.
[[nodiscard]] inline Lattice unit_cube(int n) {
  return {.size = Index3(n), .frame = {.origin = Vec3(0.0), .axes = Mat3(1.0 / (n - 1))}};
}

template <class Field>
[[nodiscard]] Volume unit_cube_volume(int n, Field&& field) {
  return sampled(unit_cube(n), std::forward<Field>(field));
}

inline constexpr double kCenter = 0.5;

[[nodiscard]] inline Volume sphere(int n) {
  return unit_cube_volume(n, [](const Vec3& p) { return -glm::length(p - kCenter); });
}
[[nodiscard]] inline Volume cavity(int n) {
  return unit_cube_volume(n, [](const Vec3& p) { return glm::length(p - kCenter); });
}
[[nodiscard]] inline Volume two_spheres(int n) {
  return unit_cube_volume(n, [](const Vec3& p) {
    return -std::min(glm::length(p - Vec3(0.3, 0.5, 0.5)), glm::length(p - Vec3(0.7, 0.5, 0.5)));
  });
}
[[nodiscard]] inline Volume ball_over_plane(int n) {
  return unit_cube_volume(n, [](const Vec3& p) { return -std::min(p.z, glm::length(p - kCenter) - 0.1); });
}
[[nodiscard]] inline Volume gyroid(int n) {
  return unit_cube_volume(n, [](const Vec3& p) {
    const Vec3 q = 4.0 * std::numbers::pi * p;
    return std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
  });
}

/// Independent uniform values in [0, 1), the worst case; `size` grid points on integer positions.
[[nodiscard]] inline Volume noise(Index3 size, std::uint64_t seed) {
  RandomStream random(seed, 0);
  return sampled(
      {.size = size, .frame = {}}, [&random](const Vec3&) { return random.uniform_float(); }, "noise");
}

}  // namespace isolux::test
