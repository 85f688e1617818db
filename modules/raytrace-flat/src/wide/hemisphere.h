#pragma once

#include <isolux/core/lattice.h>

#include <cstdint>
#include <vector>

#include "wide/rays.h"

namespace isolux::wide {

/// A point of Sobol's sequence in two dimensions, as 32-bit fractions.
struct SobolPoint {
  std::uint32_t u;
  std::uint32_t v;
};
[[nodiscard]] SobolPoint sobol_point(std::uint64_t index);

/// The first points of Sobol's sequence in two dimensions as 32-bit fractions: every aligned 2^m of them are a
/// (0,m,2)-net. Padded by kPadding.
struct SobolPoints {
  std::vector<std::uint32_t> u;
  std::vector<std::uint32_t> v;

  explicit SobolPoints(std::size_t count);
};

/// Where the rays of a site start, and what turns them.
struct Pose {
  float position[3];  ///< index space
  float isovalue;
  float normal[3];        ///< world space, unit
  std::uint32_t shift_u;  ///< bits of the points to flip: a random digital shift keeps the net and removes its bias
  std::uint32_t shift_v;
};

/// World directions of a batch, unit; structure of arrays as in Rays.
struct Directions {
  std::vector<float> axis[3];

  explicit Directions(std::size_t capacity) {
    for (auto& a : axis) a.resize(capacity + kPadding);
  }
};

/// From world directions to the index space of a volume. Scaled, so that a voxel of the finest axis is about one: t
/// times `world_step` is a length in world units.
struct ToIndex {
  float m[3][3];  ///< row, column
  float world_step;

  explicit ToIndex(const IndexToWorld& frame);
};

/// Writes `count` rays at `at` of the batch, distributed as the cosine about the normal: points [first, first + count)
/// of the sequence. \pre room for them and a vector more
void aim_hemisphere(const Pose& pose, const SobolPoints& points, std::size_t first, std::size_t count,
                    const ToIndex& to_index, std::size_t at, Rays& rays, Directions& world);

/// The same for the first `count` points, even in the cone about the pose's normal whose half angle has that cosine
/// less than 1.
void aim_cone(float one_minus_cosine, const Pose& pose, const SobolPoints& points, std::size_t count,
              const ToIndex& to_index, std::size_t at, Rays& rays, Directions& world);

}  // namespace isolux::wide
