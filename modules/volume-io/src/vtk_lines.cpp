#include "vtk_lines.h"

#include "files.h"
#include "plain_text.h"

#include <algorithm>

namespace isolux::detail {
namespace {

constexpr std::size_t kBuffer = 1 << 16;
constexpr std::size_t kLongestLine = 1 << 14;

// One of kTextBlanks, without a search: all of a file's text is looked at.
bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

VtkLines::VtkLines(const std::string& path) : file_(path, std::ios::binary), size_(require_file(path)) {}

bool VtkLines::more() {
  if (at_ < buffer_.size()) return true;
  begin_ += buffer_.size();
  at_ = 0;
  buffer_.resize(kBuffer);
  file_.read(buffer_.data(), std::streamsize(buffer_.size()));
  buffer_.resize(std::size_t(file_.gcount()));
  return !buffer_.empty();
}

std::optional<std::string> VtkLines::line() {
  if (!more()) return std::nullopt;
  std::string text;
  while (more()) {
    const char c = buffer_[at_++];
    if (c == '\n') break;
    if (text.size() < kLongestLine) text += c;
  }
  return text;
}

std::vector<std::string> VtkLines::words() {
  while (const auto text = line()) {
    if (auto words = plain_words(*text); !words.empty()) return words;
  }
  return {};
}

std::optional<std::uint8_t> VtkLines::byte() {
  if (!more()) return std::nullopt;
  return std::uint8_t(buffer_[at_++]);
}

bool VtkLines::skip_bytes(std::uint64_t count) {
  if (count > size_ - std::min(size_, offset())) return false;
  if (count <= buffer_.size() - at_) {
    at_ += std::size_t(count);
    return true;
  }
  begin_ = offset() + count;
  buffer_.clear();
  at_ = 0;
  file_.clear();
  file_.seekg(std::streamoff(begin_));
  return true;
}

bool VtkLines::skip_words(std::uint64_t count) {
  bool in_word = false;
  for (; count > 0 && more(); ++at_) {
    const bool blank = is_blank(buffer_[at_]);
    if (in_word && blank && --count == 0) return true;
    in_word = !blank;
  }
  return count == 0 || (count == 1 && in_word);
}

}  // namespace isolux::detail
