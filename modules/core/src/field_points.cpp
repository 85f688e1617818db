// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field_points.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>
#include <isolux/core/field_points.h>

#include <algorithm>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace isolux {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::ScalableTag<double>;
using Doubles = hn::Vec<DoubleTag>;
using FloatTag = hn::Rebind<float, DoubleTag>;
using Floats = hn::Vec<FloatTag>;
using IntTag = hn::Rebind<std::int32_t, DoubleTag>;
using Ints = hn::Vec<IntTag>;
inline constexpr DoubleTag kD{};
inline constexpr FloatTag kF{};
inline constexpr IntTag kI{};

/// Products and sums are rounded one by one, as in TrilinearField: contraction is off, so no MulAdd here either.
HWY_INLINE Doubles mix(Doubles a, Doubles b, Doubles t) { return hn::Add(a, hn::Mul(t, hn::Sub(b, a))); }

/// A vector of points: their cells, and where they lie in them.
struct Places {
  Ints cell[3];
  Doubles fraction[3];
  Ints corner;  ///< number of the cell's first grid point
};

HWY_INLINE Places places_of(const Index3& size, const double* const (&points)[3]) {
  Places p;
  for (int a = 0; a < 3; ++a) {
    const auto last = hn::Set(kD, double(size[a] - 1));
    const Doubles x = hn::Min(hn::Max(hn::LoadU(kD, points[a]), hn::Zero(kD)), last);
    p.cell[a] = hn::Min(hn::DemoteTo(kI, x), hn::Set(kI, size[a] - 2));
    p.fraction[a] = hn::Sub(x, hn::PromoteTo(kD, p.cell[a]));
  }
  const Ints row = hn::Add(hn::Mul(p.cell[2], hn::Set(kI, size.y)), p.cell[1]);
  p.corner = hn::Add(hn::Mul(row, hn::Set(kI, size.x)), p.cell[0]);
  return p;
}

/// The values at the grid points `step` after those given.
HWY_INLINE Floats gather(const float* data, Ints at, std::int32_t step) {
  return hn::GatherIndex(kF, data, hn::Add(at, hn::Set(kI, step)));
}

/// Steps from a cell's first corner to corner q.
HWY_INLINE std::int32_t corner_step(const std::int32_t (&stride)[3], int q) {
  return (q & 1) * stride[0] + (q >> 1 & 1) * stride[1] + (q >> 2) * stride[2];
}

HWY_INLINE Doubles interpolate(const Floats (&corners)[8], const Places& p) {
  Doubles v[8];
  for (int q = 0; q < 8; ++q) v[q] = hn::PromoteTo(kD, corners[q]);
  const auto& f = p.fraction;
  return mix(mix(mix(v[0], v[1], f[0]), mix(v[2], v[3], f[0]), f[1]),
             mix(mix(v[4], v[5], f[0]), mix(v[6], v[7], f[0]), f[1]), f[2]);
}

/// Where all eight corners have both neighbours on each axis.
HWY_INLINE hn::Mask<IntTag> is_inside(const Places& p, const Index3& size) {
  auto outside = hn::Zero(kI);
  for (int a = 0; a < 3; ++a) {
    outside = hn::Or(outside, hn::VecFromMask(kI, hn::Lt(p.cell[a], hn::Set(kI, 1))));
    outside = hn::Or(outside, hn::VecFromMask(kI, hn::Gt(p.cell[a], hn::Set(kI, size[a] - 3))));
  }
  return hn::Eq(outside, hn::Zero(kI));
}

/// Interpolated central differences. \pre all corners have both neighbours
HWY_INLINE void central_differences(const float* data, const std::int32_t (&stride)[3], const Places& p,
                                    const Floats (&corners)[8], Doubles (&sum)[3]) {
  const auto one = hn::Set(kD, 1.0);
  const auto half = hn::Set(kD, 0.5);
  Doubles weights[3][2];
  for (int a = 0; a < 3; ++a) {
    weights[a][0] = hn::Sub(one, p.fraction[a]);
    weights[a][1] = p.fraction[a];
    sum[a] = hn::Zero(kD);
  }
  for (int q = 0; q < 8; ++q) {
    const Doubles weight = hn::Mul(hn::Mul(weights[0][q & 1], weights[1][q >> 1 & 1]), weights[2][q >> 2]);
    for (int a = 0; a < 3; ++a) {
      // One of a corner's two neighbours on an axis is a corner as well.
      const Floats across = corners[q ^ (1 << a)];
      const bool is_last = (q >> a & 1) != 0;
      const std::int32_t beyond = corner_step(stride, q) + (is_last ? stride[a] : -stride[a]);
      const Doubles neighbour = hn::PromoteTo(kD, gather(data, p.corner, beyond));
      const Doubles other = hn::PromoteTo(kD, across);
      const Doubles difference = is_last ? hn::Sub(neighbour, other) : hn::Sub(other, neighbour);
      sum[a] = hn::Add(sum[a], hn::Mul(weight, hn::Mul(half, difference)));
    }
  }
}

struct FieldData {
  const TrilinearField& field;
  const float* data;
  Index3 size;
  std::int32_t stride[3];
};

FieldData data_of(const TrilinearField& field) {
  const Index3& size = field.lattice().size;
  return {field, field.data(), size, {1, size.x, size.x * size.y}};
}

