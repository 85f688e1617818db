#include "../files.h"
#include "../header_bytes.h"
#include "../make_volume.h"
#include "../scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace isolux {
namespace {
using detail::HeaderBytes;

constexpr std::size_t kHeaderBytes = 1024;

bool has_map_mark(const std::string& bytes) {
  return bytes.size() >= kHeaderBytes && bytes.compare(208, 3, "MAP") == 0;
}

// The machine stamp; files without one are told by their mode, which is a small number in the right order only.
HeaderBytes ordered(std::string bytes) {
  const char stamp = bytes[212];
  if (stamp == 0x44) return {std::move(bytes), false};
  if (stamp == 0x11) return {std::move(bytes), true};
  const HeaderBytes little(bytes, false);
  const auto mode = little.get<std::int32_t>(12);
  return {std::move(bytes), mode < 0 || mode > 255};
}

ScalarType scalar_type(const std::string& path, int mode) {
  switch (mode) {
    case 0:
      return ScalarType::kInt8;
    case 1:
      return ScalarType::kInt16;
    case 2:
      return ScalarType::kFloat32;
    case 6:
      return ScalarType::kUint16;
    default:
      throw InvalidInput(
          fmt::format("{}: MRC mode {}: supported are 0 (int8), 1 (int16), 2 (float32) and 6 (uint16)", path, mode));
  }
}

// The unit cell: its edges a, b, c in world space, a along x and b in the plane z = 0, as crystallographers have it.
Mat3 cell_edges(const std::string& path, const HeaderBytes& header, bool spacing_given) {
  Vec3 length(0.0);
  Vec3 cosine(0.0);
  for (int a = 0; a < 3; ++a) {
    length[a] = double(header.get<float>(40 + 4 * std::size_t(a)));
    if (spacing_given && !(std::isfinite(length[a]) && length[a] > 0.0)) length[a] = 1.0;
    const auto angle = double(header.get<float>(52 + 4 * std::size_t(a)));
    // Programs that know no cell angles leave them 0.
    cosine[a] = angle == 0.0 || angle == 90.0 ? 0.0 : std::cos(angle * std::numbers::pi / 180.0);
    if (!std::isfinite(length[a]) || length[a] <= 0.0 || !(angle >= 0.0 && angle < 180.0))
      throw InvalidInput(
          fmt::format("{}: cell edge {} of {} at {} degrees: edges are finite and above 0, angles below "
                      "180 (--spacing replaces edges that the file leaves out)",
                      path, a, length[a], angle));
  }
  const double sine = std::sqrt(1.0 - cosine.z * cosine.z);
  const double cy = (cosine.x - cosine.y * cosine.z) / sine;
  const double height = 1.0 - cosine.y * cosine.y - cy * cy;
  if (!(sine > 1e-3) || !(height > 1e-6)) throw InvalidInput(fmt::format("{}: the cell angles span no volume", path));
  return {Vec3(length.x, 0.0, 0.0), length.y * Vec3(cosine.z, sine, 0.0),
          length.z * Vec3(cosine.y, cy, std::sqrt(height))};
}

// Which of x, y, z the file's columns, rows and sections run along.
std::array<int, 3> axis_order(const std::string& path, const HeaderBytes& header) {
  std::array<int, 3> order{};
  std::array<bool, 3> seen{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = header.get<std::int32_t>(64 + 4 * a);
    if (axis < 1 || axis > 3 || seen.at(std::size_t(axis) - 1))
      throw InvalidInput(fmt::format("{}: MAPC, MAPR, MAPS are {}, {}, {}: a permutation of 1, 2, 3 is needed", path,
                                     header.get<std::int32_t>(64), header.get<std::int32_t>(68),
                                     header.get<std::int32_t>(72)));
    order.at(a) = axis - 1;
    seen.at(std::size_t(axis) - 1) = true;
  }
  return order;
}

// The lattice with its axes in the order x, y, z.
Lattice lattice_of(const std::string& path, const HeaderBytes& header, const std::array<int, 3>& order,
                   bool spacing_given) {
  const Mat3 cell = cell_edges(path, header, spacing_given);
  Lattice lattice;
  Vec3 start(0.0);
  for (std::size_t a = 0; a < 3; ++a) {
    lattice.size[order.at(a)] = header.get<std::int32_t>(4 * a);
    start[order.at(a)] = header.get<std::int32_t>(16 + 4 * a);
  }
  for (int a = 0; a < 3; ++a) {
    auto intervals = header.get<std::int32_t>(28 + 4 * std::size_t(a));
    if (spacing_given && intervals == 0) intervals = 1;
    if (intervals < 1)
      throw InvalidInput(
          fmt::format("{}: {} sampling intervals along axis {}: at least 1 is needed", path, intervals, a));
    lattice.frame.axes[a] = cell[a] / double(intervals);
  }
  // ORIGIN where it is set, as most programs have it, else the first point's place in the cell.
  const Vec3 origin(header.get<float>(196), header.get<float>(200), header.get<float>(204));
  lattice.frame.origin = origin == Vec3(0.0) ? lattice.frame.axes * start : origin;
  if (!std::isfinite(glm::dot(lattice.frame.origin, lattice.frame.origin)))
    throw InvalidInput(fmt::format("{}: the origin is not finite", path));
  return lattice;
}

template <class T>
std::vector<T> sort_axes(const std::vector<T>& values, const Lattice& lattice, const std::array<int, 3>& order) {
  std::vector<T> sorted(values.size());
  Index3 at(0);
  for (const T value : values) {
    sorted[lattice.offset(at.x, at.y, at.z)] = value;
    for (const int axis : order) {
      if (++at[axis] < lattice.size[axis]) break;
      at[axis] = 0;
    }
  }
  return sorted;
}

detail::AnyValues in_xyz_order(detail::AnyValues values, const Lattice& lattice, const std::array<int, 3>& order) {
  if (order == std::array<int, 3>{0, 1, 2}) return values;
  return std::visit([&](const auto& list) -> detail::AnyValues { return sort_axes(list, lattice, order); }, values);
}

/// MRC and CCP4 maps (Cheng et al., "MRC2014", J. Struct. Biol. 192, 2015): axes in any order, cells of any angles.
/// Immutable, callable from many threads.
class MrcReader final : public VolumeReader {
 public:
  using Options = NoOptions;
  explicit MrcReader(const Options& /*options*/) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (has_map_mark(detail::first_bytes(source, kHeaderBytes))) return 2;
    for (const auto* extension : {".mrc", ".map", ".ccp4", ".rec"}) {
      if (detail::has_extension(source, extension)) return 1;
    }
    return 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const std::uint64_t found = detail::require_file(source);
    std::string bytes = detail::first_bytes(source, kHeaderBytes);
    if (!has_map_mark(bytes))
      throw InvalidInput(fmt::format("{}: no MRC file: 'MAP' is missing at byte 208 of the header", source));
    const HeaderBytes header = ordered(std::move(bytes));
    const ScalarType type = scalar_type(source, header.get<std::int32_t>(12));
    const std::array<std::int64_t, 3> sizes = {header.get<std::int32_t>(0), header.get<std::int32_t>(4),
                                               header.get<std::int32_t>(8)};
    const std::uint64_t count = detail::checked_count(source, sizes, bytes_per_scalar(type));
    const auto extended = header.get<std::int32_t>(92);
    const std::uint64_t needed = kHeaderBytes + std::uint64_t(std::max(extended, 0)) + count * bytes_per_scalar(type);
    if (extended < 0 || needed != found)
      throw IoError(fmt::format("{}: {}x{}x{} voxels behind an extended header of {} bytes need {} bytes, {} found",
                                source, sizes[0], sizes[1], sizes[2], extended, needed, found));
    const auto order = axis_order(source, header);
    const Lattice lattice = lattice_of(source, header, order, options.spacing.has_value());
    auto values = detail::decode_scalars(*detail::file_source(source, kHeaderBytes + std::uint64_t(extended)),
                                         {type, header.big_endian()}, count, options, source, run);
    values.list = in_xyz_order(std::move(values.list), lattice, order);
    return detail::make_volume(source, lattice, std::move(values), type, "3D-right-handed", options);
  }
};

}  // namespace

namespace backends {
void mrc(Registry<VolumeReader>& registry) {
  registry.add<MrcReader>("mrc", "MRC and CCP4 maps (.mrc, .map), any order of axes and any cell angles");
}
}  // namespace backends

}  // namespace isolux
