#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/plain_floats.h>
#include <isolux/core/volume.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace isolux {

namespace {

template <class Value>
ValueRange range_of(std::span<const Value> values) {
  // Columns of their own, which a vector takes at once.
  constexpr std::size_t kColumns = 32;
  std::array<Value, kColumns> low{};
  std::array<Value, kColumns> high{};
  low.fill(values.front());
  high.fill(values.front());
  std::size_t i = 0;
  for (; i + kColumns <= values.size(); i += kColumns) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      const Value value = values[i + c];
      low[c] = value < low[c] ? value : low[c];
      high[c] = value > high[c] ? value : high[c];
    }
  }
  for (; i < values.size(); ++i) {
    low[0] = std::min(low[0], values[i]);
    high[0] = std::max(high[0], values[i]);
  }
  return {float(*std::min_element(low.begin(), low.end())), float(*std::max_element(high.begin(), high.end()))};
}

void require_finite(const std::string& name, const Index3& size, std::span<const float> values) {
  const auto bad = std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
  if (bad == values.end()) return;
  const auto count = std::count_if(bad, values.end(), [](float v) { return !std::isfinite(v); });
  const auto at = std::size_t(bad - values.begin());
  const auto nx = std::size_t(size.x);
  const auto ny = std::size_t(size.y);
  throw InvalidInput(fmt::format("{}: {} of {} voxels are not finite numbers, the first ({}) at {},{},{}", name, count,
                                 values.size(), *bad, at % nx, at / nx % ny, at / (nx * ny)));
}

/// Vertices of meshes are floats.
void require_float_corners(const VolumeView& volume) {
  constexpr auto kMost = double(std::numeric_limits<float>::max());
  const Lattice& lattice = volume.lattice();
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner = lattice.frame.world(Vec3(lattice.size - 1) * Vec3(c & 1, c >> 1 & 1, c >> 2));
    const double farthest = std::max({std::fabs(corner.x), std::fabs(corner.y), std::fabs(corner.z)});
    if (!(farthest <= kMost))
      throw InvalidInput(fmt::format("{}: a corner of it lies at ({}, {}, {}); coordinates up to {:.2g} are allowed",
                                     volume.name(), corner.x, corner.y, corner.z, kMost));
  }
}

}  // namespace

const Lattice& StoredVolume::lattice() const {
  return std::visit([](const auto& grid) -> const Lattice& { return grid.lattice(); }, values);
}

Volume to_floats(StoredVolume volume) {
  Volume result{.values = {},
                .name = std::move(volume.name),
                .stored_type = volume.stored_type,
                .space = std::move(volume.space),
                .rounded = volume.rounded,
                .remarks = std::move(volume.remarks)};
  if (auto* floats = std::get_if<Grid<float>>(&volume.values)) {
    result.values = std::move(*floats);
  } else {
    std::visit(
        [&](const auto& grid) {
          result.values = Grid<float>(grid.lattice(), {grid.values().begin(), grid.values().end()});
        },
        volume.values);
  }
  return result;
}

StoredVolume keep_floats(Volume volume) {
  return {.values = std::move(volume.values),
          .name = std::move(volume.name),
          .stored_type = volume.stored_type,
          .space = std::move(volume.space),
          .rounded = volume.rounded,
          .remarks = std::move(volume.remarks)};
}

VolumeView::VolumeView(const Volume& volume)
    : lattice_(&volume.lattice()),
      name_(&volume.name),
      space_(&volume.space),
      stored_type_(volume.stored_type),
      voxels_(volume.values.values()) {}

VolumeView::VolumeView(const StoredVolume& volume)
    : lattice_(&volume.lattice()),
      name_(&volume.name),
      space_(&volume.space),
      stored_type_(volume.stored_type),
      voxels_(std::visit([](const auto& grid) { return Voxels(grid.values()); }, volume.values)) {}

float VolumeView::operator()(int i, int j, int k) const {
  return std::visit([at = lattice_->offset(i, j, k)](const auto& values) { return float(values[at]); }, voxels_);
}

void VolumeView::copy(std::size_t first, std::span<float> out) const {
  std::visit(
      [&](const auto& values) {
        const auto part = values.subspan(first, out.size());
        std::copy(part.begin(), part.end(), out.begin());
      },
      voxels_);
}

ValueRange value_range(const VolumeView& volume) {
  return std::visit([](const auto& values) { return range_of(values); }, volume.voxels());
}

void require_usable(const VolumeView& volume) {
  const PlainFloats plain;
  const Index3 size = volume.lattice().size;
  if (size.x < 2 || size.y < 2 || size.z < 2) {
    throw InvalidInput(
        fmt::format("{}: {}x{}x{} grid points; every axis needs at least 2", volume.name(), size.x, size.y, size.z));
  }
  require_spanning(volume.lattice().frame, volume.name());
  require_places(volume.lattice(), volume.name());
  require_float_corners(volume);
  if (const auto* floats = std::get_if<std::span<const float>>(&volume.voxels()))
    require_finite(volume.name(), size, *floats);
}

}  // namespace isolux
