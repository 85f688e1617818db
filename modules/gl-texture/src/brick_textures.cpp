#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/gl_texture/brick_textures.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "texel_upload.h"

namespace isolux {
namespace {

constexpr int kMostBricks = 1024;  // an axis, as page_entry() has bits for

std::size_t cells(const Index3& n) { return std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z); }

Index3 place_of(std::size_t brick, const Index3& atlas) {
  const auto x = std::size_t(atlas.x);
  const auto y = std::size_t(atlas.y);
  return {int(brick % x), int(brick / x % y), int(brick / (x * y))};
}

/// Bricks, one after the other, as one block of texels.
std::vector<float> arranged(const LightBricks& bricks, std::span<const float> values, const Index3& atlas) {
  constexpr int kTexels = LightBricks::kTexels;
  const auto channels = std::size_t(bricks.channels);
  const auto row = std::size_t(kTexels) * channels;
  const Index3 size = atlas * kTexels;
  std::vector<float> result(cells(size) * channels, 0.0f);
  const float* from = values.data();
  for (std::size_t b = 0; b < bricks.count(); ++b) {
    const Index3 first = place_of(b, atlas) * kTexels;
    for (int k = 0; k < kTexels; ++k) {
      for (int j = 0; j < kTexels; ++j, from += row) {
        const std::size_t texel =
            (std::size_t(first.z + k) * std::size_t(size.y) + std::size_t(first.y + j)) * std::size_t(size.x) +
            std::size_t(first.x);
        std::copy_n(from, row, &result[texel * channels]);
      }
    }
  }
  return result;
}

}  // namespace

Index3 atlas_size(std::size_t count) {
  std::size_t side = 1;
  while (side * side * side < count) ++side;
  return {int(side), int(side), int(std::max<std::size_t>((count + side * side - 1) / (side * side), 1))};
}

BrickTextures upload_bricks(const LightBricks& bricks, TexelFormat format) {
  const Index3 atlas = atlas_size(bricks.count());
  if (atlas.x > kMostBricks) {
    throw InvalidInput(fmt::format("light in {} bricks: an atlas holds at most {} an axis; bake a narrower range",
                                   bricks.count(), kMostBricks));
  }
  std::vector<std::uint32_t> entries(bricks.slots.size());
  std::transform(bricks.slots.begin(), bricks.slots.end(), entries.begin(), [&](std::uint32_t slot) {
    return slot == LightBricks::kAbsent ? 0u : page_entry(place_of(slot, atlas));
  });
  const Index3 size = atlas * LightBricks::kTexels;
  BrickTextures result;
  result.pages = upload_packed(bricks.pages, entries);
  const auto upload = [&](const std::vector<float>& values) {
    return upload_texels(size, bricks.channels, arranged(bricks, values, atlas), format, {});
  };
  result.values = upload(bricks.values);
  if (!bricks.slopes.empty()) result.slopes = upload(bricks.slopes);
  for (unsigned a = 0; a < 3; ++a)
    if (!bricks.normal_slopes[a].empty()) result.normal_slopes[a] = upload(bricks.normal_slopes[a]);
  return result;
}

}  // namespace isolux
