#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "wide_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide_vertices.cpp"
#include <hwy/foreach_target.h>
// After it, as Highway wants.
#include <hwy/cache_control.h>
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

/// Crossed grid edges of one axis wait here, i | j << 16, until there are enough to fill vectors.
struct EdgeBatch {
  static constexpr int kCapacity = 256;
  std::array<std::uint32_t, kCapacity + 64 + HWY_MAX_BYTES / 4> edges;
  int count = 0;
  float* positions;
  float* normals;

  /// `ahead` is where the word lies in the highest plane that its edges' gradients read: what other edges have not yet
  /// brought near. Asked for here it is there when the batch is computed.
  void add(std::uint64_t crossed, int j, int word, const float* ahead) {
    const std::uint32_t first = std::uint32_t(64 * word) | std::uint32_t(j) << 16;
    for (; crossed != 0; crossed &= crossed - 1) {
      const int bit = std::countr_zero(crossed);
      hwy::Prefetch(ahead + bit);
      edges[count++] = first + std::uint32_t(bit);
    }
  }
};

struct V3 {
  F x, y, z;
};

/// Central differences across an edge: at its two ends, along one of the axes.
struct Ends {
  F low, high;
};

HWY_INLINE F gather(const float* base, I offsets) { return hn::GatherIndex(kF, base, offsets); }
HWY_INLINE I choose(hn::Mask<Ints> mask, I yes, I no) { return hn::IfThenElse(mask, yes, no); }

/// The edges of one slab along kAxis, a vector at a time.
template <int kAxis>
class VertexMaker {
 public:
  VertexMaker(const MarchState& march, int k, const VertexFrame& frame)
      : march_(march), frame_(frame), k_(k), base_(march.row_values(0, k)), steps_{1, march.nx, march.nx * march.ny} {}

  void flush(EdgeBatch& batch) const {
    const int lanes = int(hn::Lanes(kF));
    // Lanes beyond the last edge compute the first grid point's edge, which is there to read.
    std::memset(batch.edges.data() + batch.count, 0, HWY_MAX_BYTES);
    for (int e = 0; e < batch.count; e += lanes) {
      V3 position;
      V3 normal;
      compute(hn::LoadU(kI, reinterpret_cast<const std::int32_t*>(batch.edges.data()) + e), position, normal);
      const int count = std::min(lanes, batch.count - e);
      store(position, batch.positions + 3 * e, count);
      store(normal, batch.normals + 3 * e, count);
    }
    batch.positions += 3 * batch.count;
    batch.normals += 3 * batch.count;
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

  HWY_INLINE void compute(I edges, V3& position, V3& normal) const {
    const I i = hn::And(edges, hn::Set(kI, 0xffff));
    const I j = hn::ShiftRight<16>(edges);
    const I low = hn::Add(hn::Mul(j, hn::Set(kI, march_.nx)), i);
    const I high = hn::Add(low, hn::Set(kI, steps_[kAxis]));
    const F a = gather(base_, low);
    const F b = gather(base_, high);
    const F isovalue = hn::Set(kF, march_.isovalue);
    const F margin = hn::Set(kF, frame_.margin);
    const F end = hn::Set(kF, 1.0f - frame_.margin);
    F t = hn::Div(hn::Sub(isovalue, a), hn::Sub(b, a));
    // Comparisons with NaN are false, so that the first line also ends NaN.
    t = hn::IfThenElse(hn::Gt(t, margin), t, margin);
    t = hn::IfThenElse(hn::Lt(t, end), t, end);
    position = world(i, j, t);
    const Ends x = difference<0>(i, march_.nx, low, high, a, b);
    const Ends y = difference<1>(j, march_.ny, low, high, a, b);
    const Ends z = difference<2>(hn::Set(kI, k_), march_.nz, low, high, a, b);
    const auto mix = [&](const Ends& g) HWY_ATTR { return hn::Add(g.low, hn::Mul(t, hn::Sub(g.high, g.low))); };
    normal = outwards({mix(x), mix(y), mix(z)}, a, b);
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

  /// The field's central differences along kAlong at both ends, one-sided on the box's faces. `place` is the lower
  /// end's coordinate on that axis.
  template <int kAlong>
  HWY_INLINE Ends difference(I place, int size, I low, I high, F a, F b) const {
    const I step = hn::Set(kI, steps_[kAlong]);
    const F half = hn::Set(kF, 0.5f);
    const F one = hn::Set(kF, 1.0f);
    const auto has_lower = hn::Gt(place, hn::Zero(kI));
    if constexpr (kAlong == kAxis) {
      const auto has_upper = hn::Lt(place, hn::Set(kI, size - 2));
      const F below = gather(base_, choose(has_lower, hn::Sub(low, step), low));
      const F above = gather(base_, choose(has_upper, hn::Add(high, step), high));
      return {hn::Mul(hn::Sub(b, below), hn::IfThenElse(hn::RebindMask(kF, has_lower), half, one)),
              hn::Mul(hn::Sub(above, a), hn::IfThenElse(hn::RebindMask(kF, has_upper), half, one))};
    } else {
      const auto has_upper = hn::Lt(place, hn::Set(kI, size - 1));
      const I down = hn::IfThenElseZero(has_lower, step);
      const I up = hn::IfThenElseZero(has_upper, step);
      const F scale = hn::IfThenElse(hn::RebindMask(kF, hn::And(has_lower, has_upper)), half, one);
      return {hn::Mul(hn::Sub(gather(base_, hn::Add(low, up)), gather(base_, hn::Sub(low, down))), scale),
              hn::Mul(hn::Sub(gather(base_, hn::Add(high, up)), gather(base_, hn::Sub(high, down))), scale)};
    }
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
  const float* base_;
  std::array<int, 3> steps_;
};

void make_vertices_wide(const MarchState& march, int k, const VertexFrame& frame, float* positions, float* normals) {
  const Slab& slab = march.slabs[k];
  const auto batch_from = [&](std::uint32_t first) HWY_ATTR {
    EdgeBatch batch;
    batch.positions = positions + 3 * std::size_t(first);
    batch.normals = normals + 3 * std::size_t(first);
    return batch;
  };
  EdgeBatch along_x = batch_from(slab.first.vertex_x);
  EdgeBatch along_y = batch_from(slab.first.vertex_y);
  EdgeBatch along_z = batch_from(slab.first.vertex_z);
  const VertexMaker<0> make_x(march, k, frame);
  const VertexMaker<1> make_y(march, k, frame);
  const VertexMaker<2> make_z(march, k, frame);
  const std::uint32_t* active = march.slab_active(k);
  for (std::uint32_t n = 0; n < slab.active_words; ++n) {
    const int j = row_of(active[n]);
    const int word = word_of(active[n]);
    const WordBits bits(march, j, k, word);
    const float* above = march.row_values(j, std::min(k + 1, march.nz - 1)) + 64 * word;
    const float* two_above = march.row_values(j, std::min(k + 2, march.nz - 1)) + 64 * word;
    along_x.add((bits.here[0] ^ bits.next[0]) & march.cell_mask(word), j, word, above);
    along_y.add(bits.here[0] ^ bits.here[1], j, word, above);
    along_z.add(bits.here[0] ^ bits.here[2], j, word, two_above);
    if (along_x.count >= EdgeBatch::kCapacity) make_x.flush(along_x);
    if (along_y.count >= EdgeBatch::kCapacity) make_y.flush(along_y);
    if (along_z.count >= EdgeBatch::kCapacity) make_z.flush(along_z);
  }
  make_x.flush(along_x);
  make_y.flush(along_y);
  make_z.flush(along_z);
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
