// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/draw_corners.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "wide/draw_corners.h"

HWY_BEFORE_NAMESPACE();
namespace isolux::wide {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using CornerTag = hn::CappedTag<float, CornerDraws::kMost>;
using CornerFloats = hn::Vec<CornerTag>;

/// Of the range of isovalues, the part that is a standard deviation of the weight; others are measured in
/// docs/decisions/0006-one-texel-a-link.md.
inline constexpr float kIsovalueWidth = 0.06f;

HWY_INLINE void weigh_places(const CornerDraws& draws, std::size_t lane, CornerFloats (&weights)[8]) {
  const CornerTag f;
  CornerFloats share[3][2];
  for (int a = 0; a < 3; ++a) {
    share[a][1] = hn::LoadU(f, draws.part[a] + lane);
    share[a][0] = hn::Sub(hn::Set(f, 1.0f), share[a][1]);
  }
  for (unsigned q = 0; q < 8; ++q)
    weights[q] = hn::Mul(hn::Mul(share[0][q & 1u], share[1][q >> 1 & 1u]), share[2][q >> 2]);
}

HWY_INLINE void weigh_isovalues(const CornerDraws& draws, std::size_t lane, CornerFloats (&weights)[8]) {
  const CornerTag f;
  const CornerFloats one = hn::Set(f, 1.0f);
  CornerFloats away[8];
  CornerFloats low = hn::Zero(f);
  CornerFloats high = hn::Zero(f);
  for (int q = 0; q < 8; ++q) {
    away[q] = hn::LoadU(f, draws.away[q] + lane);
    low = hn::Min(low, away[q]);
    high = hn::Max(high, away[q]);
  }
  // Where all isovalues are equal the distances are 0; the least range is far from what overflows below.
  const CornerFloats range = hn::Max(hn::Sub(high, low), hn::Set(f, 0x1p-124f));
  const CornerFloats scale = hn::Div(hn::Set(f, 1.0f / (2.8284271f * kIsovalueWidth)), range);
  for (int q = 0; q < 8; ++q) {
    // (1 + x^2 / 8)^-4 is near exp(-x^2 / 2), but never 0, so that some corner always has a weight.
    const CornerFloats x = hn::Mul(away[q], scale);
    const CornerFloats fourth = hn::Div(one, hn::MulAdd(x, x, one));
    const CornerFloats square = hn::Mul(fourth, fourth);
    weights[q] = hn::Mul(weights[q], hn::Mul(square, square));
  }
}

/// Axis by axis from z on, among the corners that are left: of a pair, the upper one by its share of the weight.
HWY_INLINE void choose(CornerDraws& draws, std::size_t lane, CornerFloats (&weights)[8]) {
  const CornerTag f;
  const hn::RebindToUnsigned<CornerTag> u;
  auto corner = hn::Zero(u);
  for (int axis = 2; axis >= 0; --axis) {
    const int half = 1 << axis;
    CornerFloats below = weights[0];
    CornerFloats above = weights[half];
    for (int q = 1; q < half; ++q) {
      below = hn::Add(below, weights[q]);
      above = hn::Add(above, weights[q + half]);
    }
    const CornerFloats uniform = hn::LoadU(f, draws.uniform[axis] + lane);
    const auto is_upper = hn::Lt(hn::Mul(uniform, hn::Add(below, above)), above);
    corner = hn::Or(corner, hn::IfThenElseZero(hn::RebindMask(u, is_upper), hn::Set(u, std::uint32_t(half))));
    for (int q = 0; q < half; ++q) weights[q] = hn::IfThenElse(is_upper, weights[q + half], weights[q]);
  }
  hn::StoreU(corner, u, draws.corner + lane);
}

void find(CornerDraws& draws, std::size_t count, const PointGrid& grid) {
  const CornerTag f;
  const hn::RebindToSigned<CornerTag> i;
  const hn::RebindToUnsigned<CornerTag> u;
  for (std::size_t lane = 0; lane < count; lane += hn::Lanes(f)) {
    CornerFloats index[3];
    for (int a = 0; a < 3; ++a) index[a] = hn::LoadU(f, draws.index[a] + lane);
    auto lowest = hn::Zero(u);
    std::uint32_t stride = 1;
    for (int a = 0; a < 3; ++a) {
      const float* m = grid.axes[a];
      CornerFloats at = hn::MulAdd(hn::Set(f, m[0]), index[0], hn::Set(f, grid.origin[a]));
      at = hn::MulAdd(hn::Set(f, m[1]), index[1], at);
      at = hn::MulAdd(hn::Set(f, m[2]), index[2], at);
      at = hn::Max(hn::Zero(f), hn::Min(at, hn::Set(f, float(grid.size[a] - 1))));
      const auto last = hn::Set(i, std::int32_t(grid.size[a] > 1 ? grid.size[a] - 2 : 0));
      const auto low = hn::Min(hn::ConvertTo(i, at), last);
      hn::StoreU(hn::Sub(at, hn::ConvertTo(f, low)), f, draws.part[a] + lane);
      lowest = hn::Add(lowest, hn::Mul(hn::BitCast(u, low), hn::Set(u, stride)));
      stride *= grid.size[a];
    }
    hn::StoreU(lowest, u, draws.lowest + lane);
  }
}

void draw(CornerDraws& draws, std::size_t count, const CornerWeights& by) {
  const CornerTag f;
  for (std::size_t lane = 0; lane < count; lane += hn::Lanes(f)) {
    CornerFloats weights[8];
    weigh_places(draws, lane, weights);
    if (by.isovalue) weigh_isovalues(draws, lane, weights);
    for (int q = 0; by.likeness && q < 8; ++q) weights[q] = hn::Mul(weights[q], hn::LoadU(f, draws.likeness[q] + lane));
    choose(draws, lane, weights);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isolux::wide
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isolux::wide {

HWY_EXPORT(find);
HWY_EXPORT(draw);

void find_corners(CornerDraws& draws, std::size_t count, const PointGrid& grid) {
  HWY_DYNAMIC_DISPATCH(find)(draws, count, grid);
}

void draw_corners(CornerDraws& draws, std::size_t count, const CornerWeights& by) {
  HWY_DYNAMIC_DISPATCH(draw)(draws, count, by);
}

}  // namespace isolux::wide
#endif
