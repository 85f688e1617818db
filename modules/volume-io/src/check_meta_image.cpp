#include "files.h"
#include "format_checks.h"
#include "number_text.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace isolux::detail {
namespace {

constexpr std::size_t kLongestMetaHeader = 1 << 16;
constexpr std::size_t kLongestText = 254;

struct MetaText {
  std::map<std::string, std::string> fields;
  std::vector<std::string> keys;  ///< in the file's order
  std::uint64_t end = 0;          ///< offset behind the header
};

// Lines "Key = Value" up to ElementDataFile, the last one.
MetaText read_meta_text(const std::string& path) {
  const std::string bytes = first_bytes(path, kLongestMetaHeader);
  MetaText text;
  while (text.end < bytes.size()) {
    const std::size_t newline = bytes.find('\n', text.end);
    const std::string line = bytes.substr(text.end, newline - text.end);
    text.end = newline == std::string::npos ? bytes.size() : newline + 1;
    const auto words = plain_words(line);
    if (words.empty()) continue;
    const auto equals = line.find('=');
    if (equals == std::string::npos)
      throw InvalidInput(fmt::format("{}: a MetaImage header line is not of the form 'Key = Value'", path));
    const auto key = plain_words(line.substr(0, equals));
    if (key.size() != 1) throw InvalidInput(fmt::format("{}: a MetaImage header line has no key", path));
    const auto values = plain_words(line.substr(equals + 1));
    std::string value;
    for (const auto& word : values) value += value.empty() ? word : " " + word;
    if (!text.fields.emplace(key.front(), value).second)
      throw InvalidInput(fmt::format("{}: '{}' is given twice", path, excerpt(key.front())));
    text.keys.push_back(key.front());
    if (key.front() == "ElementDataFile") return text;
  }
  throw InvalidInput(fmt::format("{}: the MetaImage header has no ElementDataFile", path));
}

class MetaFields {
 public:
  MetaFields(const std::string& path, MetaText text) : path_(path), text_(std::move(text)) {}

  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise = {}) const {
    const auto it = text_.fields.find(key);
    return it == text_.fields.end() ? otherwise : it->second;
  }
  [[nodiscard]] bool has(const std::string& key) const { return text_.fields.contains(key); }
  [[nodiscard]] bool truth(const std::string& key, bool otherwise) const {
    const std::string word = lower_case(text(key, otherwise ? "true" : "false"));
    if (word == "true" || word == "1") return true;
    if (word == "false" || word == "0") return false;
    refuse(key, "allowed are True and False");
  }
  [[nodiscard]] double number(const std::string& key, double otherwise) const {
    const auto values = numbers(key, 1);
    return values.empty() ? otherwise : values.front();
  }
  /// Whether the header has both and `first` stands before `second`.
  [[nodiscard]] bool in_order(const std::string& first, const std::string& second) const {
    const auto at = [&](const std::string& key) { return std::find(text_.keys.begin(), text_.keys.end(), key); };
    return at(first) < at(second) && at(second) != text_.keys.end();
  }
  /// `count` numbers, or none if the key is not there.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) const {
    std::vector<double> values;
    for (const auto& word : plain_words(text(key))) {
      const auto value = parse_real(word);
      if (!value || !std::isfinite(*value)) refuse(key, "finite numbers are needed");
      values.push_back(*value);
    }
    if (text_.fields.contains(key) && values.size() != count) refuse(key, fmt::format("{} numbers are needed", count));
    return values;
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[noreturn]] void refuse(const std::string& key, std::string_view allowed) const {
    throw InvalidInput(fmt::format("{}: '{} = {}': {}", path_, key, excerpt(text(key)), allowed));
  }

 private:
  std::string path_;
  MetaText text_;
};

ScalarType element_type(const MetaFields& fields) {
  // MET_LONG has four bytes, whatever a long has.
  static const std::map<std::string, ScalarType> types = {
      {"MET_CHAR", ScalarType::kInt8},       {"MET_UCHAR", ScalarType::kUint8},
      {"MET_SHORT", ScalarType::kInt16},     {"MET_USHORT", ScalarType::kUint16},
      {"MET_INT", ScalarType::kInt32},       {"MET_UINT", ScalarType::kUint32},
      {"MET_LONG", ScalarType::kInt32},      {"MET_ULONG", ScalarType::kUint32},
      {"MET_LONG_LONG", ScalarType::kInt64}, {"MET_ULONG_LONG", ScalarType::kUint64},
      {"MET_FLOAT", ScalarType::kFloat32},   {"MET_DOUBLE", ScalarType::kFloat64}};
  const auto it = types.find(fields.text("ElementType"));
  if (it == types.end())
    fields.refuse("ElementType",
                  "supported are MET_ CHAR, SHORT, INT, LONG, LONG_LONG, their "
                  "unsigned forms, FLOAT and DOUBLE");
  return it->second;
}

// What MetaIO, which reads the frame, crashes on or refuses without saying why.
void check_for_meta_io(const MetaFields& fields) {
  for (const auto* key : {"DimSize", "ElementSpacing", "ElementSize", "Offset", "Position", "Origin", "TransformMatrix",
                          "Rotation", "Orientation", "CenterOfRotation"})
    if (fields.has(key) && !fields.in_order("NDims", key)) fields.refuse(key, "NDims has to stand before it");
  for (const auto* key : {"Comment", "Name", "ObjectSubType", "TransformType", "AnatomicalOrientation", "Modality",
                          "DistanceUnits", "AcquisitionDate"})
    if (const auto length = fields.text(key).size(); length > kLongestText)
      throw InvalidInput(
          fmt::format("{}: '{}' of {} letters: allowed are {}", fields.path(), key, length, kLongestText));
}

