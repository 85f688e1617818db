#include "../data_place.h"
#include "../files.h"
#include "../half_values.h"
#include "../header_bytes.h"
#include "../make_volume.h"
#include "../plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <regex>
#include <string>
#include <vector>

namespace isolux {
namespace {

constexpr std::string_view kMark = "\x93NUMPY";
constexpr std::size_t kLongestHeader = 65536;

/// The dictionary of the header, and where the numbers begin.
struct NpyHeader {
  std::string text;
  std::uint64_t data = 0;
};

NpyHeader read_header(const std::string& path) {
  const detail::HeaderBytes bytes(detail::first_bytes(path, kLongestHeader), false);
  const auto truncated = [&] { return IoError(fmt::format("{}: the header of a .npy file ends too soon", path)); };
  if (bytes.size() < 12) throw truncated();
  const auto version = bytes.get<std::uint8_t>(6);
  if (version < 1 || version > 3)
    throw InvalidInput(fmt::format("{}: .npy version {}: read are 1, 2 and 3", path, version));
  const std::size_t begin = version == 1 ? 10 : 12;
  const std::size_t length = version == 1 ? bytes.get<std::uint16_t>(8) : bytes.get<std::uint32_t>(8);
  if (length > bytes.size() - std::min(bytes.size(), begin)) throw truncated();
  std::string text(length, ' ');
  for (std::size_t i = 0; i < length; ++i) text[i] = bytes.get<char>(begin + i);
  return {std::move(text), begin + length};
}

/// What the pattern's group matches behind a key of the dictionary. \throw InvalidInput
std::string value_of(const std::string& path, const std::string& header, const char* key, const char* pattern) {
  std::smatch match;
  if (!std::regex_search(header, match, std::regex(fmt::format("['\"]{}['\"]\\s*:\\s*{}", key, pattern))))
    throw InvalidInput(
        fmt::format("{}: the .npy header {} has no '{}' that can be read: an array of plain numbers is "
                    "needed",
                    path, detail::excerpt(header), key));
  return match[1];
}

/// Numbers of an array: halves lie in `layout` as whole numbers of their size.
struct NpyType {
  detail::ScalarLayout layout;
  bool halves = false;
};

NpyType type_of(const std::string& path, const std::string& descr) {
  constexpr std::array<std::pair<std::string_view, ScalarType>, 12> kTypes{{{"b1", ScalarType::kUint8},
                                                                            {"i1", ScalarType::kInt8},
                                                                            {"u1", ScalarType::kUint8},
                                                                            {"i2", ScalarType::kInt16},
                                                                            {"u2", ScalarType::kUint16},
                                                                            {"i4", ScalarType::kInt32},
                                                                            {"u4", ScalarType::kUint32},
                                                                            {"i8", ScalarType::kInt64},
                                                                            {"u8", ScalarType::kUint64},
                                                                            {"f2", ScalarType::kUint16},
                                                                            {"f4", ScalarType::kFloat32},
                                                                            {"f8", ScalarType::kFloat64}}};
  const std::string_view type = std::string_view(descr).substr(std::min<std::size_t>(1, descr.size()));
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& known) { return known.first == type; });
  if (found == kTypes.end())
    throw InvalidInput(fmt::format(
        "{}: .npy of type '{}': read are bool, int8 to int64, uint8 to uint64 and float16 to float64 (array.astype)",
        path, detail::excerpt(descr)));
  return {{found->second, descr.front() == '>'}, type == "f2"};
}

/// Leaves out axes of one sample, as of channels or time, until three are left: those in front, then those at the end,
/// then others.
void leave_out_single(std::vector<std::int64_t>& sizes) {
  while (sizes.size() > 3) {
    auto single = sizes.begin();
    if (*single != 1) single = sizes.end() - 1;
    if (*single != 1) single = std::find(sizes.begin(), sizes.end(), 1);
    if (single == sizes.end()) return;
    sizes.erase(single);
  }
}

/// The sizes along x, y and z, and of several volumes how many: the last index is the fastest in C's order, the first
/// in Fortran's.
std::vector<std::int64_t> sizes_of(const std::string& path, const std::string& shape, bool fortran_order) {
  std::vector<std::int64_t> sizes;
  const std::regex number("[0-9]+");
  for (std::sregex_iterator it(shape.begin(), shape.end(), number), end; it != end; ++it) {
    const std::string digits = it->str();
    std::int64_t size = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), size);
    sizes.push_back(read.ec == std::errc() ? size : -1);
  }
  leave_out_single(sizes);
  if (sizes.size() != 3 && sizes.size() != 4)
    throw InvalidInput(
        fmt::format("{}: .npy of shape ({}): an array of three axes is needed, or of four for several volumes, beside "
                    "those of one sample",
                    path, detail::excerpt(shape)));
  if (!fortran_order) std::reverse(sizes.begin(), sizes.end());
  return sizes;
}

/// Arrays of NumPy (numpy.lib.format, "The .npy format"). Immutable, callable from many threads.
class NpyReader final : public VolumeReader {
 public:
  using Options = detail::FrameOptions;
  explicit NpyReader(const Options& options) : frame_(options.frame) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::first_bytes(source, kMark.size()) == kMark) return 2;
    return detail::has_extension(source, ".npy") && !detail::is_directory(source) ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    (void)detail::require_file(source);
    if (detail::first_bytes(source, kMark.size()) != kMark)
      throw InvalidInput(fmt::format("{}: does not begin as .npy files do", source));
    const NpyHeader header = read_header(source);
    detail::DataPlace place;
    place.file = source;
    place.offset = header.data;
    const NpyType type = type_of(source, value_of(source, header.text, "descr", "['\"]([^'\"]*)['\"]"));
    place.layout = type.layout;
    const bool fortran_order = value_of(source, header.text, "fortran_order", "(True|False)") == "True";
    const std::string shape = value_of(source, header.text, "shape", "\\(([0-9, ]*)\\)");
    const auto sizes = sizes_of(source, shape, fortran_order);
    const std::uint64_t all = detail::checked_count(source, sizes, bytes_per_scalar(place.layout.type));
    const std::uint64_t volumes = sizes.size() > 3 ? std::uint64_t(sizes[3]) : 1;
    const std::uint64_t count = all / volumes;
    const auto what = fmt::format("an array of shape ({}), its {} axis of {} volumes", detail::excerpt(shape),
                                  fortran_order ? "last" : "first", volumes);
    place.frames = {volumes, count, detail::wanted_frame(source, "npy", frame_, volumes, what)};
    auto values =
        type.halves ? detail::read_halves(place, count, options, run) : detail::read_values(place, count, options, run);
    const Lattice lattice{.size = Index3(int(sizes[0]), int(sizes[1]), int(sizes[2])), .frame = {}};
    return detail::make_volume(source, lattice, std::move(values),
                               type.halves ? ScalarType::kFloat32 : place.layout.type, "3D-right-handed", options);
  }

 private:
  int frame_;
};

}  // namespace

namespace backends {
void npy(Registry<VolumeReader>& registry) {
  registry.add<NpyReader>("npy", "arrays of NumPy (.npy) of three axes; the last index is x in C's order");
}
}  // namespace backends

}  // namespace isolux
