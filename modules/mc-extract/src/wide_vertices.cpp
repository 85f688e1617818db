#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>
#include <variant>

#include "edge_values.h"
#include "wide_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide_vertices.cpp"
#include <hwy/foreach_target.h>
// After it, as Highway wants.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace isolux::mc {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
constexpr Floats kF;
constexpr Ints kI;

struct V3 {
  F x, y, z;
};

/// Central differences across an edge: at its two ends, along one of the axes.
struct Ends {
  F low, high;
};

/// A vector of copied values, or of each of the two or four that lie side by side for every edge.
HWY_INLINE F one(const float* values) { return hn::LoadU(kF, values); }
HWY_INLINE void two(const float* values, F& a, F& b) { hn::LoadInterleaved2(kF, values, a, b); }
HWY_INLINE void four(const float* values, F& a, F& b, F& c, F& d) { hn::LoadInterleaved4(kF, values, a, b, c, d); }

/// Byte kByte of each lane, signed or not.
template <class Byte, int kByte>
HWY_INLINE F byte_of(I v) {
  if constexpr (std::is_signed_v<Byte>)
    return hn::ConvertTo(kF, hn::ShiftRight<24>(hn::ShiftLeft<24 - 8 * kByte>(v)));
  else
    return hn::ConvertTo(kF, hn::And(hn::ShiftRight<8 * kByte>(v), hn::Set(kI, 255)));
}

template <class Narrow>
HWY_INLINE F one(const Narrow* values) {
  return hn::ConvertTo(kF, hn::PromoteTo(kI, hn::LoadU(hn::Rebind<Narrow, Ints>(), values)));
}
template <class Narrow>
HWY_INLINE void two(const Narrow* values, F& a, F& b) {
  if constexpr (sizeof(Narrow) == 1) {
    const hn::Rebind<std::uint16_t, Ints> d16;
    const I pairs = hn::PromoteTo(kI, hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(values)));
    a = byte_of<Narrow, 0>(pairs);
    b = byte_of<Narrow, 1>(pairs);
  } else {
    const hn::Rebind<Narrow, Ints> d16;
    hn::Vec<decltype(d16)> v[2];
    hn::LoadInterleaved2(d16, values, v[0], v[1]);
    a = hn::ConvertTo(kF, hn::PromoteTo(kI, v[0]));
    b = hn::ConvertTo(kF, hn::PromoteTo(kI, v[1]));
  }
}
template <class Narrow>
HWY_INLINE void four(const Narrow* values, F& a, F& b, F& c, F& d) {
  if constexpr (sizeof(Narrow) == 1) {
    const I fours = hn::LoadU(kI, reinterpret_cast<const std::int32_t*>(values));
    a = byte_of<Narrow, 0>(fours);
    b = byte_of<Narrow, 1>(fours);
    c = byte_of<Narrow, 2>(fours);
    d = byte_of<Narrow, 3>(fours);
  } else {
    const hn::Rebind<Narrow, Ints> d16;
    hn::Vec<decltype(d16)> v[4];
    hn::LoadInterleaved4(d16, values, v[0], v[1], v[2], v[3]);
    a = hn::ConvertTo(kF, hn::PromoteTo(kI, v[0]));
    b = hn::ConvertTo(kF, hn::PromoteTo(kI, v[1]));
    c = hn::ConvertTo(kF, hn::PromoteTo(kI, v[2]));
    d = hn::ConvertTo(kF, hn::PromoteTo(kI, v[3]));
  }
}

/// The edges of one slab along kAxis, a vector at a time.
template <int kAxis, class Value>
class VertexMaker {
 public:
  VertexMaker(const MarchState& march, int k, const VertexFrame& frame) : march_(march), frame_(frame), k_(k) {}

  void flush(EdgeBatch& batch) {
    const int lanes = int(hn::Lanes(kF));
    constexpr int kStep = EdgeValues<kAxis, Value>::kCapacity;
    for (int first = 0; first < batch.count; first += kStep) {
      const std::uint32_t* edges = batch.edges.data() + first;
      const int end = std::min(kStep, batch.count - first);
      values_.copy(march_, k_, edges, end);
      // Lanes beyond the last edge compute what is never stored.
      for (int e = 0; e < end; e += lanes) {
        V3 position;
        V3 normal;
        compute(edges, e, position, normal);
        const int count = std::min(lanes, end - e);
        store(position, batch.positions, count);
        store(normal, batch.normals, count);
        batch.positions += 3 * count;
        batch.normals += 3 * count;
      }
    }
    batch.count = 0;
  }

 private:
  static void store(const V3& v, float* out, int count) {
    if (count == int(hn::Lanes(kF))) {
      hn::StoreInterleaved3(v.x, v.y, v.z, kF, out);
    } else {
      HWY_ALIGN float last[3 * HWY_MAX_BYTES / 4];
      hn::StoreInterleaved3(v.x, v.y, v.z, kF, last);
      std::memcpy(out, last, sizeof(float) * 3 * std::size_t(count));
    }
  }

