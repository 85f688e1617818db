// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/hemisphere.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "wide/hemisphere.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using Floats = hn::Vec<FloatTag>;

/// The upper 24 bits of shifted fractions as floats in [0, 1).
HWY_INLINE Floats unit(const std::uint32_t* points, std::uint32_t shift) {
  const FloatTag f;
  const hn::RebindToUnsigned<FloatTag> u;
  const hn::RebindToSigned<FloatTag> i;
  const auto bits = hn::ShiftRight<8>(hn::Xor(hn::LoadU(u, points), hn::Set(u, shift)));
  return hn::Mul(hn::ConvertTo(f, hn::BitCast(i, bits)), hn::Set(f, 0x1p-24f));
}

/// What a fraction of a solid angle becomes: distance from the axis, and height along it.
struct OnSphere {
  Floats radius;
  Floats height;
};

struct CosineHemisphere {
  [[nodiscard]] HWY_INLINE OnSphere at(Floats u) const {
    return {.radius = hn::Sqrt(u), .height = hn::Sqrt(hn::Sub(hn::Set(FloatTag(), 1.0f), u))};
  }
};

struct UniformCone {
  float one_minus_cosine;

  [[nodiscard]] HWY_INLINE OnSphere at(Floats u) const {
    const FloatTag f;
    const Floats sunk = hn::Mul(u, hn::Set(f, one_minus_cosine));
    return {.radius = hn::Sqrt(hn::Mul(sunk, hn::Sub(hn::Set(f, 2.0f), sunk))),
            .height = hn::Sub(hn::Set(f, 1.0f), sunk)};
  }
};

template <class Shape>
HWY_INLINE void aim_at(const Shape& shape, const Pose& pose, const SobolPoints& points, std::size_t first,
                       std::size_t count, const ToIndex& to_index, std::size_t at, Rays& rays, Directions& world) {
  const FloatTag f;
  const float* n = pose.normal;
  // The frame of Duff et al., "Building an orthonormal basis, revisited" (JCGT 2017).
  const float sign = std::copysign(1.0f, n[2]);
  const float a = -1.0f / (sign + n[2]);
  const float b = n[0] * n[1] * a;
  const float x[3] = {1.0f + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
  const float y[3] = {b, sign + n[1] * n[1] * a, -n[1]};
  for (std::size_t k = 0; k < count; k += hn::Lanes(f)) {
    const Floats u = unit(points.u.data() + first + k, pose.shift_u);
    const Floats angle =
        hn::Mul(hn::Sub(unit(points.v.data() + first + k, pose.shift_v), hn::Set(f, 0.5f)), hn::Set(f, 6.2831853f));
    const OnSphere on = shape.at(u);
    const Floats px = hn::Mul(on.radius, hn::Cos(f, angle));
    const Floats py = hn::Mul(on.radius, hn::Sin(f, angle));
    const Floats pz = on.height;
    Floats w[3];
    for (int c = 0; c < 3; ++c) {
      w[c] = hn::MulAdd(px, hn::Set(f, x[c]), hn::MulAdd(py, hn::Set(f, y[c]), hn::Mul(pz, hn::Set(f, n[c]))));
      hn::StoreU(w[c], f, world.axis[c].data() + at + k);
    }
    for (int r = 0; r < 3; ++r) {
      const float* m = to_index.m[r];
      const Floats d =
          hn::MulAdd(w[0], hn::Set(f, m[0]), hn::MulAdd(w[1], hn::Set(f, m[1]), hn::Mul(w[2], hn::Set(f, m[2]))));
      hn::StoreU(d, f, rays.direction[r].data() + at + k);
      hn::StoreU(hn::Set(f, pose.position[r]), f, rays.origin[r].data() + at + k);
    }
    hn::StoreU(hn::Set(f, pose.isovalue), f, rays.isovalue.data() + at + k);
  }
}

void aim(const Pose& pose, const SobolPoints& points, std::size_t first, std::size_t count, const ToIndex& to_index,
         std::size_t at, Rays& rays, Directions& world) {
  aim_at(CosineHemisphere{}, pose, points, first, count, to_index, at, rays, world);
}

void cone(float one_minus_cosine, const Pose& pose, const SobolPoints& points, std::size_t count,
          const ToIndex& to_index, std::size_t at, Rays& rays, Directions& world) {
  aim_at(UniformCone{one_minus_cosine}, pose, points, 0, count, to_index, at, rays, world);
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(aim);
HWY_EXPORT(cone);

SobolPoint sobol_point(std::uint64_t index) {
  // Direction numbers: the identity (van der Corput), and Pascal's matrix modulo 2, whose columns each follow from
  // the one before by x ^ (x >> 1).
  SobolPoint point{0, 0};
  std::uint32_t column_u = 1u << 31;
  std::uint32_t column_v = 1u << 31;
  for (; index != 0; index >>= 1) {
    if ((index & 1) != 0) {
      point.u ^= column_u;
      point.v ^= column_v;
    }
    column_u >>= 1;
    column_v ^= column_v >> 1;
  }
  return point;
}

SobolPoints::SobolPoints(std::size_t count) : u(count + kPadding), v(count + kPadding) {
  for (std::size_t i = 0; i < u.size(); ++i) {
    const SobolPoint point = sobol_point(i);
    u[i] = point.u;
    v[i] = point.v;
  }
}

ToIndex::ToIndex(const IndexToWorld& frame) : m{}, world_step(0.0f) {
  const Vec3 spacing = frame.spacing();
  const double step = std::min({spacing.x, spacing.y, spacing.z});
  const Mat3 inverse = glm::inverse(frame.axes);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) m[row][column] = float(inverse[column][row] * step);
  world_step = float(step);
}

void aim_hemisphere(const Pose& pose, const SobolPoints& points, std::size_t first, std::size_t count,
                    const ToIndex& to_index, std::size_t at, Rays& rays, Directions& world) {
  HWY_DYNAMIC_DISPATCH(aim)(pose, points, first, count, to_index, at, rays, world);
}

void aim_cone(float one_minus_cosine, const Pose& pose, const SobolPoints& points, std::size_t count,
              const ToIndex& to_index, std::size_t at, Rays& rays, Directions& world) {
  HWY_DYNAMIC_DISPATCH(cone)(one_minus_cosine, pose, points, count, to_index, at, rays, world);
}

}  // namespace isolux::wide
#endif
