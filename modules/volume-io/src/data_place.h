#pragma once

#include "frames.h"
#include "scalars.h"

#include <cstdint>
#include <string>

namespace isolux::detail {

/// Where a volume's values lie, and how.
struct DataPlace {
  std::string file;
  std::uint64_t offset = 0;   ///< of the first value; of the stream that it is in, if it is compressed
  bool compressed = false;    ///< gzip or zlib
  std::uint64_t skipped = 0;  ///< bytes of the stream before the first value
  bool more_allowed = false;  ///< there may be something behind the values
  Frames frames{};            ///< where the file holds several volumes; what is said above is of all of them
  ScalarLayout layout;
  double slope = 1.0;  ///< a voxel is slope * stored + intercept
  double intercept = 0.0;
};

/// The type of voxels at a place as a volume tells of it: floats where they are scaled.
[[nodiscard]] ScalarType voxel_type(const DataPlace& place);

/// Whether a file can hold volumes of so many values, as far as its size tells: before memory is asked for. \throw
/// IoError naming the file and the bytes expected and found
void require_room(const DataPlace& place, std::uint64_t count);

/// The values less ReadOptions::subtract. \throw IoError naming the file for data that are too few, too many or
/// damaged; InvalidInput for a number that does not fit a float; Cancelled
[[nodiscard]] DecodedValues read_values(const DataPlace& place, std::uint64_t count, const ReadOptions& options,
                                        const Run& run);

}  // namespace isolux::detail