bool is_big_endian(const MetaFields& fields) {
  const char* const key = fields.has("ElementByteOrderMSB") ? "ElementByteOrderMSB" : "BinaryDataByteOrderMSB";
  const bool big = fields.truth(key, false);
  if (fields.truth("BinaryDataByteOrderMSB", big) != big)
    fields.refuse("BinaryDataByteOrderMSB",
                  fmt::format("ElementByteOrderMSB = {} says otherwise", excerpt(fields.text("ElementByteOrderMSB"))));
  return big;
}

std::array<std::int64_t, 3> sizes(const MetaFields& fields) {
  if (fields.text("NDims") != "3") fields.refuse("NDims", "a volume has 3");
  const auto numbers = fields.numbers("DimSize", 3);
  if (numbers.empty()) fields.refuse("DimSize", "three whole numbers are needed");
  std::array<std::int64_t, 3> result{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (std::floor(numbers[a]) != numbers[a] || std::fabs(numbers[a]) > 1e15)
      fields.refuse("DimSize", "three whole numbers are needed");
    result.at(a) = std::int64_t(numbers[a]);
  }
  return result;
}

void check_geometry(const std::string& path, const MetaFields& fields) {
  for (const auto* key : {"ElementSpacing", "ElementSize"}) {
    if (const auto spacing = fields.numbers(key, 3); !spacing.empty()) require_spacing(path, spacing);
  }
  for (const auto* key : {"Offset", "Position", "Origin"}) (void)fields.numbers(key, 3);
  for (const auto* key : {"TransformMatrix", "Rotation", "Orientation"}) {
    const auto m = fields.numbers(key, 9);
    if (m.empty()) continue;
    const double determinant =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    if (!(std::fabs(determinant) > 1e-6)) fields.refuse(key, "directions that span a volume are needed");
  }
}

bool is_local(const MetaFields& fields) {
  const std::string named = fields.text("ElementDataFile");
  return named == "LOCAL" || named == "Local" || named == "local";
}

std::string data_file(const std::string& path, const MetaFields& fields, const ReadOptions& options) {
  if (is_local(fields)) return path;
  const std::string named = fields.text("ElementDataFile");
  if (named.empty() || named.starts_with("LIST") || named.find('%') != std::string::npos)
    fields.refuse("ElementDataFile", "supported are LOCAL and the name of one file");
  return resolve_data_file(path, named, options.allow_external_data);
}

// Where the data begin in their file, and whether something may stand behind them.
void place_data(const MetaFields& fields, std::uint64_t header_end, std::uint64_t count, DataPlace& place) {
  const bool local = is_local(fields);
  const double skip = fields.number("HeaderSize", 0.0);
  if (skip < -1.0 || skip > 1e15 || std::floor(skip) != skip)
    fields.refuse("HeaderSize", "a whole number of at least -1 is needed");
  // MetaIO counts from the file's start even behind a header of its own, which nobody can mean.
  if (local && skip > 0.0) fields.refuse("HeaderSize", "allowed beside ElementDataFile = LOCAL are 0 and -1");
  if (place.compressed && skip < 0.0) fields.refuse("HeaderSize", "allowed of compressed data is 0 and more");
  place.more_allowed = skip != 0.0;
  place.offset = (local ? header_end : 0) + std::uint64_t(std::max(skip, 0.0));
  const std::uint64_t size = require_file(place.file);
  if (place.offset > size)
    throw IoError(fmt::format("{}: the data begin at byte {}, the file has {}", place.file, place.offset, size));
  require_room(place, count);
  // -1: the data are the file's last bytes.
  if (skip < 0.0) place.offset = size - count * bytes_per_scalar(place.layout.type);
}

}  // namespace

std::string meta_image_data_file(const std::string& path, const ReadOptions& options) {
  return data_file(path, MetaFields(path, read_meta_text(path)), options);
}

bool is_meta_image(const std::string& path) {
  const std::string bytes = first_bytes(path, 4096);
  return (bytes.starts_with("ObjectType") || bytes.starts_with("NDims") || bytes.starts_with("Comment")) &&
         bytes.find("NDims") != std::string::npos;
}

CheckedHeader check_meta_image(const std::string& path, const ReadOptions& options) {
  (void)require_file(path);
  MetaText text = read_meta_text(path);
  const std::uint64_t header_end = text.end;
  const MetaFields fields(path, std::move(text));
  const auto size = sizes(fields);
  const ScalarType type = element_type(fields);
  if (fields.text("ElementNumberOfChannels", "1") != "1")
    fields.refuse("ElementNumberOfChannels", "supported is 1, one number a voxel");
  if (!fields.truth("BinaryData", true)) fields.refuse("BinaryData", "supported is True");
  check_geometry(path, fields);
  check_for_meta_io(fields);
  // A compressed stream says itself where it ends: CompressedDataSize, which many files lack, is not needed.
  DataPlace place{.file = data_file(path, fields, options),
                  .compressed = fields.truth("CompressedData", false),
                  .layout = {type, is_big_endian(fields)},
                  .slope = fields.number("ElementToIntensityFunctionSlope", 1.0),
                  .intercept = fields.number("ElementToIntensityFunctionOffset", 0.0)};
  if (place.slope == 0.0) fields.refuse("ElementToIntensityFunctionSlope", "a number other than 0 is needed");
  place_data(fields, header_end, checked_count(path, size, bytes_per_scalar(type)), place);
  return {.size = {int(size[0]), int(size[1]), int(size[2])}, .type = type, .data = std::move(place)};
}

}  // namespace isolux::detail
