#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/release.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "near_field.h"
#include "texel_near_field.h"
#include "texel_row.h"

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
      const double x = within_axis(at[a], texels[a]);
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

  /// Rounded to float as IlluminationGrid::at_index() does. GCC 12 forgets to round where it inlines this.
  [[nodiscard, gnu::noinline]] Vec3f read(const std::vector<float>& bricks, int channels) const {
    if (slot == LightBricks::kAbsent) return Vec3f(0.0f);
    constexpr std::size_t kBrick = std::size_t(LightBricks::kTexels) * LightBricks::kTexels * LightBricks::kTexels;
    double sum[3] = {0.0, 0.0, 0.0};
    for (unsigned q = 0; q < 8; ++q) {
      if (weight[q] == 0.0) continue;
      const float* from = &bricks[(std::size_t(slot) * kBrick + texel[q]) * std::size_t(channels)];
      for (int c = 0; c < 3; ++c) sum[c] += weight[q] * double(from[channels == 3 ? c : 0]);
    }
    return {float(sum[0]), float(sum[1]), float(sum[2])};
  }
};

/// A value of a texel of that isovalue and normal, moved to another isovalue and to no normal.
double moved(const LightDetail& detail, std::size_t v, double value, double isovalue, const Vec3& normal,
             double to_isovalue) {
  if (!detail.slopes.empty()) value -= double(detail.slopes[v]) * (isovalue - to_isovalue);
  if (detail.normal_slopes[0].empty()) return value;
  for (unsigned a = 0; a < 3; ++a) value -= double(detail.normal_slopes[a][v]) * normal[int(a)];
  return value;
}

/// Moving every texel to one isovalue and to no normal makes the sum of texels linear in what is stored, so that
/// hardware filters it.
void move_to_isovalue(IlluminationGrid& light, const NearField& near_field, float isovalue, const Run& run) {
  const Index3& size = light.lattice.size;
  const LightDetail& detail = light.detail;
  const auto channels = std::size_t(light.channels);
  parallel_blocks(std::size_t(size.z) * std::size_t(size.y), 8, run, "", [&](const Block& block) {
    TexelRow row(near_field, light.lattice);
    std::vector<int> columns(static_cast<std::size_t>(size.x));
    std::iota(columns.begin(), columns.end(), 0);
    for (std::size_t r = block.begin; r < block.end; ++r) {
      row.look(int(r % std::size_t(size.y)), int(r / std::size_t(size.y)), columns);
      for (std::size_t v = r * columns.size() * channels; v < (r + 1) * columns.size() * channels; ++v) {
        const std::size_t n = v / channels - r * columns.size();
        const Vec3 normal(Vec3f(row.ahead(n).downhill));
        light.values[v] = float(moved(detail, v, double(light.values[v]), row.isovalue(n), normal, double(isovalue)));
      }
    }
  });
}

void require_finite(const std::vector<float>& values) {
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    throw InvalidInput("light whose values, slopes and near field are together beyond floats cannot be read");
}

/// All of a light but its texels.
IlluminationGrid without_texels(const IlluminationGrid& light) {
  IlluminationGrid result;
  result.lattice = light.lattice;
  result.channels = light.channels;
  result.detail.near_field = light.detail.near_field;
  result.detail.texel_light = light.detail.texel_light;
  result.detail.ceiling = light.detail.ceiling;
  result.detail.isovalues = light.detail.isovalues;
  return result;
}

/// The eight texels around a point of a grid's index space, moved to one isovalue, and where the point is among them.
class TexelsAround {
 public:
  TexelsAround(const IlluminationGrid& light, const NearField& near_field, float reference, const Vec3& at)
      : channels_(light.channels) {
    for (int a = 0; a < 3; ++a) {
      const int points = light.lattice.size[a];
      const double x = within_axis(at[a], points);
      low_[a] = std::min(int(x), std::max(points - 2, 0));
      size_[a] = std::min(points, 2);
      place[a] = x - low_[a];
    }
    const LightDetail& detail = light.detail;
    values = taken(light.lattice, light.values);
    slopes = taken(light.lattice, detail.slopes);
    for (unsigned a = 0; a < 3; ++a) normal_slopes[a] = taken(light.lattice, detail.normal_slopes[a]);
    if (!detail.slopes.empty() || !detail.normal_slopes[0].empty()) move_values(light, near_field, reference);
    require_finite(values.values);
  }

