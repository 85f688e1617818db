#include "byte_source.h"

#include "files.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace isolux::detail {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;

class FileSource final : public ByteSource {
 public:
  FileSource(const std::string& path, std::uint64_t offset) : path_(path), file_(path, std::ios::binary) {
    if (!file_) throw IoError(fmt::format("{}: cannot be opened for reading", path));
    file_.seekg(std::streamoff(offset));
  }
  std::size_t read(std::span<std::byte> into) override {
    file_.read(reinterpret_cast<char*>(into.data()), std::streamsize(into.size()));
    if (file_.bad()) throw IoError(fmt::format("{}: reading failed", path_));
    return std::size_t(file_.gcount());
  }

 private:
  std::string path_;
  std::ifstream file_;
};

class GzipSource final : public ByteSource {
 public:
  GzipSource(const std::string& path, std::uint64_t offset) : path_(path), file_(path, offset), input_(kBufferBytes) {
    // 15 bits of window; +32 accepts both the gzip and the zlib header.
    if (inflateInit2(&stream_, 15 + 32) != Z_OK) throw IoError(fmt::format("{}: zlib could not start", path));
  }
  GzipSource(const GzipSource&) = delete;
  GzipSource& operator=(const GzipSource&) = delete;
  ~GzipSource() override { inflateEnd(&stream_); }

  std::size_t read(std::span<std::byte> into) override {
    std::size_t done = 0;
    while (done < into.size() && !ended_) {
      if (stream_.avail_in == 0 && !refill()) {
        // What has been inflated goes out first; the caller knows how much it needs.
        if (done > 0) break;
        throw IoError(fmt::format("{}: the compressed data end early", path_));
      }
      const std::size_t room = std::min<std::size_t>(into.size() - done, std::numeric_limits<uInt>::max());
      stream_.next_out = reinterpret_cast<Bytef*>(into.data() + done);
      stream_.avail_out = uInt(room);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      done += room - stream_.avail_out;
      if (status == Z_STREAM_END) {
        next_member();
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        throw IoError(fmt::format("{}: the compressed data are damaged: {}", path_,
                                  stream_.msg == nullptr ? "zlib refuses them" : stream_.msg));
      }
    }
    return done;
  }

 private:
  bool refill() {
    const std::size_t got = file_.read(std::as_writable_bytes(std::span(input_)));
    stream_.next_in = input_.data();
    stream_.avail_in = uInt(got);
    return got > 0;
  }
  // A gzip file may be several members one after another, and zeros that pad it to whole blocks.
  void next_member() {
    const bool more = stream_.avail_in > 0 || refill();
    if (more && *stream_.next_in == 0x1F) {
      inflateReset(&stream_);
      return;
    }
    ended_ = true;
    while (stream_.avail_in > 0 || refill()) {
      if (std::any_of(stream_.next_in, stream_.next_in + stream_.avail_in, [](Bytef byte) { return byte != 0; }))
        throw IoError(fmt::format("{}: there is more behind the compressed data", path_));
      stream_.avail_in = 0;
    }
  }

  std::string path_;
  FileSource file_;
  std::vector<Bytef> input_;
  z_stream stream_{};
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<ByteSource> file_source(const std::string& path, std::uint64_t offset) {
  return std::make_unique<FileSource>(path, offset);
}

std::unique_ptr<ByteSource> gzip_source(const std::string& path, std::uint64_t offset) {
  return std::make_unique<GzipSource>(path, offset);
}

bool is_gzip(const std::string& path) { return first_bytes(path, 2) == "\x1F\x8B"; }

std::string first_inflated(const std::string& path, std::size_t count) {
  if (!is_gzip(path)) return first_bytes(path, count);
  std::string bytes(count, '\0');
  bytes.resize(gzip_source(path, 0)->read(std::as_writable_bytes(std::span(bytes))));
  return bytes;
}

void skip_bytes(ByteSource& source, std::uint64_t count, const std::string& path) {
  std::array<std::byte, 4096> buffer{};
  for (std::uint64_t left = count; left > 0;) {
    const std::size_t got = source.read(std::span(buffer).first(std::min<std::uint64_t>(left, buffer.size())));
    if (got == 0)
      throw IoError(fmt::format("{}: the data end after {} of {} bytes to skip", path, count - left, count));
    left -= got;
  }
}

}  // namespace isolux::detail
