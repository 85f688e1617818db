#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <optional>

#include "near_field.h"
#include "texel_near_field.h"

namespace isolux {

namespace {

/// The brick around a point of the texels' index space and the weights of the eight texels there.
struct BrickPlace {
  std::uint32_t slot = LightBricks::kAbsent;
  std::array<std::size_t, 8> texel{};  ///< within the brick
  std::array<double, 8> weight{};

  BrickPlace(const LightBricks& bricks, const Index3& texels, const Vec3& at) {
    Index3 page;
    Index3 low;
    Vec3 f;
    for (int a = 0; a < 3; ++a) {
      const double x = std::clamp(at[a], 0.0, double(texels[a] - 1));
      const int cell = std::min(int(x), std::max(texels[a] - 2, 0));
      page[a] = cell / LightBricks::kCells;
      low[a] = cell % LightBricks::kCells;
      f[a] = x - cell;
    }
    slot = bricks.slots[bricks.page_of(page)];
    for (unsigned q = 0; q < 8; ++q) {
      const Index3 step(q & 1u, q >> 1 & 1u, q >> 2);
      const Index3 t = low + step;
      const auto n = std::size_t(LightBricks::kTexels);
      texel[q] = (std::size_t(t.z) * n + std::size_t(t.y)) * n + std::size_t(t.x);
      weight[q] = 1.0;
      for (int a = 0; a < 3; ++a) weight[q] *= step[a] != 0 ? f[a] : 1.0 - f[a];
    }
  }

  [[nodiscard]] Vec3f read(const std::vector<float>& bricks, int channels) const {
    if (slot == LightBricks::kAbsent) return Vec3f(0.0f);
    constexpr std::size_t kBrick = std::size_t(LightBricks::kTexels) * LightBricks::kTexels * LightBricks::kTexels;
    Vec3 sum(0.0);
    for (unsigned q = 0; q < 8; ++q) {
      if (weight[q] == 0.0) continue;
      const float* from = &bricks[(std::size_t(slot) * kBrick + texel[q]) * std::size_t(channels)];
      for (int c = 0; c < 3; ++c) sum[c] += weight[q] * double(from[channels == 3 ? c : 0]);
    }
    return Vec3f(sum);
  }
};

/// Moving every texel to one isovalue makes the sum of texels linear in what is stored, so that hardware filters it.
void move_to_isovalue(IlluminationGrid& light, const Volume& volume, float isovalue) {
  const TrilinearField field(volume);
  const IndexToWorld to_volume = index_to_index(light.lattice, volume.lattice());
  const std::vector<float>& slopes = light.detail.slopes;
  const auto channels = std::size_t(light.channels);
  std::size_t v = 0;
  for (int k = 0; k < light.lattice.size.z; ++k) {
    for (int j = 0; j < light.lattice.size.y; ++j) {
      for (int i = 0; i < light.lattice.size.x; ++i) {
        const double step = field.value(to_volume.world({i, j, k})) - double(isovalue);
        for (std::size_t c = 0; c < channels; ++c, ++v) {
          light.values[v] = float(double(light.values[v]) - double(slopes[v]) * step);
        }
      }
    }
  }
}

}  // namespace

struct LightReader::Impl {
  NearField near_field;
  IndexToWorld volume_to_texels;
  IndexToWorld volume_frame;
  IlluminationGrid offsets;  ///< its detail without slopes
  IlluminationGrid slopes;
  std::optional<LightBricks> bricks;
  float reference = 0.0f;
  bool sloped = false;
};

LightReader::LightReader(const Volume& volume, const IlluminationGrid& light, TexelStorage storage, const Run& run) {
  const std::vector<float>& slopes = light.detail.slopes;
  if (!slopes.empty() && slopes.size() != light.values.size()) {
    throw InvalidInput(fmt::format("a light of {} values with {} slopes: none or as many are needed",
                                   light.values.size(), slopes.size()));
  }
  auto impl = std::make_unique<Impl>(Impl{.near_field = NearField(volume),
                                          .volume_to_texels = index_to_index(volume.lattice(), light.lattice),
                                          .volume_frame = volume.lattice().frame,
                                          .offsets = light,
                                          .slopes = {},
                                          .bricks = {},
                                          .reference = 0.0f,
                                          .sloped = !slopes.empty()});
  if (light.detail.texel_light == TexelLight::kOwn) take_off_near_field(volume, impl->offsets, run);
  const ValueRange all = value_range(volume);
  const ValueRange lit = light.detail.isovalues.value_or(all);
  if (impl->sloped) {
    impl->reference = 0.5f * (std::max(all.low, lit.low) + std::min(all.high, lit.high));
    move_to_isovalue(impl->offsets, volume, impl->reference);
  }
  if (storage == TexelStorage::kBricks && (lit.low > all.low || lit.high < all.high)) {
    LightBricks bricks = make_light_bricks(volume, impl->offsets, lit);
    if (bricks.stored() < light.values.size() + slopes.size()) {
      impl->bricks = std::move(bricks);
      impl->offsets.values = {};
    }
  }
  if (impl->sloped && !impl->bricks) {
    impl->slopes.lattice = light.lattice;
    impl->slopes.channels = light.channels;
    impl->slopes.values = slopes;
  }
  impl->offsets.detail.slopes = {};
  impl_ = std::move(impl);
}

LightReader::~LightReader() = default;
LightReader::LightReader(LightReader&&) noexcept = default;
LightReader& LightReader::operator=(LightReader&&) noexcept = default;

Vec3f LightReader::at_index(const Vec3& index) const { return at_index(index, impl_->near_field.field().value(index)); }

Vec3f LightReader::at_index(const Vec3& index, double isovalue) const {
  const Impl& self = *impl_;
  const Vec3 texel = self.volume_to_texels.world(index);
  const LightDetail& detail = self.offsets.detail;
  Vec3 e;
  Vec3 slope(0.0);
  if (self.bricks) {
    const BrickPlace place(*self.bricks, self.offsets.lattice.size, texel);
    e = Vec3(place.read(self.bricks->values, self.bricks->channels));
    if (self.sloped) slope = Vec3(place.read(self.bricks->slopes, self.bricks->channels));
  } else {
    e = Vec3(self.offsets.at_index(texel));
    if (self.sloped) slope = Vec3(self.slopes.at_index(texel));
  }
  if (self.sloped) e += slope * (isovalue - double(self.reference));
  if (!self.sloped && detail.near_field.empty()) return Vec3f(e);
  if (!detail.near_field.empty()) {
    const NearField::Ahead ahead = self.near_field.ahead(index);
    for (const NearFieldTerm& term : detail.near_field) {
      const float openness = self.near_field.openness(index, ahead, isovalue, double(term.step));
      e += Vec3(term.weight) * double(openness - term.mean);
    }
  }
  for (int c = 0; c < 3; ++c) e[c] = std::clamp(e[c], 0.0, double(detail.ceiling));
  return Vec3f(e);
}

Vec3f LightReader::at_world(const Vec3& world) const { return at_index(impl_->volume_frame.index(world)); }

const IlluminationGrid& LightReader::offsets() const { return impl_->offsets; }
const std::vector<float>& LightReader::slopes() const { return impl_->slopes.values; }
const LightBricks* LightReader::bricks() const { return impl_->bricks ? &*impl_->bricks : nullptr; }
float LightReader::reference_isovalue() const { return impl_->reference; }

}  // namespace isolux
