#pragma once

#include <isolux/core/vec.h>

#include <string>
#include <vector>

namespace isolux {

/// Points of a text table, one a line: columns parted by semicolons, else by commas, else by blanks. A first line
/// without numbers names the columns: x, y and z are found by their names, in any other table they are the first three.
/// Empty lines and those that begin with # are passed over. A table without points is one only if it names x, y and z.
/// \throw IoError; InvalidInput naming file and line.
[[nodiscard]] std::vector<Vec3> read_point_table(const std::string& path);

}  // namespace isolux