  Vec3 place{0.0};
  IlluminationGrid values;
  IlluminationGrid slopes;
  std::array<IlluminationGrid, 3> normal_slopes;

 private:
  [[nodiscard]] IlluminationGrid taken(const Lattice& texels, const std::vector<float>& from) const {
    IlluminationGrid result;
    if (from.empty()) return result;
    result.lattice.size = size_;
    result.channels = channels_;
    const auto channels = std::size_t(channels_);
    for (int k = 0; k < size_.z; ++k)
      for (int j = 0; j < size_.y; ++j) {
        const float* const row = &from[texels.offset(low_.x, low_.y + j, low_.z + k) * channels];
        result.values.insert(result.values.end(), row, row + std::size_t(size_.x) * channels);
      }
    return result;
  }

  void move_values(const IlluminationGrid& light, const NearField& near_field, float reference) {
    TexelRow row(near_field, light.lattice);
    const std::array<int, 2> columns = {low_.x, low_.x + 1};
    const auto channels = std::size_t(channels_);
    auto value = values.values.begin();
    for (int k = low_.z; k < low_.z + size_.z; ++k)
      for (int j = low_.y; j < low_.y + size_.y; ++j) {
        row.look(j, k, std::span(columns).first(std::size_t(size_.x)));
        std::size_t v = light.lattice.offset(low_.x, j, k) * channels;
        for (std::size_t n = 0; n < std::size_t(size_.x) * channels; ++n, ++v, ++value) {
          const Vec3 normal(Vec3f(row.ahead(n / channels).downhill));
          *value = float(moved(light.detail, v, double(*value), row.isovalue(n / channels), normal, double(reference)));
        }
      }
  }

  int channels_;
  Index3 low_{0};
  Index3 size_{0};
};

}  // namespace

struct LightReader::Impl {
  /// The sum of texels at a point of the texels' index space.
  [[nodiscard]] Vec3 texels_at(const Vec3& texel, double isovalue, const Vec3& normal) const {
    if (bricks) {
      const BrickPlace place(*bricks, offsets.lattice.size, texel);
      return sum(bricks->values, bricks->slopes, bricks->normal_slopes, isovalue, normal,
                 [&](const std::vector<float>& from) { return place.read(from, bricks->channels); });
    }
    if (lent != nullptr) {
      const TexelsAround near(*lent, near_field, reference, texel);
      return sum(near.values, near.slopes, near.normal_slopes, isovalue, normal,
                 [&](const IlluminationGrid& from) { return from.at_index(near.place); });
    }
    return sum(offsets, slopes, normal_slopes, isovalue, normal,
               [&](const IlluminationGrid& from) { return from.at_index(texel); });
  }

  template <class Texels, class Read>
  [[nodiscard]] Vec3 sum(const Texels& values, const Texels& by_isovalue, const std::array<Texels, 3>& by_normal,
                         double isovalue, const Vec3& normal, const Read& read) const {
    Vec3 e(read(values));
    if (sloped) e += Vec3(read(by_isovalue)) * (isovalue - double(reference));
    for (unsigned a = 0; turned && a < 3; ++a) e += Vec3(read(by_normal[a])) * normal[int(a)];
    return e;
  }

  NearField near_field;
  IndexToWorld volume_to_texels;
  IndexToWorld volume_frame;
  IlluminationGrid offsets;  ///< its detail without slopes of either kind; no values where there are bricks
  IlluminationGrid slopes;
  std::array<IlluminationGrid, 3> normal_slopes;
  std::optional<LightBricks> bricks;
  const IlluminationGrid* lent = nullptr;
  float reference = 0.0f;
  bool sloped = false;
  bool turned = false;
};