  HWY_INLINE void compute(const std::uint32_t* batch, int e, V3& position, V3& normal) const {
    const I edges = hn::LoadU(kI, reinterpret_cast<const std::int32_t*>(batch) + e);
    const I i = hn::And(edges, hn::Set(kI, 0xffff));
    const I j = hn::ShiftRight<16>(edges);
    const I k = hn::Set(kI, k_);
    F a;
    F b;
    F before;
    F after;
    Ends x;
    Ends y;
    Ends z;
    four(&values_.low[4 * e], before, a, b, after);
    if constexpr (kAxis == 0) {
      x = along(i, march_.nx, before, a, b, after);
      y = across(j, march_.ny, pair(&values_.low_down[2 * e]), pair(&values_.low_up[2 * e]));
      z = across(k, march_.nz, pair(&values_.high_down[2 * e]), pair(&values_.high_up[2 * e]));
    } else {
      Ends down{before, before};
      Ends up{b, b};
      four(&values_.high[4 * e], down.high, b, up.high, after);
      x = across(i, march_.nx, down, up);
      const Ends down_across{one(&values_.low_down[e]), one(&values_.high_down[e])};
      const Ends up_across{one(&values_.low_up[e]), one(&values_.high_up[e])};
      before = one(&values_.before[e]);
      after = one(&values_.beyond[e]);
      y = kAxis == 1 ? along(j, march_.ny, before, a, b, after) : across(j, march_.ny, down_across, up_across);
      z = kAxis == 2 ? along(k, march_.nz, before, a, b, after) : across(k, march_.nz, down_across, up_across);
    }
    const F isovalue = hn::Set(kF, march_.isovalue);
    const F margin = hn::Set(kF, frame_.margin[kAxis]);
    const F end = hn::Set(kF, 1.0f - frame_.margin[kAxis]);
    F t = hn::Div(hn::Sub(isovalue, a), hn::Sub(b, a));
    // Comparisons with NaN are false, so that the first line also ends NaN.
    t = hn::IfThenElse(hn::Gt(t, margin), t, margin);
    t = hn::IfThenElse(hn::Lt(t, end), t, end);
    position = world(i, j, t);
    const auto mix = [&](const Ends& g) HWY_ATTR { return hn::Add(g.low, hn::Mul(t, hn::Sub(g.high, g.low))); };
    normal = outwards({mix(x), mix(y), mix(z)}, a, b);
  }

  HWY_INLINE static Ends pair(const Value* values) {
    Ends ends;
    two(values, ends.low, ends.high);
    return ends;
  }

  HWY_INLINE V3 world(I i, I j, F t) const {
    F x = hn::ConvertTo(kF, i);
    F y = hn::ConvertTo(kF, j);
    F z = hn::Set(kF, float(k_));
    if constexpr (kAxis == 0) x = hn::Add(x, t);
    if constexpr (kAxis == 1) y = hn::Add(y, t);
    if constexpr (kAxis == 2) z = hn::Add(z, t);
    const auto along = [&](int w) HWY_ATTR {
      return hn::Add(hn::Set(kF, frame_.origin[w]), combine(frame_.axes, w, {x, y, z}));
    };
    return {along(0), along(1), along(2)};
  }

