#pragma once

#include "files.h"
#include "header_bytes.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace isolux::detail {

constexpr std::uint32_t kUndefined = 0xFFFFFFFFu;
constexpr std::uint32_t kItem = 0xFFFEE000u;
constexpr std::uint32_t kItemEnd = 0xFFFEE00Du;
constexpr std::uint32_t kSequenceEnd = 0xFFFEE0DDu;
constexpr std::uint32_t kPixelData = 0x7FE00010u;
constexpr std::array<std::string_view, 13> kLongKinds = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                         "SV", "UC", "UN", "UR", "UT", "UV"};
constexpr std::array<std::string_view, 22> kShortKinds = {"??", "AE", "AS", "AT", "CS", "DA", "DS", "DT",
                                                          "FD", "FL", "IS", "LO", "LT", "PN", "SH", "SL",
                                                          "SS", "ST", "TM", "UI", "UL", "US"};
constexpr int kDeepest = 16;
constexpr std::size_t kFirstElement = 132;

struct Element {
  std::uint32_t tag = 0;
  std::uint32_t length = 0;
  std::string kind;         ///< value representation; empty where implicit
  bool known = true;        ///< whether there is such a kind
  std::uint64_t value = 0;  ///< its offset in the file
};

// Walks the elements of a file in the little-endian transfer syntaxes (DICOM PS3.5, section 7).
class DicomWalker {
 public:
  explicit DicomWalker(const std::string& path)
      : path_(path), file_(path, std::ios::binary), size_(require_file(path)) {}

  [[nodiscard]] bool at_end() const { return at_ >= size_; }
  void set_implicit() { implicit_ = true; }

  Element next() {
    const HeaderBytes start = bytes(at_, 8);
    Element e;
    e.tag = std::uint32_t(start.get<std::uint16_t>(0)) << 16 | start.get<std::uint16_t>(2);
    const bool mark = e.tag == kItem || e.tag == kItemEnd || e.tag == kSequenceEnd;
    const bool bare = mark || (implicit_ && e.tag >> 16 != 2);
    e.length = start.get<std::uint32_t>(4);
    at_ += 8;
    if (!bare) {
      e.kind = {start.get<char>(4), start.get<char>(5)};
      if (is_one_of(e.kind, kLongKinds)) {
        e.length = bytes(at_, 4).get<std::uint32_t>(0);
        at_ += 4;
      } else {
        e.length = start.get<std::uint16_t>(6);
        e.known = is_one_of(e.kind, kShortKinds);
      }
    }
    e.value = at_;
    return e;
  }

  /// Goes behind the element's value. GDCM makes room for what any element's length says, of those within it too.
  void skip(const Element& element, int depth = 0) {
    if (depth > kDeepest)
      throw InvalidInput(fmt::format("{}: DICOM sequences nested more than {} deep", path_, kDeepest));
    if (element.length != kUndefined) {
      if (element.length > size_ - at_)
        throw IoError(
            fmt::format("{}: a DICOM element of {} bytes at {}, the file has {}", path_, element.length, at_, size_));
      const std::uint64_t end = at_ + element.length;
      const bool has_elements = holds_elements(element);
      while (has_elements && at_ + 8 <= end) {
        const Element inner = next();
        if (!inner.known) break;  // somebody's own way of writing it
        skip(inner, depth + 1);
      }
      at_ = std::max(at_, end);
      return;
    }
    // Unknown values of undefined length are implicit inside, whatever is around them.
    const bool outer = implicit_;
    const bool in_fragments = fragments_;
    if (element.kind == "UN") implicit_ = true;
    if (element.kind == "OB" || element.kind == "OW") fragments_ = true;
    for (Element inner = next(); inner.tag != kSequenceEnd && inner.tag != kItemEnd; inner = next())
      skip(inner, depth + 1);
    implicit_ = outer;
    fragments_ = in_fragments;
  }

  /// What is left of the file. To GDCM zeros are elements, and fewer than four bytes nothing.
  void check_rest() {
    while (size_ - at_ >= 4) {
      const std::uint64_t place = at_;
      const Element e = next();
      if (!e.known && (e.tag != 0 || e.length != 0))
        throw InvalidInput(fmt::format("{}: at byte {}, behind the pixel data, is no DICOM element", path_, place));
      skip(e);
    }
  }

  [[nodiscard]] std::string text(const Element& e) {
    std::string value = raw(e, 256);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.pop_back();
    return value;
  }
  [[nodiscard]] std::uint64_t number(const Element& e) {
    return e.length < 2 ? 0 : bytes(e.value, 2).get<std::uint16_t>(0);
  }
  /// Of a sequence, which may be empty with a length and without.
  [[nodiscard]] bool has_items(const Element& e) {
    return e.length == kUndefined ? tag_at(e.value) != kSequenceEnd : e.length != 0;
  }
  [[nodiscard]] std::uint64_t bytes_behind(const Element& e) const { return size_ - std::min(e.value, size_); }
  void go_to(std::uint64_t offset) { at_ = offset; }

 private:
  template <std::size_t n>
  static bool is_one_of(std::string_view kind, const std::array<std::string_view, n>& kinds) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  }
  /// A sequence's items do, and where nothing says what is a sequence, GDCM goes by how it begins.
  [[nodiscard]] bool holds_elements(const Element& e) {
    if (e.tag == kItem || e.kind == "SQ") return !fragments_;
    if (!e.kind.empty() || e.tag == kPixelData || e.length < 8) return false;
    return tag_at(e.value) == kItem;
  }
  std::uint32_t tag_at(std::uint64_t offset) {
    const HeaderBytes start = bytes(offset, 4);
    return std::uint32_t(start.get<std::uint16_t>(0)) << 16 | start.get<std::uint16_t>(2);
  }
  std::string raw(const Element& e, std::uint32_t most) {
    const std::uint64_t count = std::min(e.length, most);
    (void)bytes(e.value, count);
    std::string data(count, '\0');
    file_.seekg(std::streamoff(e.value));
    file_.read(data.data(), std::streamsize(count));
    return data;
  }
  HeaderBytes bytes(std::uint64_t offset, std::uint64_t count) {
    if (offset > size_ || count > size_ - offset)
      throw IoError(fmt::format("{}: the DICOM header ends early, at byte {}", path_, size_));
    std::string data(count, '\0');
    file_.seekg(std::streamoff(offset));
    file_.read(data.data(), std::streamsize(count));
    return {std::move(data), false};
  }

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t at_ = kFirstElement;
  bool implicit_ = false;
  bool fragments_ = false;  ///< in compressed pixels, whose items are no elements
};

}  // namespace isolux::detail
