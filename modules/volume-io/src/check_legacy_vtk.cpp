#include "files.h"
#include "format_checks.h"
#include "nrrd_text.h"
#include "number_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

namespace isolux::detail {
namespace {

constexpr std::string_view kMagic = "# vtk DataFile Version";
constexpr std::size_t kLongestVtkHeader = 1 << 14;

class VtkHeader {
 public:
  explicit VtkHeader(const std::string& path) : path_(path), bytes_(first_bytes(path, kLongestVtkHeader)) {}

  /// The next line that is not blank, as words.
  std::vector<std::string> line() {
    while (end_ < bytes_.size()) {
      const std::size_t newline = bytes_.find('\n', end_);
      if (newline == std::string::npos) break;
      auto words = nrrd_words(std::string_view(bytes_).substr(end_, newline - end_));
      end_ = newline + 1;
      if (!words.empty()) return words;
    }
    throw IoError(fmt::format("{}: the VTK header ends early", path_));
  }
  [[nodiscard]] std::size_t end() const { return end_; }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

  [[nodiscard]] double number(const std::vector<std::string>& words, std::size_t index) const {
    double value = 0.0;
    const std::string word = index < words.size() ? words[index] : "";
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      throw InvalidInput(fmt::format("{}: VTK '{}': '{}' is not a number", path_, words.front(), word));
    return value;
  }
  [[nodiscard]] std::array<double, 3> triple(const std::vector<std::string>& words) const {
    if (words.size() != 4) throw InvalidInput(fmt::format("{}: VTK '{}' needs three numbers", path_, words.front()));
    return {number(words, 1), number(words, 2), number(words, 3)};
  }

 private:
  std::string path_;
  std::string bytes_;
  std::size_t end_ = 0;
};

ScalarType voxel_type(const std::string& path, const std::string& type) {
  static const std::map<std::string, ScalarType> types = {
      {"char", ScalarType::kInt8},          {"unsigned_char", ScalarType::kUint8},
      {"short", ScalarType::kInt16},        {"unsigned_short", ScalarType::kUint16},
      {"int", ScalarType::kInt32},          {"unsigned_int", ScalarType::kUint32},
      {"float", ScalarType::kFloat32},      {"double", ScalarType::kFloat64},
      {"long", ScalarType::kInt64},         {"unsigned_long", ScalarType::kUint64},
      {"vtktypeint64", ScalarType::kInt64}, {"vtktypeuint64", ScalarType::kUint64}};
  const auto it = types.find(type);
  if (it == types.end())
    throw InvalidInput(
        fmt::format("{}: VTK scalars of type '{}': supported are (unsigned_)char, (unsigned_)short, "
                    "(unsigned_)int, (unsigned_)long, float and double",
                    path, type));
  return it->second;
}

/// ITK takes what it cannot read of a text, and all behind it, for 0. \throw IoError, InvalidInput
void check_text(const std::string& path, std::uint64_t offset, std::uint64_t count, ScalarType type) {
  NumberText text(path, offset, " \n\r\t\f\v");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string& word = text.next();
    if (word.empty()) throw IoError(fmt::format("{}: {} numbers of data expected, {} found", path, count, i));
    if (!reads_as(type, word))
      throw InvalidInput(fmt::format("{}: '{}', value {} of the data, is no finite {}", path, word.substr(0, 40), i,
                                     scalar_type_name(type)));
  }
}

}  // namespace

bool is_legacy_vtk(const std::string& path) { return first_bytes(path, kMagic.size()) == kMagic; }

CheckedHeader check_legacy_vtk(const std::string& path) {
  const std::uint64_t file_size = require_file(path);
  VtkHeader header(path);
  (void)header.line();
  (void)header.line();
  const std::string encoding = header.line().front();
  if (encoding != "BINARY" && encoding != "ASCII")
    throw InvalidInput(fmt::format("{}: VTK encoding '{}': allowed are BINARY and ASCII", path, encoding));
  auto words = header.line();
  if (words.size() != 2 || words[0] != "DATASET" || words[1] != "STRUCTURED_POINTS")
    throw InvalidInput(fmt::format("{}: VTK '{}': supported is DATASET STRUCTURED_POINTS", path, words.back()));
  std::array<std::int64_t, 3> sizes{};
  std::uint64_t count = 0;
  for (words = header.line(); words.front() != "SCALARS"; words = header.line()) {
    if (words.front() == "DIMENSIONS") {
      const auto numbers = header.triple(words);
      for (std::size_t a = 0; a < 3; ++a)
        sizes.at(a) = numbers.at(a) >= 1.0 && numbers.at(a) < 1e15 ? std::int64_t(numbers.at(a)) : 0;
      count = checked_count(path, sizes, 8);
    } else if (words.front() == "SPACING" || words.front() == "ASPECT_RATIO") {
      require_spacing(path, header.triple(words));
    } else if (words.front() == "ORIGIN") {
      require_finite(path, "the origin", header.triple(words));
    } else if (words.front() == "POINT_DATA") {
      if (count == 0 || header.number(words, 1) != double(count))
        throw InvalidInput(fmt::format("{}: VTK POINT_DATA {}: DIMENSIONS make {}", path, words.back(), count));
    } else {
      throw InvalidInput(
          fmt::format("{}: VTK '{}' before SCALARS is not supported", path, words.front().substr(0, 40)));
    }
  }
  if (count == 0) throw InvalidInput(fmt::format("{}: VTK has no DIMENSIONS", path));
  if (words.size() < 3 || words.size() > 4 || (words.size() == 4 && words[3] != "1"))
    throw InvalidInput(fmt::format("{}: VTK SCALARS need a name, a type and one component", path));
  const ScalarType type = voxel_type(path, words[2]);
  if (header.line().front() != "LOOKUP_TABLE")
    throw InvalidInput(fmt::format("{}: VTK SCALARS without a LOOKUP_TABLE line", path));
  // Further attributes may follow: the format says so.
  if (encoding == "ASCII") {
    check_text(path, header.end(), count, type);
  } else if (const auto needed = count * bytes_per_scalar(type); file_size - header.end() < needed) {
    throw IoError(fmt::format("{}: {} bytes of data expected, {} found", path, needed, file_size - header.end()));
  }
  return {.size = {int(sizes[0]), int(sizes[1]), int(sizes[2])}};
}

}  // namespace isolux::detail
