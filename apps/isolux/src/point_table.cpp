#include "point_table.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

namespace isolux {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets begin UTF-8 with it

using Columns = std::array<std::size_t, 3>;

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string trimmed(std::string text) {
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), is_blank));
  return text;
}

/// Without blanks and a pair of quotes around it.
std::string bare(const std::string& field) {
  const std::string text = trimmed(field);
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream words(line);
  const bool semicolons = line.find(';') != std::string::npos;
  if (semicolons || line.find(',') != std::string::npos) {
    for (std::string field; std::getline(words, field, semicolons ? ';' : ',');) fields.push_back(bare(field));
  } else {
    for (std::string field; words >> field;) fields.push_back(bare(field));
  }
  return fields;
}

std::optional<double> number(const std::string& text) {
  try {
    return parse_number("coordinate", text);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

/// As names do not: a number that is written wrong is no name either.
bool begins_like_a_number(const std::string& field) {
  return !field.empty() && std::string_view("0123456789+-.").find(field[0]) != std::string_view::npos;
}

bool are_names(const std::vector<std::string>& fields) {
  return std::none_of(fields.begin(), fields.end(), begins_like_a_number);
}

/// Where names say that x, y and z are, if they do.
std::optional<Columns> named_columns(const std::vector<std::string>& fields) {
  Columns columns{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto at = std::find_if(fields.begin(), fields.end(), [a](const std::string& field) {
      return field.size() == 1 && std::tolower(static_cast<unsigned char>(field[0])) == "xyz"[a];
    });
    if (at == fields.end()) return std::nullopt;
    columns[a] = std::size_t(at - fields.begin());
  }
  return columns;
}

std::optional<Vec3> point_of(const std::vector<std::string>& fields, const Columns& columns) {
  Vec3 point(0.0);
  for (int a = 0; a < 3; ++a) {
    const std::size_t column = columns[std::size_t(a)];
    const auto coordinate = column < fields.size() ? number(fields[column]) : std::nullopt;
    if (!coordinate) return std::nullopt;
    point[a] = *coordinate;
  }
  return point;
}

}  // namespace

std::vector<Vec3> read_point_table(const std::string& path) {
  errno = 0;
  std::ifstream file(path);
  if (!file) throw IoError(fmt::format("{}: cannot open the points: {}", path, reason_of(errno)));
  std::vector<Vec3> points;
  std::optional<Columns> columns;  // known from the first line that holds anything
  bool is_table = false;           // that line gives points or says where they are
  std::string line;
  for (std::size_t number_of_line = 1; std::getline(file, line); ++number_of_line) {
    if (number_of_line == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    const auto fields = fields_of(line);
    if (!columns) {
      const auto named = are_names(fields) ? named_columns(fields) : std::nullopt;
      columns = named.value_or(Columns{0, 1, 2});
      is_table = named.has_value();
      if (are_names(fields)) continue;
    }
    const auto point = point_of(fields, *columns);
    if (!point) {
      throw InvalidInput(
          fmt::format("{}: line {}: '{}' where three numbers x,y,z are wanted", path, number_of_line, line));
    }
    points.push_back(*point);
  }
  if (file.bad()) throw IoError(fmt::format("{}: cannot read the points: is it a file?", path));
  if (points.empty() && !is_table)
    throw InvalidInput(fmt::format("{}: no points: allowed are lines of three numbers x,y,z", path));
  return points;
}

}  // namespace isolux
