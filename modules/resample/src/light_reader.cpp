#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>

#include "near_field.h"

namespace isolux {

struct LightReader::Impl {
  NearField near_field;
  IndexToWorld volume_to_texels;
  IndexToWorld volume_frame;
  IlluminationGrid offsets;
  IlluminationGrid slopes;
  float reference = 0.0f;
};

LightReader::LightReader(const Volume& volume, const IlluminationGrid& light) {
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
                                          .reference = 0.0f});
  impl->offsets.detail.slopes.clear();
  if (!slopes.empty()) {
    // Moving every texel to one isovalue makes the sum of texels linear in what is stored, so that hardware filters it.
    const ValueRange range = value_range(volume);
    impl->reference = 0.5f * (range.low + range.high);
    impl->slopes.lattice = light.lattice;
    impl->slopes.channels = light.channels;
    impl->slopes.values = slopes;
    const TrilinearField& field = impl->near_field.field();
    const IndexToWorld to_volume = index_to_index(light.lattice, volume.lattice());
    const auto channels = std::size_t(light.channels);
    std::size_t v = 0;
    for (int k = 0; k < light.lattice.size.z; ++k) {
      for (int j = 0; j < light.lattice.size.y; ++j) {
        for (int i = 0; i < light.lattice.size.x; ++i) {
          const double step = field.value(to_volume.world({i, j, k})) - double(impl->reference);
          for (std::size_t c = 0; c < channels; ++c, ++v) {
            impl->offsets.values[v] = float(double(light.values[v]) - double(slopes[v]) * step);
          }
        }
      }
    }
  }
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
  Vec3 e(self.offsets.at_index(texel));
  if (!self.slopes.values.empty()) e += Vec3(self.slopes.at_index(texel)) * (isovalue - double(self.reference));
  for (const NearFieldTerm& term : detail.near_field) {
    const float openness = self.near_field.openness(index, isovalue, double(term.step));
    e += Vec3(term.weight) * double(openness - term.mean);
  }
  if (self.slopes.values.empty() && detail.near_field.empty()) return Vec3f(e);
  for (int c = 0; c < 3; ++c) e[c] = std::clamp(e[c], 0.0, double(detail.ceiling));
  return Vec3f(e);
}

Vec3f LightReader::at_world(const Vec3& world) const { return at_index(impl_->volume_frame.index(world)); }

const IlluminationGrid& LightReader::offsets() const { return impl_->offsets; }
const std::vector<float>& LightReader::slopes() const { return impl_->slopes.values; }
float LightReader::reference_isovalue() const { return impl_->reference; }

}  // namespace isolux