LightReader::LightReader(const Volume& volume, const IlluminationGrid& light, TexelStorage storage, const Run& run) {
  const LightDetail& detail = light.detail;
  require_complete(light);
  const bool is_lent = storage == TexelStorage::kLent && detail.texel_light != TexelLight::kOwn;
  auto impl = std::make_unique<Impl>(Impl{.near_field = NearField(volume),
                                          .volume_to_texels = index_to_index(volume.lattice(), light.lattice),
                                          .volume_frame = volume.lattice().frame,
                                          .offsets = is_lent ? without_texels(light) : light,
                                          .slopes = {},
                                          .normal_slopes = {},
                                          .bricks = {},
                                          .lent = is_lent ? &light : nullptr,
                                          .reference = 0.0f,
                                          .sloped = !detail.slopes.empty(),
                                          .turned = !detail.normal_slopes[0].empty()});
  const ValueRange all = value_range(volume);
  const ValueRange lit = detail.isovalues.value_or(all);
  if (impl->sloped) impl->reference = 0.5f * std::max(all.low, lit.low) + 0.5f * std::min(all.high, lit.high);
  if (is_lent) {
    impl_ = std::move(impl);
    return;
  }
  if (detail.texel_light == TexelLight::kOwn) take_off_near_field(volume, impl->offsets, run);
  if (impl->sloped || impl->turned) move_to_isovalue(impl->offsets, impl->near_field, impl->reference, run);
  require_finite(impl->offsets.values);
  if (storage == TexelStorage::kBricks && (lit.low > all.low || lit.high < all.high)) {
    LightBricks bricks = make_light_bricks(volume, impl->offsets, lit);
    if (bricks.stored() < light.values.size() * std::size_t(detail.numbers())) {
      impl->bricks = std::move(bricks);
      release(impl->offsets.values);
    }
  }
  const auto keep = [&](const std::vector<float>& slopes, IlluminationGrid& grid) {
    if (slopes.empty() || impl->bricks) return;
    grid.lattice = light.lattice;
    grid.channels = light.channels;
    grid.values = slopes;
  };
  keep(detail.slopes, impl->slopes);
  for (unsigned a = 0; a < 3; ++a) keep(detail.normal_slopes[a], impl->normal_slopes[a]);
  release(impl->offsets.detail.slopes);
  for (std::vector<float>& slopes : impl->offsets.detail.normal_slopes) release(slopes);
  impl_ = std::move(impl);
}

LightReader::~LightReader() = default;
LightReader::LightReader(LightReader&&) noexcept = default;
LightReader& LightReader::operator=(LightReader&&) noexcept = default;

Vec3f LightReader::at_index(const Vec3& index) const { return at_index(index, impl_->near_field.field().value(index)); }

Vec3f LightReader::at_index(const Vec3& index, double isovalue) const {
  const Impl& self = *impl_;
  const LightDetail& detail = self.offsets.detail;
  const Vec3 texel = self.volume_to_texels.world(index);
  const bool near = !detail.near_field.empty();
  if (!self.sloped && !self.turned && !near) return Vec3f(self.texels_at(texel, isovalue, Vec3(0.0)));
  const NearField::Ahead ahead = near || self.turned ? self.near_field.ahead(index) : NearField::Ahead{};
  Vec3 e = self.texels_at(texel, isovalue, ahead.downhill);
  for (const NearFieldTerm& term : detail.near_field) {
    const float openness = self.near_field.openness(index, ahead, isovalue, double(term.step));
    e += Vec3(term.weight) * double(openness - term.mean);
  }
  for (int c = 0; c < 3; ++c) e[c] = std::clamp(e[c], 0.0, double(detail.ceiling));
  return Vec3f(e);
}

Vec3f LightReader::at_world(const Vec3& world) const { return at_index(impl_->volume_frame.index(world)); }

const IlluminationGrid& LightReader::offsets() const { return impl_->offsets; }
const std::vector<float>& LightReader::slopes() const { return impl_->slopes.values; }
const std::vector<float>& LightReader::normal_slopes(std::size_t axis) const {
  return impl_->normal_slopes[axis].values;
}
const LightBricks* LightReader::bricks() const { return impl_->bricks ? &*impl_->bricks : nullptr; }
float LightReader::reference_isovalue() const { return impl_->reference; }

}  // namespace isolux
