#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/illumination_grid.h>

#include <algorithm>

namespace isolux {

IlluminationGrid::IlluminationGrid(const Lattice& texels, int channel_count)
    : lattice(texels), channels(channel_count) {
  if (channels < 1) throw InvalidInput(fmt::format("a light of {} channels: allowed are 1 and 3", channels));
  values.assign(require_countable(texels) * std::size_t(channels), 0.0f);
}

namespace {

void require_slopes(const IlluminationGrid& light, const std::vector<float>& slopes, bool there_are) {
  if (slopes.size() == (there_are ? light.values.size() : 0)) return;
  throw InvalidInput(fmt::format("a light of {} values with {} slopes: none or as many are needed", light.values.size(),
                                 slopes.size()));
}

}  // namespace

void require_complete(const IlluminationGrid& light) {
  const Index3& size = light.lattice.size;
  if (size.x < 1 || size.y < 1 || size.z < 1)
    throw InvalidInput(fmt::format("a light of {}x{}x{} texels: allowed is 1 and more", size.x, size.y, size.z));
  if (light.channels != 1 && light.channels != 3)
    throw InvalidInput(fmt::format("a light of {} channels: allowed are 1 and 3", light.channels));
  if (light.values.size() != light.lattice.count() * std::size_t(light.channels)) {
    throw InvalidInput(fmt::format("{} values for a light of {}x{}x{} texels and {} channels", light.values.size(),
                                   size.x, size.y, size.z, light.channels));
  }
  require_spanning(light.lattice.frame, "a light");
  const LightDetail& detail = light.detail;
  require_slopes(light, detail.slopes, !detail.slopes.empty());
  for (const auto& slopes : detail.normal_slopes) require_slopes(light, slopes, !detail.normal_slopes[0].empty());
}

Vec3f IlluminationGrid::at_index(const Vec3& texel_index) const {
  int low[3];
  int step[3];
  double f[3];
  for (int a = 0; a < 3; ++a) {
    const double x = within_axis(texel_index[a], lattice.size[a]);
    low[a] = std::min(int(x), std::max(lattice.size[a] - 2, 0));
    step[a] = lattice.size[a] > 1 ? 1 : 0;
    f[a] = x - low[a];
  }
  double sum[3] = {0.0, 0.0, 0.0};
  for (int q = 0; q < 8; ++q) {
    const int dx = q & 1;
    const int dy = q >> 1 & 1;
    const int dz = q >> 2;
    const double w = (dx != 0 ? f[0] : 1.0 - f[0]) * (dy != 0 ? f[1] : 1.0 - f[1]) * (dz != 0 ? f[2] : 1.0 - f[2]);
    if (w == 0.0) continue;
    const float* texel =
        values.data() +
        lattice.offset(low[0] + dx * step[0], low[1] + dy * step[1], low[2] + dz * step[2]) * std::size_t(channels);
    for (int c = 0; c < 3; ++c) sum[c] += w * double(texel[channels == 3 ? c : 0]);
  }
  return {float(sum[0]), float(sum[1]), float(sum[2])};
}

Vec3f IlluminationGrid::at_world(const Vec3& world) const { return at_index(lattice.frame.index(world)); }

}  // namespace isolux
