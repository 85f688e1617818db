#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <span>
#include <string>

namespace isolux::detail {

/// Bytes one after another, from a file or out of a decompressor.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Fills `into` and returns how many bytes it got: fewer only at the end. \throw IoError naming the file.
  virtual std::size_t read(std::span<std::byte> into) = 0;
};

/// The bytes of a file from `offset` on. \throw IoError
[[nodiscard]] std::unique_ptr<ByteSource> file_source(const std::string& path, std::uint64_t offset);

/// What the gzip or zlib stream at `offset` inflates to, all members of it; zeros after the last member are ignored as
/// gzip does. \throw IoError, also from read() for damaged data and for anything else behind them.
[[nodiscard]] std::unique_ptr<ByteSource> gzip_source(const std::string& path, std::uint64_t offset);

/// Whether a file begins as gzip does. Never throws.
[[nodiscard]] bool is_gzip(const std::string& path);

/// Up to `count` bytes from the start of a file, of a gzip file those that it inflates to. \throw IoError for damaged
/// gzip
[[nodiscard]] std::string first_inflated(const std::string& path, std::size_t count);

/// Reads and drops bytes. \throw IoError naming `path` if there are fewer.
void skip_bytes(ByteSource& source, std::uint64_t count, const std::string& path);

/// No deflate stream inflates by more: lets an absurd size be refused before memory is asked for.
inline constexpr std::uint64_t kLargestInflation = 1032;

}  // namespace isolux::detail
