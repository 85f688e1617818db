#include "point_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// Without blanks and a pair of quotes around it, in which two quotes stand for one.
std::string bare(const std::string& field) {
  std::string text = trimmed(field);
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return text;
  text = trimmed(text.substr(1, text.size() - 2));
  for (std::size_t at = text.find("\"\""); at != std::string::npos; at = text.find("\"\"", at + 1)) text.erase(at, 1);
  return text;
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

/// The columns that a line of names says the points are in. \throw InvalidInput
Columns columns_of(const std::string& path, std::size_t line, const std::vector<std::string>& names) {
  if (const auto named = named_columns(names)) return *named;
  if (names.size() > 3)
    throw InvalidInput(
        fmt::format("{}: line {}: none of the columns '{}' are called x, y and z: name the three that the "
                    "points are in",
                    path, line, fmt::join(names, "', '")));
  return {0, 1, 2};
}

/// The fields beside the columns of points; "" for those that are not there.
std::vector<std::string> others_of(const std::vector<std::string>& fields, const Columns& columns, std::size_t count) {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < count; ++i)
    if (std::find(columns.begin(), columns.end(), i) == columns.end())
      others.push_back(i < fields.size() ? fields[i] : "");
  return others;
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

PointTable read_point_table(const std::string& path) {
  errno = 0;
  std::ifstream file(path);
  if (!file) throw IoError(fmt::format("{}: cannot open the points: {}", path, reason_of(errno)));
  PointTable table;
  std::size_t named = 0;           // columns
  std::optional<Columns> columns;  // known from the first line that holds anything
  bool is_table = false;           // that line gives points or says where they are
  std::string line;
  for (std::size_t number_of_line = 1; std::getline(file, line); ++number_of_line) {
    if (number_of_line == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    const auto fields = fields_of(line);
    if (!columns) {
      const bool names = are_names(fields);
      columns = names ? columns_of(path, number_of_line, fields) : Columns{0, 1, 2};
      is_table = names && named_columns(fields);
      if (names) {
        named = fields.size();
        table.names = others_of(fields, *columns, named);
        continue;
      }
    }
    const auto point = point_of(fields, *columns);
    if (!point) {
      throw InvalidInput(
          fmt::format("{}: line {}: '{}' where three numbers x,y,z are wanted", path, number_of_line, line));
    }
    table.points.push_back(*point);
    table.others.push_back(others_of(fields, *columns, named));
  }
  if (file.bad()) throw IoError(fmt::format("{}: cannot read the points: is it a file?", path));
  if (table.points.empty() && !is_table)
    throw InvalidInput(fmt::format("{}: no points: allowed are lines of three numbers x,y,z", path));
  return table;
}

}  // namespace isolux
