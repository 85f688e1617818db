#include "legacy_vtk.h"

#include "files.h"
#include "format_checks.h"
#include "number_text.h"
#include "plain_text.h"
#include "text_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace isolux::detail {
namespace {

constexpr std::string_view kMagic = "# vtk DataFile Version";
constexpr std::size_t kLongestVtkHeader = 1 << 14;

class VtkHeader {
 public:
  explicit VtkHeader(const std::string& path) : path_(path), bytes_(first_bytes(path, kLongestVtkHeader)) {}

  /// The next line, as words in lower case: VTK reads them in any.
  std::vector<std::string> any_line() {
    const std::size_t newline = bytes_.find('\n', end_);
    if (newline == std::string::npos) throw IoError(fmt::format("{}: the VTK header ends early", path_));
    auto words = plain_words(lower_case(std::string_view(bytes_).substr(end_, newline - end_)));
    end_ = newline + 1;
    return words;
  }
  /// The next line that is not blank.
  std::vector<std::string> line() {
    for (;;) {
      if (auto words = any_line(); !words.empty()) return words;
    }
  }
  [[nodiscard]] std::size_t end() const { return end_; }

  [[nodiscard]] double number(const std::vector<std::string>& words, std::size_t index) const {
    const std::string word = index < words.size() ? words[index] : "";
    const auto value = parse_real(word);
    if (!value)
      throw InvalidInput(
          fmt::format("{}: VTK '{}': '{}' is not a number", path_, excerpt(words.front()), excerpt(word)));
    return *value;
  }
  [[nodiscard]] std::array<double, 3> triple(const std::vector<std::string>& words) const {
    if (words.size() != 4)
      throw InvalidInput(fmt::format("{}: VTK '{}' needs three numbers", path_, excerpt(words.front())));
    return {number(words, 1), number(words, 2), number(words, 3)};
  }
  [[nodiscard]] std::array<std::int64_t, 3> sizes(const std::vector<std::string>& words) const {
    const auto numbers = triple(words);
    if (!std::all_of(words.begin() + 1, words.end(), [](const auto& w) { return reads_as(ScalarType::kInt64, w); }))
      throw InvalidInput(fmt::format("{}: VTK '{}': three whole numbers are needed", path_,
                                     excerpt(fmt::format("{}", fmt::join(words, " ")))));
    return {std::int64_t(numbers[0]), std::int64_t(numbers[1]), std::int64_t(numbers[2])};
  }

