#include "files.h"
#include "nrrd_header.h"
#include "number_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>
#include <fstream>

namespace isolux::detail {
namespace {

// Offset of the byte behind `lines` more newlines.
std::uint64_t skip_lines(const NrrdHeader& header) {
  std::ifstream file(header.data_file, std::ios::binary);
  file.seekg(std::streamoff(header.data_offset));
  std::uint64_t offset = header.data_offset;
  for (std::uint64_t lines = 0; lines < header.line_skip; ++offset) {
    const int c = file.get();
    if (c == std::ifstream::traits_type::eof())
      throw IoError(
          fmt::format("{}: the data end after {} of {} lines to skip", header.data_file, lines, header.line_skip));
    if (c == '\n') ++lines;
  }
  return offset;
}

/// How many values a file has, and which of them are read.
struct Wanted {
  std::uint64_t all = 0;
  Frames frames;
  [[nodiscard]] std::uint64_t count() const { return all / frames.count; }
};

std::unique_ptr<ByteSource> of_frame(std::unique_ptr<ByteSource> source, const Wanted& wanted, ScalarType type) {
  if (wanted.frames.count == 1) return source;
  return frame_source(std::move(source), wanted.frames, wanted.count(), bytes_per_scalar(type));
}

DecodedValues read_raw(const NrrdHeader& header, std::uint64_t offset, const Wanted& wanted, const ReadOptions& options,
                       const Run& run) {
  const std::uint64_t size = require_file(header.data_file);
  const std::uint64_t needed = wanted.all * bytes_per_scalar(header.layout.type);
  const std::uint64_t skip = header.byte_skip > 0 ? std::uint64_t(header.byte_skip) : 0;
  const std::uint64_t behind = size - std::min(size, offset);
  const std::uint64_t found = behind - std::min(behind, skip);
  // A foreign file whose header is skipped may have more behind its data; else the sizes must be right.
  const bool foreign = header.byte_skip != 0 || header.line_skip != 0;
  if (found < needed || (found > needed && !foreign))
    throw IoError(fmt::format("{}: {} bytes of data expected, {} found", header.data_file, needed, found));
  const std::uint64_t begin = header.byte_skip < 0 ? size - needed : offset + skip;
  const auto source = of_frame(file_source(header.data_file, begin), wanted, header.layout.type);
  return decode_scalars(*source, header.layout, wanted.count(), options, header.data_file, run);
}

DecodedValues read_gzip(const NrrdHeader& header, std::uint64_t offset, const Wanted& wanted,
                        const ReadOptions& options, const Run& run) {
  const std::uint64_t size = require_file(header.data_file);
  const std::uint64_t needed = wanted.all * bytes_per_scalar(header.layout.type);
  if (needed / kLargestInflation > size)
    throw IoError(fmt::format("{}: {} bytes of data expected, more than {} compressed bytes can hold", header.data_file,
                              needed, size));
  auto source = gzip_source(header.data_file, offset);
  skip_bytes(*source, std::uint64_t(header.byte_skip), header.data_file);
  source = of_frame(std::move(source), wanted, header.layout.type);
  auto values = decode_scalars(*source, header.layout, wanted.count(), options, header.data_file, run);
  std::byte more{};
  if (source->read(std::span(&more, 1)) != 0)
    throw IoError(fmt::format("{}: {} bytes of data expected, more found", header.data_file, needed));
  return values;
}

DecodedValues read_text(const NrrdHeader& header, std::uint64_t offset, const Wanted& wanted,
                        const ReadOptions& options, const Run& run) {
  const std::uint64_t size = require_file(header.data_file);
  if (wanted.all > size)
    throw IoError(fmt::format("{}: {} numbers expected in {} bytes", header.data_file, wanted.all, size));
  NumberText text(header.data_file, offset + std::uint64_t(header.byte_skip), " \n\r\t,\f\v");
  AsWanted as_wanted(options, header.layout.type == ScalarType::kFloat32);
  std::vector<float> values;
  values.reserve(wanted.count());
  bool rounded = false;
  std::uint64_t found = 0;
  for (; !text.next().empty(); ++found) {
    const double number = text.number();
    if (found == wanted.all)
      throw IoError(fmt::format("{}: {} numbers expected, more found", header.data_file, wanted.all));
    if (found % 65536 == 0) throw_if_stopped(run);
    if (!wanted.frames.has(found)) continue;
    const double value = as_wanted(number);
    values.push_back(float(value));
    rounded |= double(values.back()) != value && !std::isnan(value);
  }
  if (found < wanted.all)
    throw IoError(fmt::format("{}: {} numbers expected, {} found", header.data_file, wanted.all, found));
  return {std::move(values), rounded, as_wanted.found_nodata()};
}

}  // namespace

DecodedValues read_nrrd_values(const NrrdHeader& header, const Frames& frames, const ReadOptions& options,
                               const Run& run) {
  std::vector<std::int64_t> sizes;
  for (const auto& axis : header.axes) sizes.push_back(axis.size);
  const Wanted wanted{checked_count(header.path, sizes, bytes_per_scalar(header.layout.type)), frames};
  const std::uint64_t offset = skip_lines(header);
  switch (header.encoding) {
    case NrrdEncoding::kRaw:
      return read_raw(header, offset, wanted, options, run);
    case NrrdEncoding::kGzip:
      return read_gzip(header, offset, wanted, options, run);
    case NrrdEncoding::kText:
      return read_text(header, offset, wanted, options, run);
  }
  throw InvalidInput(fmt::format("{}: unknown encoding", header.path));
}

}  // namespace isolux::detail
