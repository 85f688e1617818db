#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace isolux::detail {

/// A file of lines, between which numbers stand: as text, or as bytes that may look like anything.
class VtkLines {
 public:
  explicit VtkLines(const std::string& path);

  /// The next line without its end, cut where it is longer than lines of words are; nothing at the file's end.
  [[nodiscard]] std::optional<std::string> line();
  /// The words of the next line that has any; none at the file's end.
  [[nodiscard]] std::vector<std::string> words();
  /// The next byte; nothing at the file's end.
  [[nodiscard]] std::optional<std::uint8_t> byte();
  /// Whether there were so many bytes.
  [[nodiscard]] bool skip_bytes(std::uint64_t count);
  /// Up to so many words, with blanks or ends of lines between; whether there were so many.
  [[nodiscard]] bool skip_words(std::uint64_t count);

  /// The place in the file of what comes next.
  [[nodiscard]] std::uint64_t offset() const { return begin_ + at_; }

 private:
  /// Whether there is a byte at `at_`.
  bool more();

  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  ///< the place in the file of what is in the buffer
  std::string buffer_;
  std::size_t at_ = 0;
};

}  // namespace isolux::detail