 private:
  std::string path_;
  std::string bytes_;
  std::size_t end_ = 0;
};

ScalarType scalar_type(const std::string& path, const std::string& type) {
  // A vtkIdType has eight bytes in memory, and four in what VTK writes and reads.
  static const std::map<std::string, ScalarType> types = {{"char", ScalarType::kInt8},
                                                          {"signed_char", ScalarType::kInt8},
                                                          {"unsigned_char", ScalarType::kUint8},
                                                          {"short", ScalarType::kInt16},
                                                          {"unsigned_short", ScalarType::kUint16},
                                                          {"int", ScalarType::kInt32},
                                                          {"vtkidtype", ScalarType::kInt32},
                                                          {"unsigned_int", ScalarType::kUint32},
                                                          {"long", ScalarType::kInt64},
                                                          {"unsigned_long", ScalarType::kUint64},
                                                          {"long_long", ScalarType::kInt64},
                                                          {"unsigned_long_long", ScalarType::kUint64},
                                                          {"vtktypeint64", ScalarType::kInt64},
                                                          {"vtktypeuint64", ScalarType::kUint64},
                                                          {"float", ScalarType::kFloat32},
                                                          {"double", ScalarType::kFloat64}};
  const auto it = types.find(type);
  if (it == types.end())
    throw InvalidInput(
        fmt::format("{}: VTK scalars of type '{}': supported are (unsigned_)char, (unsigned_)short, "
                    "(unsigned_)int, (unsigned_)long, (unsigned_)long_long, float and double",
                    path, excerpt(type)));
  return it->second;
}

// VTK writes all scalars of unsigned chars so.
constexpr std::string_view kColours = "color_scalars";

// The lines between DATASET and SCALARS, in any order; returns that of SCALARS.
std::vector<std::string> read_lattice(const std::string& path, VtkHeader& header, Lattice& lattice) {
  std::optional<std::array<std::int64_t, 3>> sizes;
  std::optional<double> points;
  auto words = header.line();
  for (; words.front() != "scalars" && words.front() != kColours; words = header.line()) {
    if (words.front() == "dimensions") {
      sizes = header.sizes(words);
    } else if (words.front() == "spacing" || words.front() == "aspect_ratio") {
      const auto spacing = header.triple(words);
      require_spacing(path, spacing);
      for (std::size_t a = 0; a < 3; ++a) lattice.frame.axes[int(a)][int(a)] = spacing.at(a);
    } else if (words.front() == "origin") {
      const auto origin = header.triple(words);
      require_finite(path, "the origin", origin);
      lattice.frame.origin = Vec3(origin[0], origin[1], origin[2]);
    } else if (words.front() == "point_data") {
      points = header.number(words, 1);
    } else {
      throw InvalidInput(fmt::format("{}: VTK '{}' before SCALARS is not supported", path, excerpt(words.front())));
    }
  }
  if (!sizes) throw InvalidInput(fmt::format("{}: VTK has no DIMENSIONS", path));
  const std::uint64_t count = checked_count(path, *sizes, 8);
  if (!points) throw InvalidInput(fmt::format("{}: VTK SCALARS without POINT_DATA before them", path));
  if (*points != double(count))
    throw InvalidInput(fmt::format("{}: VTK POINT_DATA {}: DIMENSIONS make {}", path, *points, count));
  lattice.size = {int((*sizes)[0]), int((*sizes)[1]), int((*sizes)[2])};
  return words;
}

std::vector<std::string> words_at(const std::string& path, std::uint64_t offset) {
  std::string bytes(kLongestVtkHeader, '\0');
  bytes.resize(file_source(path, offset)->read(std::as_writable_bytes(std::span(bytes))));
  return plain_words(bytes);
}

// Of the words behind the values, the attribute that they begin with, as the file names it; see LegacyVtk.
std::string attribute_of(const std::vector<std::string>& words) {
  static constexpr std::array<std::string_view, 9> kAttributes = {
      "scalars",  "color_scalars",       "vectors", "normals",  "tensors",
      "tensors6", "texture_coordinates", "field",   "cell_data"};
  // What VTK notes of the values before, up to an empty line.
  const auto is_attribute = [](const std::string& word) {
    return std::find(kAttributes.begin(), kAttributes.end(), lower_case(word)) != kAttributes.end();
  };
  auto at = words.begin();
  if (at != words.end() && lower_case(*at) == "metadata") at = std::find_if(at, words.end(), is_attribute);
  if (at == words.end() || !is_attribute(*at)) return "";
  return at + 1 == words.end() ? excerpt(*at) : excerpt(*at + " " + *(at + 1));
}

// The bytes that fractions of 255 stand for, rounded as VTK does.
class Fractions final : public ByteSource {
 public:
  Fractions(NumberText& text, const std::string& path, std::uint64_t count) : text_(text), path_(path), count_(count) {}

  std::size_t read(std::span<std::byte> into) override {
    for (std::byte& byte : into) {
      const std::string& word = text_.next();
      if (word.empty()) throw IoError(fmt::format("{}: {} numbers of data expected, {} found", path_, count_, done_));
      const auto value = parse_real(word);
      if (!value || !(*value >= 0.0 && *value <= 1.0))
        throw InvalidInput(fmt::format("{}: '{}', value {} of the data, is no number from 0 to 1 as COLOR_SCALARS are",
                                       path_, excerpt(word), done_));
      byte = std::byte(std::lround(255.0 * *value));
      ++done_;
    }
    return into.size();
  }

