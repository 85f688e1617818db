#include "vtk_xml_array.h"

#include "files.h"
#include "plain_text.h"
#include "text_values.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace isolux::detail {
namespace {

constexpr std::size_t kCodedPiece = 1 << 16;
// Where XML goes on behind an array's text.
constexpr char kTagBegin = '<';

/// What base64 text stands for, up to the next tag or the file's end. Blanks are skipped. Groups that are filled up
/// with
/// '=' may have others behind them: VTK codes a header apart from its blocks.
class Base64Source final : public ByteSource {
 public:
  explicit Base64Source(const VtkXmlArray& array)
      : path_(array.file), file_(file_source(array.file, array.offset)), text_(kCodedPiece, '\0') {}

  std::size_t read(std::span<std::byte> into) override {
    std::size_t done = 0;
    for (; done < into.size(); ++done) {
      if (left_ == 0 && !next_group()) break;
      into[done] = std::byte((bits_ >> 16) & 0xFF);
      bits_ <<= 8;
      --left_;
    }
    return done;
  }

 private:
  [[noreturn]] void refuse(char letter) const {
    throw IoError(fmt::format("{}: '{}' in base64 data", path_, excerpt(std::string_view(&letter, 1))));
  }
  bool next_group() {
    bits_ = 0;
    left_ = 3;
    for (int letters = 0; letters < 4; ++letters) {
      const auto letter = next_letter();
      if (!letter && letters == 0) left_ = 0;
      if (!letter && letters > 0) throw IoError(fmt::format("{}: base64 data end within a group of letters", path_));
      if (!letter) return false;
      const bool fills = *letter == '=';
      if ((fills && letters < 2) || (!fills && left_ < 3)) refuse(*letter);
      if (fills) --left_;
      bits_ = (bits_ << 6) | (fills ? 0 : value_of(*letter));
    }
    return true;
  }
  [[nodiscard]] std::uint32_t value_of(char letter) const {
    if (letter >= 'A' && letter <= 'Z') return std::uint32_t(letter - 'A');
    if (letter >= 'a' && letter <= 'z') return std::uint32_t(letter - 'a') + 26;
    if (letter >= '0' && letter <= '9') return std::uint32_t(letter - '0') + 52;
    if (letter != '+' && letter != '/') refuse(letter);
    return letter == '+' ? 62 : 63;
  }
  std::optional<char> next_letter() {
    for (;;) {
      if (at_ == size_) {
        size_ = file_->read(std::as_writable_bytes(std::span(text_)));
        at_ = 0;
      }
      if (size_ == 0 || text_[at_] == kTagBegin) return std::nullopt;
      const char letter = text_[at_++];
      if (kTextBlanks.find(letter) == std::string_view::npos) return letter;
    }
  }

  std::string path_;
  std::unique_ptr<ByteSource> file_;
  std::string text_;
  std::size_t at_ = 0;
  std::size_t size_ = 0;
  std::uint32_t bits_ = 0;
  int left_ = 0;
};

struct BlockSizes {
  std::vector<std::uint64_t> compressed;
  std::uint64_t full = 0;
  std::uint64_t last = 0;
};

/// Blocks of zlib one after another. \throw IoError if one is damaged, or if its size is not what it should be
class ZlibBlocks final : public ByteSource {
 public:
  ZlibBlocks(ByteSource& coded, BlockSizes sizes, const std::string& path)
      : path_(path), coded_(coded), sizes_(std::move(sizes)), input_(kCodedPiece) {
    if (inflateInit(&stream_) != Z_OK) throw IoError(fmt::format("{}: zlib could not start", path));
    begin_block();
  }
  ZlibBlocks(const ZlibBlocks&) = delete;
  ZlibBlocks& operator=(const ZlibBlocks&) = delete;
  ~ZlibBlocks() override { inflateEnd(&stream_); }

  std::size_t read(std::span<std::byte> into) override {
    std::size_t done = 0;
    while (done < into.size() && block_ < sizes_.compressed.size()) done += inflate_some(into.subspan(done));
    return done;
  }

 private:
  void begin_block() {
    in_left_ = sizes_.compressed[block_];
    out_left_ = block_ + 1 == sizes_.compressed.size() ? sizes_.last : sizes_.full;
  }
  std::size_t inflate_some(std::span<std::byte> into) {
    if (stream_.avail_in == 0) {
      const std::size_t wanted = std::min<std::uint64_t>(in_left_, input_.size());
      stream_.next_in = input_.data();
      stream_.avail_in = uInt(coded_.read(std::as_writable_bytes(std::span(input_).first(wanted))));
      in_left_ -= stream_.avail_in;
    }
    const std::size_t room =
        std::min<std::uint64_t>({into.size(), out_left_, std::uint64_t(std::numeric_limits<uInt>::max())});
    stream_.next_out = reinterpret_cast<Bytef*>(into.data());
    stream_.avail_out = uInt(room);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    const std::size_t made = room - stream_.avail_out;
    out_left_ -= made;
    if (status != Z_OK && status != Z_STREAM_END)
      throw IoError(fmt::format("{}: block {} of the compressed data is damaged: {}", path_, block_,
                                stream_.msg != nullptr ? stream_.msg : "it has another size than its header says"));
    if (status == Z_STREAM_END) end_block();
    return made;
  }
  void end_block() {
    if (out_left_ > 0 || in_left_ > 0 || stream_.avail_in > 0)
      throw IoError(
          fmt::format("{}: block {} of the compressed data ends before the sizes that its header says", path_, block_));
    inflateReset(&stream_);
    if (++block_ < sizes_.compressed.size()) begin_block();
  }

