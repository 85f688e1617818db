#include "../data_place.h"
#include "../files.h"
#include "../half_values.h"
#include "../header_bytes.h"
#include "../make_volume.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

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

/// How voxels lie in the file, and what is to be said of it.
struct Mode {
  ScalarType type = ScalarType::kFloat32;
  bool halves = false;  ///< the bits of type kUint16 are those of float16
  std::string remark;
};

// Bytes have a sign since MRC2014. Before that programs differed: IMOD says itself what it wrote ("MRC File Format",
// imodStamp and imodFlags), of others DMIN and DMAX tell.
Mode mode_of_bytes(const std::string& path, const HeaderBytes& header) {
  constexpr std::int32_t kImodStamp = 1146047817;
  constexpr std::int32_t kSigned = 1;
  if (header.get<std::int32_t>(152) == kImodStamp)
    return {(header.get<std::int32_t>(156) & kSigned) != 0 ? ScalarType::kInt8 : ScalarType::kUint8, false, {}};
  const auto low = header.get<float>(76);
  const auto high = header.get<float>(80);
  if (!(low >= 0.0f && high > 127.0f && high <= 255.0f)) return {ScalarType::kInt8, false, {}};
  return {ScalarType::kUint8, false,
          fmt::format("{}: MRC mode 0 is of signed bytes, and the header says values from {} to {}: they are read as "
                      "unsigned",
                      path, low, high)};
}

Mode mode_of(const std::string& path, const HeaderBytes& header) {
  const auto mode = header.get<std::int32_t>(12);
  switch (mode) {
    case 0:
      return mode_of_bytes(path, header);
    case 1:
      return {ScalarType::kInt16, false, {}};
    case 2:
      return {ScalarType::kFloat32, false, {}};
    case 6:
      return {ScalarType::kUint16, false, {}};
    case 12:
      return {ScalarType::kUint16, true, {}};
    default:
      throw InvalidInput(fmt::format(
          "{}: MRC mode {}: supported are 0 (int8), 1 (int16), 2 (float32), 6 (uint16) and 12 (float16)", path, mode));
  }
}

// How many volumes there are. Stacks lie in a file as one volume does (Cheng et al., section 3.2): NZ is of all, MZ of
// one.
std::uint64_t volumes_of(const std::string& path, const HeaderBytes& header, bool spacing_given) {
  const auto group = header.get<std::int32_t>(88);
  const auto sections = header.get<std::int32_t>(8);
  const auto of_each = header.get<std::int32_t>(36);
  constexpr std::int32_t kVolumeStack = 401;
  constexpr std::int32_t kLastStack = 630;
  if (group >= kVolumeStack && group <= kLastStack && of_each > 0 && sections > of_each) {
    if (sections % of_each != 0)
      throw InvalidInput(fmt::format("{}: {} sections of a stack of volumes of {} (ISPG {}): they are no whole number",
                                     path, sections, of_each, group));
    return std::uint64_t(sections / of_each);
  }
  if (group == 0 && of_each == 1 && sections > 1 && !spacing_given)
    throw InvalidInput(
        fmt::format("{}: a stack of {} images (ISPG 0, MZ 1), not a volume: --spacing reads them as the "
                    "sections of one",
                    path, sections));
  return 1;
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
                   std::uint64_t volumes, bool spacing_given) {
  const Mat3 cell = cell_edges(path, header, spacing_given);
  Lattice lattice;
  Vec3 start(0.0);
  for (std::size_t a = 0; a < 3; ++a) {
    lattice.size[order.at(a)] = header.get<std::int32_t>(4 * a);
    start[order.at(a)] = header.get<std::int32_t>(16 + 4 * a);
  }
  lattice.size[order[2]] /= int(volumes);
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

bool is_mrc(const std::string& path) {
  try {
    return has_map_mark(detail::first_inflated(path, kHeaderBytes));
  } catch (const Error&) {
    return false;
  }
}

/// Of all volumes. \throw IoError unless an uncompressed file holds as many voxels as its header says
detail::DataPlace data_place(const std::string& path, const HeaderBytes& header, ScalarType type) {
  const std::array<std::int64_t, 3> sizes = {header.get<std::int32_t>(0), header.get<std::int32_t>(4),
                                             header.get<std::int32_t>(8)};
  const std::uint64_t count = detail::checked_count(path, sizes, bytes_per_scalar(type));
  const auto extended = header.get<std::int32_t>(92);
  const std::uint64_t begin = kHeaderBytes + std::uint64_t(std::max(extended, 0));
  const std::uint64_t needed = begin + count * bytes_per_scalar(type);
  detail::DataPlace place{.file = path, .compressed = detail::is_gzip(path), .layout = {type, header.big_endian()}};
  const std::uint64_t found = place.compressed ? needed : detail::require_file(path);
  if (extended < 0 || needed != found)
    throw IoError(fmt::format("{}: {}x{}x{} voxels behind an extended header of {} bytes need {} bytes, {} found", path,
                              sizes[0], sizes[1], sizes[2], extended, needed, found));
  (place.compressed ? place.skipped : place.offset) = begin;
  return place;
}

/// MRC and CCP4 maps (Cheng et al., "MRC2014", J. Struct. Biol. 192, 2015): axes in any order, cells of any angles.
/// Immutable, callable from many threads.
class MrcReader final : public VolumeReader {
 public:
  using Options = detail::FrameOptions;
  explicit MrcReader(const Options& options) : frame_(options.frame) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (is_mrc(source)) return 2;
    for (const std::string extension : {".mrc", ".map", ".ccp4", ".rec"}) {
      if (detail::has_extension(source, extension) || detail::has_extension(source, extension + ".gz")) return 1;
    }
    return 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    (void)detail::require_file(source);
    std::string bytes = detail::first_inflated(source, kHeaderBytes);
    if (!has_map_mark(bytes))
      throw InvalidInput(fmt::format("{}: no MRC file: 'MAP' is missing at byte 208 of the header", source));
    const HeaderBytes header = ordered(std::move(bytes));
    const Mode mode = mode_of(source, header);
    detail::DataPlace place = data_place(source, header, mode.type);
    const std::uint64_t volumes = volumes_of(source, header, options.spacing.has_value());
    const auto order = axis_order(source, header);
    const Lattice lattice = lattice_of(source, header, order, volumes, options.spacing.has_value());
    const auto what = fmt::format("a stack of {} volumes (ISPG {})", volumes, header.get<std::int32_t>(88));
    place.frames = {volumes, lattice.count(), detail::wanted_frame(source, "mrc", frame_, volumes, what)};
    auto values = mode.halves ? detail::read_halves(place, lattice.count(), options, run)
                              : detail::read_values(place, lattice.count(), options, run);
    values.list = in_xyz_order(std::move(values.list), lattice, order);
    StoredVolume volume = detail::make_volume(
        source, lattice, std::move(values), mode.halves ? ScalarType::kFloat32 : mode.type, "3D-right-handed", options);
    if (!mode.remark.empty()) volume.remarks.push_back(mode.remark);
    return volume;
  }

 private:
  int frame_;
};

}  // namespace

namespace backends {
void mrc(Registry<VolumeReader>& registry) {
  registry.add<MrcReader>("mrc", "MRC and CCP4 maps (.mrc, .map, also .gz), any order of axes and any cell angles");
}
}  // namespace backends

}  // namespace isolux
