#include "nrrd_header.h"

#include "files.h"
#include "number_text.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace isolux::detail {
namespace {

constexpr std::int64_t kMostAxes = 16;

template <class Number>
std::optional<Number> nrrd_integer(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

const std::array<std::pair<ScalarType, std::vector<std::string_view>>, 10>& type_names() {
  static const std::array<std::pair<ScalarType, std::vector<std::string_view>>, 10> names = {{
      {ScalarType::kInt8, {"signed char", "int8", "int8_t"}},
      {ScalarType::kUint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {ScalarType::kInt16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {ScalarType::kUint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {ScalarType::kInt32, {"int", "signed int", "int32", "int32_t"}},
      {ScalarType::kUint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {ScalarType::kInt64,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"}},
      {ScalarType::kUint64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {ScalarType::kFloat32, {"float", "float32"}},
      {ScalarType::kFloat64, {"double", "float64"}},
  }};
  return names;
}

// Turns the text's fields into the header's members; every complaint names the file and the field.
class Interpreter {
 public:
  Interpreter(NrrdText text, NrrdHeader& header) : text_(std::move(text)), header_(header) {}

  void run(const ReadOptions& options) {
    header_.key_values = std::move(text_.key_values);
    // First, as behind LIST the other fields are not read.
    if (const std::string* named = find("data file"); named != nullptr && names_several_files(*named))
      refuse("data file", "data spread over several files are not supported; join them first");
    take_sizes();
    take_type();
    take_encoding();
    take_axis_numbers("spacings", &NrrdAxis::spacing);
    take_axis_numbers("axis mins", &NrrdAxis::min);
    take_axis_numbers("axis maxs", &NrrdAxis::max);
    take_axis_words();
    take_space();
    take_data_file(options);
  }

 private:
  [[noreturn]] void refuse(std::string_view field, std::string_view allowed) const {
    throw InvalidInput(
        fmt::format("{}: '{}: {}': {}", header_.path, field, excerpt(text_.fields.at(std::string(field))), allowed));
  }
  [[nodiscard]] const std::string* find(const std::string& field) const {
    const auto it = text_.fields.find(field);
    return it == text_.fields.end() ? nullptr : &it->second;
  }
  [[nodiscard]] const std::string& need(const std::string& field) const {
    const std::string* value = find(field);
    if (value == nullptr) throw InvalidInput(fmt::format("{}: the header has no '{}'", header_.path, field));
    return *value;
  }
  [[nodiscard]] std::vector<std::string> per_axis(const std::string& field) const {
    auto words = nrrd_words(text_.fields.at(field));
    if (words.size() != header_.axes.size())
      refuse(field, fmt::format("one value for each of the {} axes is needed", header_.axes.size()));
    return words;
  }

  void take_sizes() {
    const auto dimension = nrrd_integer<std::int64_t>(need("dimension"));
    if (!dimension || *dimension < 1 || *dimension > kMostAxes)
      refuse("dimension", fmt::format("allowed is 1 to {}", kMostAxes));
    header_.axes.resize(std::size_t(*dimension));
    (void)need("sizes");
    const auto words = per_axis("sizes");
    for (std::size_t a = 0; a < words.size(); ++a) {
      const auto size = nrrd_integer<std::int64_t>(words[a]);
      if (!size) refuse("sizes", "whole numbers are needed");
      header_.axes[a].size = *size;
    }
  }

  void take_type() {
    const std::string name = lower_case(fmt::format("{}", fmt::join(nrrd_words(need("type")), " ")));
    for (const auto& [type, names] : type_names()) {
      if (std::find(names.begin(), names.end(), name) == names.end()) continue;
      header_.layout.type = type;
      return;
    }
    refuse("type", "allowed are (u)int8, (u)int16, (u)int32, (u)int64, float, double and NRRD's synonyms");
  }

  void take_encoding() {
    const std::string encoding = lower_case(need("encoding"));
    if (encoding == "raw") {
      header_.encoding = NrrdEncoding::kRaw;
    } else if (encoding == "gzip" || encoding == "gz") {
      header_.encoding = NrrdEncoding::kGzip;
    } else if (encoding == "text" || encoding == "txt" || encoding == "ascii") {
      header_.encoding = NrrdEncoding::kText;
    } else {
      refuse("encoding", "supported are raw, gzip and ascii");
    }
    if (const std::string* written = find("endian"); written != nullptr) {
      const std::string endian = lower_case(*written);
      if (endian != "little" && endian != "big") refuse("endian", "allowed are little and big");
      header_.layout.big_endian = endian == "big";
    } else if (header_.encoding != NrrdEncoding::kText && bytes_per_scalar(header_.layout.type) > 1) {
      throw InvalidInput(fmt::format("{}: the header has no 'endian', which type {} needs", header_.path,
                                     scalar_type_name(header_.layout.type)));
    }
  }

  void take_axis_numbers(const std::string& field, std::optional<double> NrrdAxis::*member) {
    if (find(field) == nullptr) return;
    const auto words = per_axis(field);
    for (std::size_t a = 0; a < words.size(); ++a) {
      const auto value = parse_real(words[a]);
      if (!value) refuse(field, "numbers are needed");
      // NaN is NRRD's word for unknown.
      if (!std::isnan(*value)) header_.axes[a].*member = value;
    }
  }

  void take_axis_words() {
    if (find("kinds") != nullptr) {
      const auto words = per_axis("kinds");
      for (std::size_t a = 0; a < words.size(); ++a) header_.axes[a].kind = lower_case(words[a]);
    }
    if (find("centerings") != nullptr) {
      const auto words = per_axis("centerings");
      for (std::size_t a = 0; a < words.size(); ++a) header_.axes[a].node_centered = lower_case(words[a]) == "node";
    }
  }

  [[nodiscard]] Vec3 vector(const std::string& field, std::string_view word) const {
    Vec3 result(0.0);
    const bool closed = word.size() >= 2 && word.front() == '(' && word.back() == ')';
    std::string_view rest = closed ? word.substr(1, word.size() - 2) : std::string_view();
    for (int a = 0; a < 3; ++a) {
      const auto comma = rest.find(',');
      const auto value = parse_real(rest.substr(0, comma));
      if (!value || !std::isfinite(*value) || (comma == std::string_view::npos) != (a == 2))
        refuse(field, "vectors of three finite numbers such as (1,0,0) are needed");
      result[a] = *value;
      rest.remove_prefix(std::min(rest.size(), comma == std::string_view::npos ? rest.size() : comma + 1));
    }
    return result;
  }

  void take_space() {
    if (const std::string* space = find("space")) header_.space = *space;
    if (const std::string* dimension = find("space dimension"); dimension != nullptr && *dimension != "3")
      refuse("space dimension", "supported is 3");
    if (find("space directions") != nullptr) {
      const auto words = per_axis("space directions");
      for (std::size_t a = 0; a < words.size(); ++a) {
        if (words[a] != "none") header_.axes[a].direction = vector("space directions", words[a]);
      }
      header_.has_directions = true;
    }
    if (find("space origin") != nullptr) {
      const auto words = nrrd_words(text_.fields.at("space origin"));
      if (words.size() != 1) refuse("space origin", "one vector is needed");
      header_.origin = vector("space origin", words.front());
    }
  }

  void take_data_file(const ReadOptions& options) {
    if (find("line skip") != nullptr) {
      const auto skip = nrrd_integer<std::uint64_t>(text_.fields.at("line skip"));
      if (!skip) refuse("line skip", "a whole number of at least 0 is needed");
      header_.line_skip = *skip;
    }
    if (find("byte skip") != nullptr) {
      const auto skip = nrrd_integer<std::int64_t>(text_.fields.at("byte skip"));
      if (!skip || *skip < -1) refuse("byte skip", "a whole number of at least -1 is needed");
      header_.byte_skip = *skip;
      if (*skip == -1 && header_.encoding != NrrdEncoding::kRaw)
        refuse("byte skip", "-1 has a meaning for the encoding raw only");
    }
    const std::string* named = find("data file");
    if (named == nullptr) {
      header_.data_file = header_.path;
      header_.data_offset = text_.end;
      return;
    }
    if (named->empty()) refuse("data file", "a file's name is needed");
    header_.data_file = resolve_data_file(header_.path, *named, options.allow_external_data);
  }

  NrrdText text_;
  NrrdHeader& header_;
};

}  // namespace

NrrdHeader read_nrrd_header(const std::string& path, const ReadOptions& options) {
  NrrdHeader header;
  header.path = path;
  Interpreter(read_nrrd_text(path), header).run(options);
  return header;
}

}  // namespace isolux::detail