  std::string path_;
  ByteSource& coded_;
  BlockSizes sizes_;
  std::vector<Bytef> input_;
  z_stream stream_{};
  std::size_t block_ = 0;
  std::uint64_t in_left_ = 0;   ///< bytes of the block that are still to be read
  std::uint64_t out_left_ = 0;  ///< bytes that it has still to become
};

std::uint64_t header_number(ByteSource& source, const VtkXmlArray& array) {
  std::array<std::byte, 8> raw{};
  const std::span<std::byte> bytes = std::span(raw).first(array.wide_header ? 8 : 4);
  if (source.read(bytes) < bytes.size())
    throw IoError(fmt::format("{}: the data end within the header before them", array.file));
  if (!array.layout.big_endian) std::reverse(bytes.begin(), bytes.end());
  std::uint64_t number = 0;
  for (const std::byte byte : bytes) number = (number << 8) | std::uint64_t(byte);
  return number;
}

BlockSizes read_block_sizes(ByteSource& source, const VtkXmlArray& array, std::uint64_t needed) {
  const std::uint64_t blocks = header_number(source, array);
  BlockSizes sizes;
  sizes.full = header_number(source, array);
  const std::uint64_t smaller = header_number(source, array);
  sizes.last = smaller > 0 ? smaller : sizes.full;
  // The second keeps the third from overflowing.
  if (blocks == 0 || sizes.full == 0 || sizes.last > sizes.full || blocks - 1 > needed / sizes.full ||
      (blocks - 1) * sizes.full + sizes.last != needed)
    throw IoError(fmt::format("{}: {} bytes of data expected, their header says {} blocks of {} bytes, the last of {}",
                              array.file, needed, blocks, sizes.full, sizes.last));
  // One by one: memory follows what was read.
  for (std::uint64_t i = 0; i < blocks; ++i) sizes.compressed.push_back(header_number(source, array));
  return sizes;
}

DecodedValues read_text(const VtkXmlArray& array, std::uint64_t count, const ReadOptions& options, const Run& run) {
  NumberText text(array.file, array.offset, kTextBlanks, kTagBegin);
  auto values = read_text_values(text, array.layout.type, count, options, array.file, run);
  if (!text.next().empty())
    throw IoError(fmt::format("{}: {} numbers of data expected, more found", array.file, count));
  return values;
}

}  // namespace

std::optional<ScalarType> vtk_xml_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, ScalarType>, 10> kTypes{{{"Int8", ScalarType::kInt8},
                                                                            {"UInt8", ScalarType::kUint8},
                                                                            {"Int16", ScalarType::kInt16},
                                                                            {"UInt16", ScalarType::kUint16},
                                                                            {"Int32", ScalarType::kInt32},
                                                                            {"UInt32", ScalarType::kUint32},
                                                                            {"Int64", ScalarType::kInt64},
                                                                            {"UInt64", ScalarType::kUint64},
                                                                            {"Float32", ScalarType::kFloat32},
                                                                            {"Float64", ScalarType::kFloat64}}};
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == name; });
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

void require_room(const VtkXmlArray& array, std::uint64_t count) {
  const std::uint64_t size = require_file(array.file);
  const std::size_t width = bytes_per_scalar(array.layout.type);
  // A digit is the shortest text of a number.
  const std::uint64_t most = size * (array.format == VtkXmlFormat::kText ? width
                                     : array.compressed                  ? kLargestInflation
                                                                         : 1);
  if (count > most / width)
    throw IoError(fmt::format("{}: {} values of {} bytes expected, more than a file of {} bytes can hold", array.file,
                              count, width, size));
}

DecodedValues read_vtk_xml_array(const VtkXmlArray& array, std::uint64_t count, const ReadOptions& options,
                                 const Run& run) {
  require_room(array, count);
  if (array.format == VtkXmlFormat::kText) return read_text(array, count, options, run);
  const std::uint64_t needed = count * bytes_per_scalar(array.layout.type);
  const auto source = array.format == VtkXmlFormat::kRaw ? file_source(array.file, array.offset)
                                                         : std::make_unique<Base64Source>(array);
  DecodedValues values;
  std::byte more{};
  if (array.compressed) {
    ZlibBlocks blocks(*source, read_block_sizes(*source, array, needed), array.file);
    values = decode_scalars(blocks, array.layout, count, options, array.file, run);
    // Asking for more is what makes zlib look at the check sum behind the last byte.
    (void)blocks.read(std::span(&more, 1));
  } else {
    if (const std::uint64_t size = header_number(*source, array); size != needed)
      throw IoError(fmt::format("{}: {} bytes of data expected, their header says {}", array.file, needed, size));
    values = decode_scalars(*source, array.layout, count, options, array.file, run);
  }
  if (array.alone && source->read(std::span(&more, 1)) != 0)
    throw IoError(fmt::format("{}: {} bytes of data expected, more found", array.file, needed));
  return values;
}

}  // namespace isolux::detail
