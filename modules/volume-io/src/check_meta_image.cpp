#include "files.h"
#include "format_checks.h"
#include "nrrd_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

namespace isolux::detail {
namespace {

constexpr std::size_t kLongestMetaHeader = 1 << 16;

struct MetaText {
  std::map<std::string, std::string> fields;
  std::uint64_t end = 0;  ///< offset behind the header
};

// Lines "Key = Value" up to ElementDataFile, the last one.
MetaText read_meta_text(const std::string& path) {
  const std::string bytes = first_bytes(path, kLongestMetaHeader);
  MetaText text;
  while (text.end < bytes.size()) {
    const std::size_t newline = bytes.find('\n', text.end);
    const std::string line = bytes.substr(text.end, newline - text.end);
    text.end = newline == std::string::npos ? bytes.size() : newline + 1;
    const auto words = nrrd_words(line);
    if (words.empty()) continue;
    const auto equals = line.find('=');
    if (equals == std::string::npos)
      throw InvalidInput(fmt::format("{}: a MetaImage header line is not of the form 'Key = Value'", path));
    const auto key = nrrd_words(line.substr(0, equals));
    if (key.size() != 1) throw InvalidInput(fmt::format("{}: a MetaImage header line has no key", path));
    const auto values = nrrd_words(line.substr(equals + 1));
    std::string value;
    for (const auto& word : values) value += value.empty() ? word : " " + word;
    if (!text.fields.emplace(key.front(), value).second)
      throw InvalidInput(fmt::format("{}: '{}' is given twice", path, key.front()));
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
  [[nodiscard]] bool truth(const std::string& key) const {
    const std::string word = text(key, "False");
    if (word == "True" || word == "true" || word == "1") return true;
    if (word == "False" || word == "false" || word == "0") return false;
    refuse(key, "allowed are True and False");
  }
  /// `count` numbers, or none if the key is not there.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) const {
    std::vector<double> values;
    for (const auto& word : nrrd_words(text(key))) {
      double value = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        refuse(key, "finite numbers are needed");
      values.push_back(value);
    }
    if (text_.fields.contains(key) && values.size() != count) refuse(key, fmt::format("{} numbers are needed", count));
    return values;
  }
  [[noreturn]] void refuse(const std::string& key, std::string_view allowed) const {
    throw InvalidInput(fmt::format("{}: '{} = {}': {}", path_, key, text(key), allowed));
  }

 private:
  std::string path_;
  MetaText text_;
};

std::size_t voxel_bytes(const MetaFields& fields) {
  static const std::map<std::string, std::size_t> types = {
      {"MET_CHAR", 1},      {"MET_UCHAR", 1},      {"MET_SHORT", 2}, {"MET_USHORT", 2},
      {"MET_INT", 4},       {"MET_UINT", 4},       {"MET_LONG", 4},  {"MET_ULONG", 4},
      {"MET_LONG_LONG", 8}, {"MET_ULONG_LONG", 8}, {"MET_FLOAT", 4}, {"MET_DOUBLE", 8}};
  const auto it = types.find(fields.text("ElementType"));
  if (it == types.end())
    fields.refuse("ElementType",
                  "supported are MET_ CHAR, SHORT, INT, LONG, LONG_LONG, their "
                  "unsigned forms, FLOAT and DOUBLE");
  return it->second;
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
  const std::size_t width = voxel_bytes(fields);
  if (fields.text("ElementNumberOfChannels", "1") != "1")
    fields.refuse("ElementNumberOfChannels", "supported is 1, one number a voxel");
  if (fields.text("BinaryData", "True") != "True") fields.refuse("BinaryData", "supported is True");
  check_geometry(path, fields);
  const std::uint64_t needed = checked_count(path, size, width) * width;
  const auto skips = fields.numbers("HeaderSize", 1);
  if (!skips.empty() && (skips[0] < -1.0 || skips[0] > 1e15 || std::floor(skips[0]) != skips[0]))
    fields.refuse("HeaderSize", "a whole number of at least -1 is needed");

  const bool local = is_local(fields);
  const std::string data = data_file(path, fields, options);
  const std::uint64_t data_size = require_file(data);
  const std::uint64_t begin = (local ? header_end : 0) + std::uint64_t(skips.empty() ? 0.0 : std::max(skips[0], 0.0));
  if (begin > data_size)
    throw IoError(fmt::format("{}: the data begin at byte {}, the file has {}", data, begin, data_size));
  std::uint64_t found = data_size - begin;
  const bool compressed = fields.truth("CompressedData");
  if (compressed) {
    if (needed / kLargestInflation > data_size)
      throw IoError(
          fmt::format("{}: {} bytes expected, more than {} compressed bytes can hold", data, needed, data_size));
    found = inflated_bytes(data, begin, needed + 1);
  }
  // MetaIO takes the data from the end of a file that a HeaderSize of -1 stands for.
  const bool foreign = !skips.empty() && skips[0] != 0.0;
  if (found < needed || (found > needed && !foreign))
    throw IoError(fmt::format("{}: {} bytes of data expected, {} found", data, needed, found));
  return {.size = {int(size[0]), int(size[1]), int(size[2])}};
}

}  // namespace isolux::detail
