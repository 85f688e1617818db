#include "data_place.h"

#include "files.h"
#include "scaled_values.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>

namespace isolux::detail {
namespace {

bool is_scaled(const DataPlace& place) { return place.slope != 1.0 || place.intercept != 0.0; }

}  // namespace

ScalarType voxel_type(const DataPlace& place) {
  return is_scaled(place) && place.layout.type != ScalarType::kFloat64 ? ScalarType::kFloat32 : place.layout.type;
}

void require_room(const DataPlace& place, std::uint64_t count) {
  const std::uint64_t size = require_file(place.file);
  const std::uint64_t needed = count * place.frames.count * bytes_per_scalar(place.layout.type);
  const std::uint64_t found = size - std::min(size, place.offset);
  if (place.compressed) {
    if (needed / kLargestInflation > found)
      throw IoError(fmt::format("{}: {} bytes of data expected, more than {} compressed bytes can hold", place.file,
                                needed, found));
  } else if (found < needed || (found > needed && !place.more_allowed)) {
    throw IoError(fmt::format("{}: {} bytes of data expected, {} found", place.file, needed, found));
  }
}

DecodedValues read_values(const DataPlace& place, std::uint64_t count, const ReadOptions& options, const Run& run) {
  require_room(place, count);
  const std::size_t width = bytes_per_scalar(place.layout.type);
  const Frames& frames = place.frames;
  const bool seek = frames.count > 1 && frames.together == count && !place.compressed;
  const std::uint64_t begin = place.offset + (seek ? frames.wanted * count * width : 0);
  auto source = place.compressed ? gzip_source(place.file, begin) : file_source(place.file, begin);
  skip_bytes(*source, place.skipped, place.file);
  if (frames.count > 1 && !seek) source = frame_source(std::move(source), frames, count, width);
  auto values = is_scaled(place) ? decode_scaled(*source, place.layout, count, {place.slope, place.intercept}, options,
                                                 place.file, run)
                                 : decode_scalars(*source, place.layout, count, options, place.file, run);
  // Asking for more is what makes zlib look at the check sum behind the last byte.
  std::byte more{};
  if (!seek && source->read(std::span(&more, 1)) != 0 && !place.more_allowed)
    throw IoError(fmt::format("{}: {} bytes of data expected, more found", place.file, count * frames.count * width));
  return values;
}

}  // namespace isolux::detail
