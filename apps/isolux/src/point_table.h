#pragma once

#include <isolux/core/vec.h>

#include <string>
#include <vector>

namespace isolux {

/// Points, and what else their table says of them.
struct PointTable {
  std::vector<Vec3> points;
  std::vector<std::string> names;                ///< of the other columns, as given; none where no line names them
  std::vector<std::vector<std::string>> others;  ///< of each point, as many as `names`
};

/// Points of a text table, one a line: columns parted by what the first line has outside quotes, semicolons, else
/// commas, else, where it names columns, tabs, else blanks. A field in double quotes may hold any of these, and
/// two quotes for one. A first line without numbers names the columns: x, y and z are found by their names, or are the
/// only three; no line then has more fields, and those that it lacks are empty. Where no line names
/// them, they are the first three. Empty lines and those that begin with # are passed over. A table without points is
/// one only if it names x, y and z. \throw IoError; InvalidInput naming file and line, also for more than three named
/// columns without x, y and z among them.
[[nodiscard]] PointTable read_point_table(const std::string& path);

}  // namespace isolux
