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
#include <string_view>
#include <utility>

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

/// What parts the fields of a table's lines.
constexpr char kBlanks = ' ';  // any number of them

/// Takes fields off a line's front.
class Fields {
 public:
  Fields(const std::string& line, char separator) : line_(line), separator_(separator) { skip_blanks(); }

  [[nodiscard]] bool is_at_end() const { return at_ >= line_.size(); }
  /// The next field, without the blanks around it and the pair of quotes, in which two stand for one; nothing where a
  /// quote is not closed, or something follows it.
  std::optional<std::string> next() {
    const bool quoted = line_[at_] == '"';
    std::optional<std::string> field = quoted ? quoted_field() : plain_field();
    skip_blanks();
    if (!field || is_at_end() || separator_ == kBlanks) return field;
    if (line_[at_] != separator_) return std::nullopt;
    ++at_;
    skip_blanks();
    return field;
  }

 private:
  [[nodiscard]] bool parts(char c) const { return separator_ == kBlanks ? is_blank(c) : c == separator_; }
  void skip_blanks() {
    while (!is_at_end() && is_blank(line_[at_]) && (separator_ == kBlanks || line_[at_] != separator_)) ++at_;
  }
  std::string plain_field() {
    const std::size_t begin = at_;
    while (!is_at_end() && !parts(line_[at_])) ++at_;
    return trimmed(line_.substr(begin, at_ - begin));
  }
  std::optional<std::string> quoted_field() {
    std::string text;
    for (++at_; !is_at_end(); ++at_) {
      if (line_[at_] != '"') {
        text += line_[at_];
      } else if (at_ + 1 < line_.size() && line_[at_ + 1] == '"') {
        text += line_[at_++];
      } else {
        ++at_;
        const bool ends = is_at_end() || is_blank(line_[at_]) || parts(line_[at_]);
        return ends ? std::optional(trimmed(text)) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  const std::string& line_;
  char separator_;
  std::size_t at_ = 0;
};

/// A separator at the end of a line begins no field. \throw InvalidInput
std::vector<std::string> fields_of(const std::string& line, char separator, const std::string& where) {
  std::vector<std::string> fields;
  for (Fields rest(line, separator); !rest.is_at_end();) {
    auto field = rest.next();
    if (!field) throw InvalidInput(fmt::format("{}: '{}' has a quote that does not end with its field", where, line));
    fields.push_back(std::move(*field));
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

/// By the first line of a table, what it quotes left out. Where it has names, tabs part fields that may be empty.
char separator_of(const std::string& line, const std::string& where) {
  bool quoted = false;
  std::string plain;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted) plain += c;
  }
  for (const char separator : {';', ','})
    if (plain.find(separator) != std::string::npos) return separator;
  const bool has_tabs = plain.find('\t') != std::string::npos;
  return has_tabs && are_names(fields_of(line, kBlanks, where)) ? '\t' : kBlanks;
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
Columns columns_of(const std::string& where, const std::vector<std::string>& names) {
  if (const auto named = named_columns(names)) return *named;
  if (names.size() > 3)
    throw InvalidInput(
        fmt::format("{}: none of the columns '{}' are called x, y and z: name the three that the points are in", where,
                    fmt::join(names, "', '")));
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
  char separator = kBlanks;
  std::string line;
  for (std::size_t number_of_line = 1; std::getline(file, line); ++number_of_line) {
    if (number_of_line == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    const std::string where = fmt::format("{}: line {}", path, number_of_line);
    if (const std::string bare = trimmed(line); bare.empty() || bare[0] == '#') continue;
    if (!columns) separator = separator_of(line, where);
    const auto fields = fields_of(line, separator, where);
    if (!columns) {
      const bool names = are_names(fields);
      columns = names ? columns_of(where, fields) : Columns{0, 1, 2};
      is_table = names && named_columns(fields);
      if (names) {
        named = fields.size();
        table.names = others_of(fields, *columns, named);
        continue;
      }
    }
    const auto point = point_of(fields, *columns);
    if (!point) throw InvalidInput(fmt::format("{}: '{}' where three numbers x,y,z are wanted", where, trimmed(line)));
    if (is_table && fields.size() > named)
      throw InvalidInput(
          fmt::format("{}: '{}' has {} fields, of which {} have a name", where, trimmed(line), fields.size(), named));
    table.points.push_back(*point);
    table.others.push_back(others_of(fields, *columns, named));
  }
  if (file.bad()) throw IoError(fmt::format("{}: cannot read the points: is it a file?", path));
  if (table.points.empty() && !is_table)
    throw InvalidInput(fmt::format("{}: no points: allowed are lines of three numbers x,y,z", path));
  return table;
}

}  // namespace isolux
