#include "nrrd_header.h"
#include "nrrd_write.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/atomic_file.h>
#include <isolux/volume_io/light_file.h>

#include <algorithm>
#include <cmath>

namespace isolux {

void write_light(const LightFile& light, const std::string& path, const std::string& space,
                 const LightWriteOptions& options) {
  const detail::NrrdImage image{.type = ScalarType::kFloat32,
                                .channels = light.grid.channels,
                                .lattice = light.grid.lattice,
                                .space = space,
                                .key_values = light.metadata,
                                .compress = options.compress,
                                .data_file = {}};
  write_atomically(path, [&](std::ostream& out) {
    detail::write_nrrd_header(out, image);
    detail::write_nrrd_values(out, image, light.grid.values);
  });
}

LightFile read_light(const std::string& path) {
  detail::NrrdHeader header = detail::read_nrrd_header(path, {});
  const std::size_t axes = header.axes.size();
  const bool colored = axes == 4 && header.axes.front().size == 3;
  if (axes != 3 && !colored)
    throw InvalidInput(
        fmt::format("{}: a light file has 3 axes, or 4 with the first of size 3; this has {}", path, axes));
  LightFile light;
  light.grid.channels = colored ? 3 : 1;
  light.grid.lattice = detail::nrrd_frame(header, std::span(header.axes).last(3)).lattice;
  light.grid.values = detail::read_nrrd_values(header, {});
  const auto& values = light.grid.values;
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    throw InvalidInput(fmt::format("{}: a light file's values are finite; this has others", path));
  light.metadata = std::move(header.key_values);
  return light;
}

}  // namespace isolux