 private:
  NumberText& text_;
  std::string path_;
  std::uint64_t count_;
  std::uint64_t done_ = 0;
};

DecodedValues read_fractions(NumberText& text, const LegacyVtk& header, const ReadOptions& options, const Run& run) {
  const std::uint64_t count = header.lattice.count();
  Fractions bytes(text, header.data.file, count);
  return decode_scalars(bytes, header.data.layout, count, options, header.data.file, run);
}

VtkValues read_text(const LegacyVtk& header, const ReadOptions& options, const Run& run) {
  const std::uint64_t count = header.lattice.count();
  const std::string& path = header.data.file;
  NumberText text(path, header.data.offset, kTextBlanks);
  DecodedValues values = header.colours ? read_fractions(text, header, options, run)
                                        : read_text_values(text, header.data.layout.type, count, options, path, run);
  const std::vector<std::string> behind = words_at(path, text.offset());
  if (!behind.empty() && parse_real(behind.front()))
    throw IoError(
        fmt::format("{}: {} numbers of data expected, more found: '{}'", path, count, excerpt(behind.front())));
  return {std::move(values), attribute_of(behind)};
}

}  // namespace

bool is_legacy_vtk(const std::string& path) { return first_bytes(path, kMagic.size()) == kMagic; }

LegacyVtk read_legacy_vtk_header(const std::string& path) {
  const std::uint64_t file_size = require_file(path);
  if (!is_legacy_vtk(path)) throw InvalidInput(fmt::format("{}: no legacy VTK file: '{}' is missing", path, kMagic));
  VtkHeader header(path);
  (void)header.any_line();
  (void)header.any_line();  // the title, which may be empty
  const std::string encoding = header.line().front();
  if (encoding != "binary" && encoding != "ascii")
    throw InvalidInput(fmt::format("{}: VTK encoding '{}': allowed are BINARY and ASCII", path, excerpt(encoding)));
  const auto words = header.line();
  if (words.size() != 2 || words[0] != "dataset" || words[1] != "structured_points")
    throw InvalidInput(
        fmt::format("{}: VTK '{}': supported is DATASET STRUCTURED_POINTS", path, excerpt(words.back())));
  LegacyVtk result;
  result.text = encoding == "ascii";
  const auto scalars = read_lattice(path, header, result.lattice);
  result.colours = scalars.front() == kColours;
  if (result.colours && (scalars.size() != 3 || scalars[2] != "1"))
    throw InvalidInput(fmt::format("{}: VTK COLOR_SCALARS of {} components: a volume has one", path,
                                   excerpt(scalars.size() == 3 ? scalars[2] : "no number of")));
  if (scalars.size() < 3 || scalars.size() > 4 || (scalars.size() == 4 && scalars[3] != "1"))
    throw InvalidInput(fmt::format("{}: VTK SCALARS need a name, a type and one component", path));
  result.name = excerpt(scalars[1]);
  if (!result.colours && header.line().front() != "lookup_table")
    throw InvalidInput(fmt::format("{}: VTK SCALARS without a LOOKUP_TABLE line", path));
  const ScalarType type = result.colours ? ScalarType::kUint8 : scalar_type(path, scalars[2]);
  result.data = {.file = path, .offset = header.end(), .more_allowed = true, .layout = {type, true}};
  const std::uint64_t count = result.lattice.count();
  if (!result.text) require_room(result.data, count);
  if (result.text && count > file_size)
    throw IoError(fmt::format("{}: {} numbers of data expected in {} bytes", path, count, file_size));
  return result;
}

VtkValues read_legacy_vtk_values(const LegacyVtk& header, const ReadOptions& options, const Run& run) {
  if (header.text) return read_text(header, options, run);
  const DataPlace& place = header.data;
  const std::uint64_t count = header.lattice.count();
  return {read_values(place, count, options, run),
          attribute_of(words_at(place.file, place.offset + count * bytes_per_scalar(place.layout.type)))};
}

}  // namespace isolux::detail
