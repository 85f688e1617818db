#include "files.h"
#include "format_checks.h"
#include "header_bytes.h"
#include "tiff_description.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <set>

namespace isolux::detail {
namespace {

constexpr std::uint64_t kMostEntries = 4096;
constexpr int kMostPages = 100000;
// LZW repeats up to some 3000 bytes a code of 12 bits; deflate stays below.
constexpr std::uint64_t kLargestRatio = 4096;
constexpr std::uint64_t kLongestDescription = 1 << 24;

enum Tag : int {
  kSubfileType = 254,
  kOldSubfileType = 255,
  kWidth = 256,
  kHeight = 257,
  kBits = 258,
  kCompression = 259,
  kPhotometric = 262,
  kDescription = 270,
  kStripOffsets = 273,
  kOrientation = 274,
  kSamples = 277,
  kStripBytes = 279,
  kTileWidth = 322,
  kTileOffsets = 324,
  kSampleFormat = 339
};

// TIFF 6.0 and BigTIFF, read as far as is needed to know where its data lie.
class TiffWalker {
 public:
  explicit TiffWalker(const std::string& path)
      : path_(path), file_(path, std::ios::binary), size_(require_file(path)), values_left_(size_) {
    const std::string magic = first_bytes(path, 16);
    big_endian_ = magic.starts_with("MM");
    const HeaderBytes header(magic + std::string(16 - magic.size(), '\0'), big_endian_);
    big_ = header.get<std::uint16_t>(2) == 43;
    next_ = big_ ? header.get<std::uint64_t>(8) : header.get<std::uint32_t>(4);
  }

  [[nodiscard]] bool at_end() const { return next_ == 0; }
  [[nodiscard]] std::uint64_t file_bytes() const { return size_; }
  /// The first page's ImageDescription.
  [[nodiscard]] const std::string& description() const { return description_; }

  /// The next page's tags: each with all its numbers.
  std::map<int, std::vector<std::uint64_t>> page() {
    if (!visited_.insert(next_).second)
      throw InvalidInput(fmt::format("{}: the TIFF's pages go round in a circle", path_));
    const std::uint64_t begin = next_;
    const std::size_t count_bytes = big_ ? 8 : 2;
    const HeaderBytes start = bytes(begin, count_bytes);
    const std::uint64_t count = big_ ? start.get<std::uint64_t>(0) : start.get<std::uint16_t>(0);
    if (count > kMostEntries) throw InvalidInput(fmt::format("{}: a TIFF page of {} entries", path_, count));
    const std::size_t entry_bytes = big_ ? 20 : 12;
    const HeaderBytes entries = bytes(begin + count_bytes, std::size_t(count) * entry_bytes + (big_ ? 8 : 4));
    std::map<int, std::vector<std::uint64_t>> tags;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::size_t at = std::size_t(i) * entry_bytes;
      const int tag = entries.get<std::uint16_t>(at);
      if (wanted(tag)) tags[tag] = values(entries, at);
      if (tag == kDescription && visited_.size() == 1) description_ = text(entries, at);
    }
    const std::size_t end = std::size_t(count) * entry_bytes;
    next_ = big_ ? entries.get<std::uint64_t>(end) : entries.get<std::uint32_t>(end);
    return tags;
  }

