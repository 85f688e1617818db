#include "nrrd_text.h"

#include "files.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <utility>

namespace isolux::detail {
namespace {

constexpr std::size_t kLongestLine = std::size_t(1) << 26;
constexpr std::size_t kMostLines = 100000;

constexpr std::array<std::string_view, 30> kFieldNames = {"content",
                                                          "number",
                                                          "type",
                                                          "block size",
                                                          "dimension",
                                                          "space",
                                                          "space dimension",
                                                          "sizes",
                                                          "spacings",
                                                          "thicknesses",
                                                          "axis mins",
                                                          "axis maxs",
                                                          "centerings",
                                                          "labels",
                                                          "units",
                                                          "kinds",
                                                          "min",
                                                          "max",
                                                          "old min",
                                                          "old max",
                                                          "endian",
                                                          "encoding",
                                                          "data file",
                                                          "line skip",
                                                          "byte skip",
                                                          "sample units",
                                                          "space units",
                                                          "space origin",
                                                          "space directions",
                                                          "measurement frame"};

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kSynonyms = {{{"centers", "centerings"},
                                                                                      {"axismins", "axis mins"},
                                                                                      {"axismaxs", "axis maxs"},
                                                                                      {"blocksize", "block size"},
                                                                                      {"oldmin", "old min"},
                                                                                      {"oldmax", "old max"},
                                                                                      {"datafile", "data file"},
                                                                                      {"lineskip", "line skip"},
                                                                                      {"byteskip", "byte skip"},
                                                                                      {"sampleunits", "sample units"}}};

std::string field_name(std::string_view written) {
  std::string name = lower_case(written);
  for (const auto& [synonym, canonical] : kSynonyms) {
    if (name == synonym) return std::string(canonical);
  }
  return name;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

std::string unescape(std::string_view value) {
  std::string text;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == '\\' && i + 1 < value.size() && (value[i + 1] == 'n' || value[i + 1] == '\\')) {
      text += value[++i] == 'n' ? '\n' : '\\';
    } else {
      text += value[i];
    }
  }
  return text;
}

bool is_list(std::string_view data_file) { return first_word(data_file) == "LIST"; }

// Whether the line ends the fields: names of files follow, to the header's end.
bool take_line(const std::string& path, const std::string& line, NrrdText& text) {
  // A key may have colons in it, a field's name not.
  if (const auto pair = line.find(":="); pair < line.find(": ")) {
    text.key_values[unescape(std::string_view(line).substr(0, pair))] = unescape(line.substr(pair + 2));
    return false;
  }
  const auto colon = line.find(':');
  if (colon == std::string::npos || colon + 1 >= line.size())
    throw InvalidInput(
        fmt::format("{}: header line '{}' is neither 'field: value' nor 'key:=value'", path, excerpt(line)));
  const std::string name = field_name(std::string_view(line).substr(0, colon));
  if (std::find(kFieldNames.begin(), kFieldNames.end(), name) == kFieldNames.end())
    throw InvalidInput(fmt::format("{}: NRRD has no field '{}'", path, excerpt(name)));
  const auto [field, is_new] = text.fields.emplace(name, trimmed(std::string_view(line).substr(colon + 1)));
  if (!is_new) throw InvalidInput(fmt::format("{}: the field '{}' is given twice", path, name));
  return name == "data file" && is_list(field->second);
}

}  // namespace

NrrdText read_nrrd_text(const std::string& path) {
  (void)require_file(path);
  std::ifstream file(path, std::ios::binary);
  NrrdText text;
  std::string line;
  for (std::size_t number = 0; number < kMostLines; ++number) {
    line.clear();
    int c = file.get();
    for (; c != std::ifstream::traits_type::eof() && c != '\n'; c = file.get()) {
      line += char(c);
      if (line.size() > kLongestLine)
        throw InvalidInput(fmt::format("{}: a header line is longer than {} bytes", path, kLongestLine));
    }
    text.end += line.size() + (c == '\n' ? 1 : 0);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 0) {
      if (line.size() != 8 || line.compare(0, 7, "NRRD000") != 0 || line[7] < '1' || line[7] > '6')
        throw InvalidInput(
            fmt::format("{}: the first line is '{}'; allowed are NRRD0001 to NRRD0006", path, excerpt(line)));
    } else if (line.empty()) {
      return text;
    } else if (line.front() != '#') {
      if (take_line(path, line, text)) return text;
    }
    if (c == std::ifstream::traits_type::eof()) return text;
  }
  throw InvalidInput(fmt::format("{}: the header has more than {} lines", path, kMostLines));
}

std::vector<std::string> nrrd_words(std::string_view text) {
  std::vector<std::string> words;
  int depth = 0;
  bool inside = false;
  for (const char c : text) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (blank && depth == 0) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (!blank) words.back() += c;
  }
  return words;
}

bool names_several_files(std::string_view field) {
  return is_list(field) || (field.find('%') != std::string_view::npos && nrrd_words(field).size() >= 4);
}

bool can_be_data_file(std::string_view name) {
  const bool one_line = name.find_first_of("\n\r") == std::string_view::npos;
  return one_line && !name.empty() && trimmed(name) == name && !names_several_files(name);
}

std::string escape_nrrd_value(std::string_view value) {
  std::string text;
  for (const char c : value) {
    if (c == '\n') {
      text += "\\n";
    } else if (c == '\\') {
      text += "\\\\";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace isolux::detail