/// Calls look(points, number of the first, how many count) vector by vector; the last is filled up with its last point.
template <class Look>
void for_each_vector(const Points& points, const Look& look) {
  const std::size_t lanes = hn::Lanes(kD);
  std::size_t i = 0;
  for (; i + lanes <= points.size(); i += lanes) {
    const double* const at[3] = {points.axis(0) + i, points.axis(1) + i, points.axis(2) + i};
    look(at, i, lanes);
  }
  if (i == points.size()) return;
  HWY_ALIGN double rest[3][hn::MaxLanes(kD)];
  for (int a = 0; a < 3; ++a)
    for (std::size_t lane = 0; lane < lanes; ++lane)
      rest[a][lane] = points.axis(a)[std::min(i + lane, points.size() - 1)];
  const double* const at[3] = {rest[0], rest[1], rest[2]};
  look(at, i, points.size() - i);
}

template <class Tag, class Vector, class Value>
HWY_INLINE void store(Tag tag, Vector vector, std::size_t count, Value* out) {
  if (count == hn::Lanes(tag)) {
    hn::StoreU(vector, tag, out);
    return;
  }
  HWY_ALIGN Value lanes[hn::MaxLanes(kD)];
  hn::StoreU(vector, tag, lanes);
  std::copy_n(lanes, count, out);
}

void sample_values(const TrilinearField& field, const Points& points, double* values) {
  const FieldData f = data_of(field);
  for_each_vector(points, [&](const double* const(&at)[3], std::size_t first, std::size_t count) HWY_ATTR {
    const Places p = places_of(f.size, at);
    Floats corners[8];
    for (int q = 0; q < 8; ++q) corners[q] = gather(f.data, p.corner, corner_step(f.stride, q));
    store(kD, interpolate(corners, p), count, values + first);
  });
}

void sample_field(const TrilinearField& field, const Points& points, PointSamples& samples) {
  const FieldData f = data_of(field);
  for_each_vector(points, [&](const double* const(&at)[3], std::size_t first, std::size_t count) HWY_ATTR {
    Places p = places_of(f.size, at);
    Floats corners[8];
    for (int q = 0; q < 8; ++q) corners[q] = gather(f.data, p.corner, corner_step(f.stride, q));
    store(kD, interpolate(corners, p), count, samples.values.data() + first);
    Floats least = corners[0];
    Floats largest = corners[0];
    for (int q = 1; q < 8; ++q) {
      least = hn::Min(least, corners[q]);
      largest = hn::Max(largest, corners[q]);
    }
    store(kF, least, count, samples.least.data() + first);
    store(kF, largest, count, samples.largest.data() + first);
    const auto inside = is_inside(p, f.size);
    if (!hn::AllFalse(kI, inside)) {
      // The others look somewhere, in vain.
      const Ints somewhere = hn::Set(kI, f.stride[0] + f.stride[1] + f.stride[2]);
      p.corner = hn::IfThenElse(inside, p.corner, somewhere);
      Doubles gradient[3];
      central_differences(f.data, f.stride, p, corners, gradient);
      for (std::size_t a = 0; a < 3; ++a) store(kD, gradient[a], count, samples.gradients[a].data() + first);
    }
    if (hn::AllTrue(kI, inside)) return;
    HWY_ALIGN std::int32_t is_done[hn::MaxLanes(kD)];
    hn::Store(hn::VecFromMask(kI, inside), kI, is_done);
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (is_done[lane] != 0) continue;
      const Vec3 gradient_here = field.smooth_gradient(points.at(first + lane));
      for (std::size_t a = 0; a < 3; ++a) samples.gradients[a][first + lane] = gradient_here[int(a)];
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux {

HWY_EXPORT(sample_values);
HWY_EXPORT(sample_field);

namespace {

/// Whether grid points have numbers of 32 bits.
bool has_small_numbers(const TrilinearField& field) {
  return field.lattice().count() <= std::size_t(std::numeric_limits<std::int32_t>::max());
}

void sample_one(const TrilinearField& field, const Points& points, std::size_t i, PointSamples& samples) {
  const Vec3 index = points.at(i);
  samples.values[i] = field.value(index);
  const Vec3 gradient = field.smooth_gradient(index);
  for (std::size_t a = 0; a < 3; ++a) samples.gradients[a][i] = gradient[int(a)];
  const ValueRange corners = field.corner_range(index);
  samples.least[i] = corners.low;
  samples.largest[i] = corners.high;
}

}  // namespace

void PointSamples::resize(std::size_t count) {
  values.resize(count);
  for (auto& axis : gradients) axis.resize(count);
  least.resize(count);
  largest.resize(count);
}

void sample_values(const TrilinearField& field, const Points& points, std::vector<double>& values) {
  values.resize(points.size());
  if (has_small_numbers(field)) {
    HWY_DYNAMIC_DISPATCH(sample_values)(field, points, values.data());
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i) values[i] = field.value(points.at(i));
}

void sample_field(const TrilinearField& field, const Points& points, PointSamples& samples) {
  samples.resize(points.size());
  if (has_small_numbers(field)) {
    HWY_DYNAMIC_DISPATCH(sample_field)(field, points, samples);
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i) sample_one(field, points, i, samples);
}

}  // namespace isolux
#endif