 private:
  static bool wanted(int tag) {
    static constexpr std::array kWanted = {kSubfileType, kOldSubfileType, kWidth,        kHeight,      kBits,
                                           kCompression, kPhotometric,    kStripOffsets, kOrientation, kSamples,
                                           kStripBytes,  kTileWidth,      kTileOffsets,  kSampleFormat};
    return std::find(kWanted.begin(), kWanted.end(), tag) != kWanted.end();
  }
  HeaderBytes bytes(std::uint64_t offset, std::uint64_t count) {
    if (offset > size_ || count > size_ - offset)
      throw IoError(fmt::format("{}: {} bytes expected at {}, the file has {}", path_, count, offset, size_));
    std::string data(count, '\0');
    file_.seekg(std::streamoff(offset));
    file_.read(data.data(), std::streamsize(count));
    return {std::move(data), big_endian_};
  }
  [[nodiscard]] std::uint64_t count_of(const HeaderBytes& entries, std::size_t at) const {
    return big_ ? entries.get<std::uint64_t>(at + 4) : entries.get<std::uint32_t>(at + 4);
  }
  /// Where an entry's values are that do not fit in it.
  [[nodiscard]] std::uint64_t offset_of(const HeaderBytes& entries, std::size_t at) const {
    return big_ ? entries.get<std::uint64_t>(at + 12) : entries.get<std::uint32_t>(at + 8);
  }
  // Of a description too short to stand elsewhere nothing.
  std::string text(const HeaderBytes& entries, std::size_t at) {
    const std::uint64_t count = std::min(count_of(entries, at), kLongestDescription);
    if (count <= (big_ ? 8 : 4)) return {};
    const HeaderBytes data = bytes(offset_of(entries, at), count);
    std::string letters;
    for (std::size_t i = 0; i < count && data.get<char>(i) != '\0'; ++i) letters += data.get<char>(i);
    return letters;
  }
  // The numbers of one entry, which stand in it if they fit and elsewhere if not.
  std::vector<std::uint64_t> values(const HeaderBytes& entries, std::size_t at) {
    static const std::map<int, std::size_t> widths = {{1, 1}, {3, 2}, {4, 4}, {16, 8}};
    const auto width = widths.find(entries.get<std::uint16_t>(at + 2));
    if (width == widths.end()) throw InvalidInput(fmt::format("{}: a TIFF tag of a type that it cannot have", path_));
    const std::uint64_t count = count_of(entries, at);
    const std::size_t field = at + (big_ ? 12 : 8);
    // All tags together cannot have more values than the file has bytes, unless they share them to waste our time.
    if (count > values_left_)
      throw IoError(fmt::format("{}: TIFF tags of more values than the file's {} bytes", path_, size_));
    values_left_ -= count;
    const std::uint64_t needed = count * width->second;
    const bool inside = needed <= (big_ ? 8 : 4);
    const HeaderBytes data = inside ? entries : bytes(offset_of(entries, at), needed);
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::size_t place = (inside ? field : 0) + std::size_t(i) * width->second;
      switch (width->second) {
        case 1:
          numbers.push_back(data.get<std::uint8_t>(place));
          break;
        case 2:
          numbers.push_back(data.get<std::uint16_t>(place));
          break;
        case 4:
          numbers.push_back(data.get<std::uint32_t>(place));
          break;
        default:
          numbers.push_back(data.get<std::uint64_t>(place));
          break;
      }
    }
    return numbers;
  }

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t values_left_;
  bool big_endian_ = false;
  bool big_ = false;
  std::uint64_t next_ = 0;
  std::set<std::uint64_t> visited_;
  std::string description_;
};

using Tags = std::map<int, std::vector<std::uint64_t>>;

std::uint64_t one(const Tags& tags, int tag, std::uint64_t otherwise) {
  const auto it = tags.find(tag);
  return it == tags.end() || it->second.empty() ? otherwise : it->second.front();
}

void check_data(const std::string& path, const Tags& tags, std::uint64_t needed, std::uint64_t file_bytes) {
  const auto offsets = tags.find(kStripOffsets);
  const auto counts = tags.find(kStripBytes);
  if (offsets == tags.end() || counts == tags.end() || offsets->second.size() != counts->second.size())
    throw InvalidInput(fmt::format("{}: a TIFF page does not say where its data are", path));
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < offsets->second.size(); ++i) {
    const std::uint64_t offset = offsets->second[i];
    const std::uint64_t bytes = counts->second[i];
    if (offset > file_bytes || bytes > file_bytes - offset)
      throw IoError(
          fmt::format("{}: {} bytes of data expected at {}, the file has {}", path, bytes, offset, file_bytes));
    found += bytes;
  }
  const bool compressed = one(tags, kCompression, 1) != 1;
  if (compressed ? found < needed / kLargestRatio : found < needed)
    throw IoError(fmt::format("{}: a page of {} bytes expected, {} found", path, needed, found));
}

// ITK reads other pixels as zeros, as bit patterns of another type, or as colours.
ScalarType pixel_type(const std::string& path, const Tags& tags) {
  const std::uint64_t bits = one(tags, kBits, 1);
  const std::uint64_t format = one(tags, kSampleFormat, 1);
  const bool is_signed = format == 2;
  const bool is_integer = is_signed || format == 1 || format == 4;  // 4: undefined, as many writers have it
  if (bits == 8 && is_integer) return is_signed ? ScalarType::kInt8 : ScalarType::kUint8;
  if (bits == 16 && is_integer) return is_signed ? ScalarType::kInt16 : ScalarType::kUint16;
  if (bits == 32 && format == 3) return ScalarType::kFloat32;
  throw InvalidInput(
      fmt::format("{}: TIFF pixels of {} bits, SampleFormat {}: supported are whole numbers of 8 and 16 "
                  "bits (SampleFormat 1 and 2) and floats of 32 (3)",
                  path, bits, format));
}

