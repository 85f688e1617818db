#include "files.h"
#include "format_checks.h"
#include "header_bytes.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>

namespace isolux::detail {
namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFFu;
constexpr std::uint32_t kItem = 0xFFFEE000u;
constexpr std::uint32_t kItemEnd = 0xFFFEE00Du;
constexpr std::uint32_t kSequenceEnd = 0xFFFEE0DDu;
constexpr std::uint32_t kPixelData = 0x7FE00010u;
constexpr int kDeepest = 16;

struct Element {
  std::uint32_t tag = 0;
  std::uint32_t length = 0;
  std::string kind;         ///< value representation; empty where implicit
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
      static constexpr std::array<std::string_view, 13> kLong = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                                 "SV", "UC", "UN", "UR", "UT", "UV"};
      if (std::find(kLong.begin(), kLong.end(), e.kind) != kLong.end()) {
        e.length = bytes(at_, 4).get<std::uint32_t>(0);
        at_ += 4;
      } else {
        e.length = start.get<std::uint16_t>(6);
      }
    }
    e.value = at_;
    return e;
  }

  /// Goes behind the element's value.
  void skip(const Element& element, int depth = 0) {
    if (element.length != kUndefined) {
      if (element.length > size_ - at_)
        throw IoError(
            fmt::format("{}: a DICOM element of {} bytes at {}, the file has {}", path_, element.length, at_, size_));
      at_ += element.length;
      return;
    }
    if (depth > kDeepest)
      throw InvalidInput(fmt::format("{}: DICOM sequences nested more than {} deep", path_, kDeepest));
    // Unknown values of undefined length are implicit inside, whatever is around them.
    const bool outer = implicit_;
    if (element.kind == "UN") implicit_ = true;
    for (Element inner = next(); inner.tag != kSequenceEnd && inner.tag != kItemEnd; inner = next())
      skip(inner, depth + 1);
    implicit_ = outer;
  }

  [[nodiscard]] std::string text(const Element& e) {
    std::string value = raw(e, 128);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.pop_back();
    return value;
  }
  [[nodiscard]] std::uint64_t number(const Element& e) {
    return e.length < 2 ? 0 : bytes(e.value, 2).get<std::uint16_t>(0);
  }
  [[nodiscard]] std::uint64_t bytes_behind(const Element& e) const { return size_ - std::min(e.value, size_); }
  void go_to(std::uint64_t offset) { at_ = offset; }

 private:
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
  std::uint64_t at_ = 132;
  bool implicit_ = false;
};

}  // namespace

bool is_dicom(const std::string& path) {
  const std::string bytes = first_bytes(path, 132);
  // A DICOMDIR is a table of contents, not an image.
  return bytes.size() == 132 && bytes.compare(128, 4, "DICM") == 0 &&
         std::filesystem::path(path).filename() != "DICOMDIR";
}

CheckedHeader check_dicom(const std::string& path) {
  DicomWalker walker(path);
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
  std::uint64_t bits = 0;
  std::uint64_t samples = 1;
  bool compressed = false;
  while (!walker.at_end()) {
    const Element e = walker.next();
    if (e.tag == 0x00020010u) {
      const std::string syntax = walker.text(e);
      if (syntax == "1.2.840.10008.1.2.2" || syntax == "1.2.840.10008.1.2.1.99")
        throw InvalidInput(
            fmt::format("{}: DICOM transfer syntax {} (big endian or deflated) is not supported", path, syntax));
      compressed = syntax != "1.2.840.10008.1.2" && syntax != "1.2.840.10008.1.2.1";
      if (syntax == "1.2.840.10008.1.2") walker.set_implicit();
    }
    if (e.tag == 0x00280002u) samples = walker.number(e);
    if (e.tag == 0x00280010u) rows = walker.number(e);
    if (e.tag == 0x00280011u) columns = walker.number(e);
    if (e.tag == 0x00280100u) bits = walker.number(e);
    if (e.tag == 0x00280008u && walker.text(e) != "1" && !walker.text(e).empty())
      throw InvalidInput(fmt::format("{}: DICOM of {} frames: supported is one a file", path, walker.text(e)));
    if (e.tag == kPixelData) {
      if (samples != 1) throw InvalidInput(fmt::format("{}: {} samples a pixel: a volume has one", path, samples));
      const std::array<std::int64_t, 2> size = {std::int64_t(columns), std::int64_t(rows)};
      const std::uint64_t needed = checked_count(path, size, 8) * (bits / 8);
      const std::uint64_t found = std::min<std::uint64_t>(e.length, walker.bytes_behind(e));
      if (bits % 8 != 0 || bits == 0 || bits > 32)
        throw InvalidInput(fmt::format("{}: {} bits a pixel: supported are 8, 16 and 32", path, bits));
      if (!compressed && found < needed)
        throw IoError(fmt::format("{}: {} bytes of pixel data expected, {} found", path, needed, found));
      // GDCM makes room for what the length says, and looks for it for long.
      if (!compressed && e.length > walker.bytes_behind(e))
        throw IoError(
            fmt::format("{}: pixel data of {} bytes, the file has {} behind their head", path, e.length, found));
      if (compressed) walker.skip(e);
      return {.size = {int(columns), int(rows), 1}, .type = {}, .data = {}};
    }
    walker.go_to(e.value);
    walker.skip(e);
  }
  throw InvalidInput(fmt::format("{}: a DICOM file without pixel data", path));
}

}  // namespace isolux::detail