  /// Component w of m[0] v.x + m[1] v.y + m[2] v.z.
  HWY_INLINE static F combine(const float (&m)[3][3], int w, const V3& v) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(kF, m[0][w]), v.x), hn::Mul(hn::Set(kF, m[1][w]), v.y)),
                   hn::Mul(hn::Set(kF, m[2][w]), v.z));
  }

  /// The field's central differences at both ends of the edge, one-sided on the box's faces: along it, from the values
  /// before it, at its ends a and b, and after it. `place` is the lower end's coordinate on that axis.
  HWY_INLINE static Ends along(I place, int size, F before, F a, F b, F after) {
    const F half = hn::Set(kF, 0.5f);
    const F one = hn::Set(kF, 1.0f);
    const auto has_lower = hn::RebindMask(kF, hn::Gt(place, hn::Zero(kI)));
    const auto has_upper = hn::RebindMask(kF, hn::Lt(place, hn::Set(kI, size - 2)));
    return {hn::Mul(hn::Sub(b, before), hn::IfThenElse(has_lower, half, one)),
            hn::Mul(hn::Sub(after, a), hn::IfThenElse(has_upper, half, one))};
  }
  /// The same along another axis, from the values one step down and up from each end.
  HWY_INLINE static Ends across(I place, int size, const Ends& down, const Ends& up) {
    const auto inner = hn::And(hn::Gt(place, hn::Zero(kI)), hn::Lt(place, hn::Set(kI, size - 1)));
    const F scale = hn::IfThenElse(hn::RebindMask(kF, inner), hn::Set(kF, 0.5f), hn::Set(kF, 1.0f));
    return {hn::Mul(hn::Sub(up.low, down.low), scale), hn::Mul(hn::Sub(up.high, down.high), scale)};
  }

  /// The unit vector outwards for the gradient g, or along the edge where g is rounding noise, zero or not finite: the
  /// rule of TrilinearField::normal.
  HWY_INLINE V3 outwards(const V3& g, F a, F b) const {
    const F largest = hn::Max(hn::Abs(g.x), hn::Max(hn::Abs(g.y), hn::Abs(g.z)));
    const F noise = hn::Mul(hn::Set(kF, 1e-7f), hn::Max(hn::Abs(a), hn::Abs(b)));
    // Scaled by the largest component first: its square could under- or overflow.
    const V3 scaled = {hn::Div(g.x, largest), hn::Div(g.y, largest), hn::Div(g.z, largest)};
    const V3 n = {combine(frame_.outwards, 0, scaled), combine(frame_.outwards, 1, scaled),
                  combine(frame_.outwards, 2, scaled)};
    const F squared = hn::Add(hn::Add(hn::Mul(n.x, n.x), hn::Mul(n.y, n.y)), hn::Mul(n.z, n.z));
    const F inverse = hn::Div(hn::Set(kF, 1.0f), hn::Sqrt(squared));
    const auto valid =
        hn::And(hn::Gt(largest, noise), hn::And(hn::Gt(squared, hn::Zero(kF)), hn::Lt(squared, hn::Set(kF, 1e30f))));
    const F isovalue = hn::Set(kF, march_.isovalue);
    const auto low_inside = march_.outer == OuterSide::kLower ? hn::Ge(a, isovalue) : hn::Le(a, isovalue);
    const F sign = hn::IfThenElse(low_inside, hn::Set(kF, 1.0f), hn::Set(kF, -1.0f));
    const auto pick = [&](F component, int w) HWY_ATTR {
      return hn::IfThenElse(valid, hn::Mul(component, inverse),
                            hn::Mul(sign, hn::Set(kF, frame_.along_edge[kAxis][w])));
    };
    return {pick(n.x, 0), pick(n.y, 1), pick(n.z, 2)};
  }

  const MarchState& march_;
  const VertexFrame& frame_;
  int k_;
  EdgeValues<kAxis, Value> values_;
};

template <class Value>
void make_vertices_from(const MarchState& march, int k, const VertexFrame& frame, float* positions, float* normals) {
  const Slab& slab = march.slabs[k];
  const auto at = [](float* first, std::uint32_t vertex) { return first + 3 * std::size_t(vertex); };
  EdgeBatch along_x(at(positions, slab.first.vertex_x), at(normals, slab.first.vertex_x));
  EdgeBatch along_y(at(positions, slab.first.vertex_y), at(normals, slab.first.vertex_y));
  EdgeBatch along_z(at(positions, slab.first.vertex_z), at(normals, slab.first.vertex_z));
  VertexMaker<0, Value> make_x(march, k, frame);
  VertexMaker<1, Value> make_y(march, k, frame);
  VertexMaker<2, Value> make_z(march, k, frame);
  const std::uint32_t* active = march.slab_active(k);
  const std::uint64_t* bits = march.row_bits(0, k);
  const std::uint64_t* upper_bits = march.row_bits(0, std::min(k + 1, march.nz - 1));
  const Value* two_above = march.row_values<Value>(0, std::min(k + 2, march.nz - 1));
  for (std::uint32_t n = 0; n < slab.active_words; ++n) {
    const int j = row_of(active[n]);
    const int word = word_of(active[n]);
    const std::size_t place = std::size_t(j) * std::size_t(march.words) + std::size_t(word);
    const std::uint64_t here = bits[place];
    const std::uint64_t next = march.next_bits(bits + place - word, word);
    const std::uint64_t next_row = j + 1 < march.ny ? bits[place + std::size_t(march.words)] : here;
    along_x.add((here ^ next) & march.cell_mask(word), j, word);
    along_y.add(here ^ next_row, j, word);
    along_z.add(here ^ upper_bits[place], j, word,
                two_above + std::size_t(j) * std::size_t(march.nx) + std::size_t(64 * word));
    if (along_x.full()) make_x.flush(along_x);
    if (along_y.full()) make_y.flush(along_y);
    if (along_z.full()) make_z.flush(along_z);
  }
  make_x.flush(along_x);
  make_y.flush(along_y);
  make_z.flush(along_z);
}

void make_vertices_wide(const MarchState& march, int k, const VertexFrame& frame, float* positions, float* normals) {
  std::visit([&]<class Value>(
                 std::span<const Value> /*values*/) { make_vertices_from<Value>(march, k, frame, positions, normals); },
             march.voxels);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace isolux::mc
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::mc {

HWY_EXPORT(make_vertices_wide);

void make_vertices(const MarchState& march, int k, const VertexFrame& frame, float* positions, float* normals) {
  HWY_DYNAMIC_DISPATCH(make_vertices_wide)(march, k, frame, positions, normals);
}

}  // namespace isolux::mc
#endif