// What kind of page it is, as NewSubfileType has it, and as libtiff takes it from the older tag too; nothing if the
// page does not say.
std::optional<std::uint64_t> page_kind(const Tags& tags) {
  constexpr std::uint64_t kOldReduced = 2;
  constexpr std::uint64_t kOldPage = 3;
  const std::uint64_t old = one(tags, kOldSubfileType, 0);
  if (old == kOldReduced) return 1;
  if (old == kOldPage) return 2;
  const auto it = tags.find(kSubfileType);
  return it == tags.end() || it->second.empty() ? std::nullopt : std::optional(it->second.front());
}

void check_layout(const std::string& path, const Tags& tags) {
  if (!tags.contains(kPhotometric))
    throw InvalidInput(fmt::format("{}: a TIFF page without PhotometricInterpretation: 0 or 1 (grey) is needed", path));
  if (one(tags, kSamples, 1) != 1 || one(tags, kPhotometric, 1) > 1)
    throw InvalidInput(
        fmt::format("{}: {} samples a pixel, PhotometricInterpretation {}: supported are grey TIFF pages "
                    "(1; 0 and 1)",
                    path, one(tags, kSamples, 1), one(tags, kPhotometric, 1)));
  if (tags.contains(kTileWidth) || tags.contains(kTileOffsets))
    throw InvalidInput(fmt::format("{}: a TIFF page in tiles: supported are strips", path));
  if (const auto orientation = one(tags, kOrientation, 1); orientation != 1 && orientation != 4)
    throw InvalidInput(
        fmt::format("{}: TIFF Orientation {}: supported are 1 and 4, rows from the left", path, orientation));
  if ((page_kind(tags).value_or(0) & 5u) != 0)
    throw InvalidInput(fmt::format(
        "{}: a TIFF page that is a smaller copy of another, or a mask (NewSubfileType): not supported", path));
}

// ITK counts the pages whose kind is 0, or all pages if there are none such, and turns all as the first page says.
void check_same(const std::string& path, int page, const Tags& tags, const Tags& first) {
  const auto orientation = one(tags, kOrientation, 1);
  if (orientation != one(first, kOrientation, 1))
    throw InvalidInput(fmt::format("{}: page {} has the Orientation {}, the first {}: pages of one are supported", path,
                                   page, orientation, one(first, kOrientation, 1)));
  const auto kind = page_kind(tags);
  const auto first_kind = page_kind(first);
  const auto word = [](const auto& of) { return of ? fmt::format("{}", *of) : "none"; };
  if ((kind == 0) != (first_kind == 0))
    throw InvalidInput(
        fmt::format("{}: page {} has the NewSubfileType {}, the first {}: where a page has 0, all have to", path, page,
                    word(kind), word(first_kind)));
}

}  // namespace

bool is_tiff(const std::string& path) {
  const std::string magic = first_bytes(path, 4);
  return magic == std::string("II*\0", 4) || magic == std::string("MM\0*", 4) || magic == std::string("II+\0", 4) ||
         magic == std::string("MM\0+", 4);
}

CheckedHeader check_tiff(const std::string& path) {
  TiffWalker walker(path);
  CheckedHeader checked;
  Tags first;
  for (int pages = 0; !walker.at_end(); ++pages) {
    if (pages == kMostPages) throw InvalidInput(fmt::format("{}: more than {} TIFF pages", path, kMostPages));
    const Tags tags = walker.page();
    if (pages == 0) first = tags;
    const std::array<std::int64_t, 2> size = {std::int64_t(one(tags, kWidth, 0)), std::int64_t(one(tags, kHeight, 0))};
    check_layout(path, tags);
    const ScalarType type = pixel_type(path, tags);
    const std::size_t width = bytes_per_scalar(type);
    check_data(path, tags, checked_count(path, size, width) * width, walker.file_bytes());
    const Index3 page{int(size[0]), int(size[1]), pages + 1};
    if (pages > 0 && (page.x != checked.size.x || page.y != checked.size.y || type != checked.type))
      throw InvalidInput(fmt::format("{}: page {} is {}x{} {}, the first {}x{} {}", path, pages, page.x, page.y,
                                     scalar_type_name(type), checked.size.x, checked.size.y,
                                     scalar_type_name(*checked.type)));
    check_same(path, pages, tags, first);
    checked.size = page;
    checked.type = type;
  }
  if (checked.size.z == 0) throw InvalidInput(fmt::format("{}: a TIFF without a page", path));
  checked.remark = check_description(path, walker.description(), std::uint64_t(checked.size.z));
  return checked;
}

}  // namespace isolux::detail
