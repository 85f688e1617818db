#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace isolux::detail {

/// Numbers as text in a file, with `separators` between them.
class NumberText {
 public:
  NumberText(const std::string& path, std::uint64_t offset, std::string_view separators);
  /// The next word; empty at the end. \throw IoError if it is no text
  const std::string& next();
  /// The last word as a number that float or, with `doubles`, double holds (NaN and infinities are). \throw IoError
  /// naming the file, the word and its number among them, counted from 0
  [[nodiscard]] double number(bool doubles = false) const;

 private:
  std::string path_;
  std::ifstream file_;
  std::string_view separators_;
  std::string word_;
  std::uint64_t words_ = 0;
};

}  // namespace isolux::detail
