#include "files.h"
#include "format_checks.h"
#include "header_bytes.h"
#include "number_text.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace isolux::detail {
namespace {

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
    const HeaderBytes start = bytes(e.value, 4);
    return (std::uint32_t(start.get<std::uint16_t>(0)) << 16 | start.get<std::uint16_t>(2)) == kItem;
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

bool has_mark(const std::string& path) {
  const std::string bytes = first_bytes(path, kFirstElement);
  return bytes.size() == kFirstElement && bytes.ends_with("DICM");
}

// What a file says of its one image.
struct DicomImage {
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
  std::uint64_t bits = 0;
  std::uint64_t samples = 1;
  std::string photometric;
  std::optional<std::string> orientation;
  std::optional<std::string> spacing;
  std::string slope = "1";
  bool functional_groups = false;  ///< the enhanced kind, which keeps its frame in there
  bool compressed = false;
};

void take_syntax(const std::string& path, const std::string& syntax, DicomWalker& walker, DicomImage& image) {
  if (syntax == "1.2.840.10008.1.2.2" || syntax == "1.2.840.10008.1.2.1.99")
    throw InvalidInput(
        fmt::format("{}: DICOM transfer syntax {} (big endian or deflated) is not supported", path, syntax));
  image.compressed = syntax != "1.2.840.10008.1.2" && syntax != "1.2.840.10008.1.2.1";
  if (syntax == "1.2.840.10008.1.2") walker.set_implicit();
}

void take(const std::string& path, const Element& e, DicomWalker& walker, DicomImage& image) {
  if (e.tag == 0x00020010u) take_syntax(path, walker.text(e), walker, image);
  if (e.tag == 0x00200037u) image.orientation = walker.text(e);
  if (e.tag == 0x00280002u) image.samples = walker.number(e);
  if (e.tag == 0x00280004u) image.photometric = walker.text(e);
  if (e.tag == 0x00280008u && walker.text(e) != "1" && !walker.text(e).empty())
    throw InvalidInput(fmt::format("{}: DICOM of {} frames: supported is one a file", path, excerpt(walker.text(e))));
  if (e.tag == 0x00280010u) image.rows = walker.number(e);
  if (e.tag == 0x00280011u) image.columns = walker.number(e);
  if (e.tag == 0x00280030u) image.spacing = walker.text(e);
  if (e.tag == 0x00280100u) image.bits = walker.number(e);
  if (e.tag == 0x00281053u) image.slope = walker.text(e);
  if (e.tag == 0x52009229u || e.tag == 0x52009230u) image.functional_groups = true;
}

// Numbers with backslashes between; NaN for what is none.
std::vector<double> decimals(std::string text) {
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::vector<double> numbers;
  for (const auto& word : plain_words(text))
    numbers.push_back(parse_real(word).value_or(std::numeric_limits<double>::quiet_NaN()));
  return numbers;
}

// GDCM takes other numbers for 1.
void check_spacing(const std::string& path, const DicomImage& image) {
  if (!image.spacing && image.functional_groups) return;
  if (!image.spacing)
    throw InvalidInput(
        fmt::format("{}: DICOM without PixelSpacing does not say how far voxels are apart: give --spacing", path));
  const auto spacing = decimals(*image.spacing);
  if (spacing.size() != 2 || !std::all_of(spacing.begin(), spacing.end(), [](double s) { return s > 0.0; }))
    throw InvalidInput(fmt::format("{}: PixelSpacing {}: two numbers above 0 are needed, or --spacing", path,
                                   excerpt(*image.spacing)));
}

// GDCM puts the world's axes in the place of directions that are not at right angles, to this sine.
void check_orientation(const std::string& path, const std::string& text) {
  constexpr double kMostTilt = 1e-3;
  const auto n = decimals(text);
  const bool six = n.size() == 6;
  const Vec3 row = six ? Vec3(n[0], n[1], n[2]) : Vec3(0);
  const Vec3 column = six ? Vec3(n[3], n[4], n[5]) : Vec3(0);
  // False also for directions that are 0 or no numbers.
  if (!(std::fabs(glm::dot(row, column)) < kMostTilt * glm::length(row) * glm::length(column)))
    throw InvalidInput(
        fmt::format("{}: ImageOrientationPatient {}: two directions at right angles are needed", path, excerpt(text)));
}

void check_image(const std::string& path, const DicomImage& image, const ReadOptions& options) {
  if (image.samples != 1)
    throw InvalidInput(fmt::format("{}: {} samples a pixel: a volume has one", path, image.samples));
  if (image.photometric != "MONOCHROME1" && image.photometric != "MONOCHROME2")
    throw InvalidInput(fmt::format("{}: PhotometricInterpretation '{}': supported are MONOCHROME1 and MONOCHROME2",
                                   path, excerpt(image.photometric)));
  if (image.bits % 8 != 0 || image.bits == 0 || image.bits > 32)
    throw InvalidInput(fmt::format("{}: {} bits a pixel: supported are 8, 16 and 32", path, image.bits));
  if (decimals(image.slope) == std::vector<double>{0.0})
    throw InvalidInput(fmt::format("{}: RescaleSlope 0: a number other than 0 is needed", path));
  if (!options.spacing) check_spacing(path, image);
  if (image.orientation) check_orientation(path, *image.orientation);
}

void check_pixels(const std::string& path, const Element& e, const DicomImage& image, DicomWalker& walker) {
  const std::array<std::int64_t, 2> size = {std::int64_t(image.columns), std::int64_t(image.rows)};
  const std::uint64_t needed = checked_count(path, size, 8) * (image.bits / 8);
  if (image.compressed) {
    walker.skip(e);
    return;
  }
  const std::uint64_t found = std::min<std::uint64_t>(e.length, walker.bytes_behind(e));
  if (found < needed) throw IoError(fmt::format("{}: {} bytes of pixel data expected, {} found", path, needed, found));
  // GDCM makes room for what the length says, and looks for it for long.
  if (e.length > walker.bytes_behind(e))
    throw IoError(fmt::format("{}: pixel data of {} bytes, the file has {} behind their head", path, e.length, found));
  walker.skip(e);
}

}  // namespace

bool is_dicom(const std::string& path) {
  // A DICOMDIR is a table of contents, not an image.
  return has_mark(path) && std::filesystem::path(path).filename() != "DICOMDIR";
}

CheckedHeader check_dicom(const std::string& path, const ReadOptions& options) {
  DicomWalker walker(path);
  if (!has_mark(path)) throw InvalidInput(fmt::format("{}: no DICOM file: the mark DICM at byte 128 is missing", path));
  DicomImage image;
  while (!walker.at_end()) {
    const Element e = walker.next();
    // GDCM loses its place there, and takes any bytes behind for lengths.
    if (!e.known && e.tag >> 16 == 2)
      throw InvalidInput(fmt::format("{}: a DICOM file's head with an element of the kind '{}', which there is not",
                                     path, excerpt(e.kind)));
    take(path, e, walker, image);
    if (e.tag == kPixelData) {
      check_image(path, image, options);
      check_pixels(path, e, image, walker);
      walker.check_rest();
      return {.size = {int(image.columns), int(image.rows), 1}, .type = {}, .data = {}};
    }
    walker.go_to(e.value);
    walker.skip(e);
  }
  throw InvalidInput(fmt::format("{}: a DICOM file without pixel data", path));
}

}  // namespace isolux::detail
