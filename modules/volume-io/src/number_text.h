#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace isolux::detail {

/// The whole text as a number, NaN and infinities among them; what is too small for double is 0. Nothing if it is none,
/// or too large.
[[nodiscard]] std::optional<double> parse_real(std::string_view text);

/// Words of a file with `separators` between them, which outlive this, as far as the byte `end`, or all.
class NumberText {
 public:
  NumberText(const std::string& path, std::uint64_t offset, std::string_view separators, std::optional<char> end = {});
  /// The next word; empty at the end. \throw IoError for one that is far too long for a number
  const std::string& next();
  /// The last word as a number that float holds, NaN and infinities among them. \throw InvalidInput naming the file,
  /// the word and its place among them, counted from 0
  [[nodiscard]] double number() const;
  /// The place in the file behind the last word and the separator that ends it.
  [[nodiscard]] std::uint64_t offset() const { return offset_; }

 private:
  std::string path_;
  std::ifstream file_;
  std::string_view separators_;
  std::optional<char> end_;
  std::string word_;
  std::uint64_t words_ = 0;
  std::uint64_t offset_ = 0;
};

}  // namespace isolux::detail
