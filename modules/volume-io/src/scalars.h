#pragma once

#include "byte_source.h"

#include <isolux/core/run.h>
#include <isolux/volume_io/scalar_type.h>
#include <isolux/volume_io/volume_reader.h>

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace isolux::detail {

/// How numbers lie in a file.
struct ScalarLayout {
  ScalarType type = ScalarType::kUint8;
  bool big_endian = false;
};

/// Number of values of a grid of these sizes. \throw InvalidInput naming `path` if a size is below 1 or above 2^31 - 1,
/// or if their bytes do not fit in 63 bits.
[[nodiscard]] std::uint64_t checked_count(const std::string& path, std::span<const std::int64_t> sizes,
                                          std::size_t bytes_per_value);

/// Values in one of the types that StoredVolume holds.
using AnyValues = std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::int8_t>,
                               std::vector<std::uint16_t>, std::vector<std::int16_t>>;

/// Values as they were read.
struct DecodedValues {
  AnyValues list;
  bool rounded = false;       ///< one of them is no float in the file
  bool found_nodata = false;  ///< one of them was ReadOptions::nodata
};

/// Whether a number has a nearest float: infinities and NaN have one, finite numbers beyond the largest have not.
[[nodiscard]] bool fits_float(double value);

/// Whether the whole text is one finite number of `type`, as C++ and C write it: whole numbers without a point or an
/// exponent.
[[nodiscard]] bool reads_as(ScalarType type, std::string_view text);

/// What a number of a file is read as.
class AsWanted {
 public:
  /// `by_floats`: the file is of floats, or scales its numbers, so that it holds what is nearest to
  /// ReadOptions::nodata.
  AsWanted(const ReadOptions& options, bool by_floats)
      : nodata_(options.nodata), subtract_(options.subtract), by_floats_(by_floats) {}

  /// NaN for ReadOptions::nodata, any other less ReadOptions::subtract.
  [[nodiscard]] double operator()(double number) {
    if (!nodata_ || (number != *nodata_ && !(by_floats_ && float(number) == float(*nodata_))))
      return number - subtract_;
    found_nodata_ = true;
    return std::numeric_limits<double>::quiet_NaN();
  }
  /// Whether one of the numbers so far was ReadOptions::nodata.
  [[nodiscard]] bool found_nodata() const { return found_nodata_; }

 private:
  std::optional<double> nodata_;
  double subtract_;
  bool by_floats_;
  bool found_nodata_ = false;
};

/// Reads `count` numbers, in ReadOptions::form and without ReadOptions::nodata and less ReadOptions::subtract. \throw
/// InvalidInput for a number that does not fit a float; IoError naming `path` and the bytes expected and found if there
/// are fewer; Cancelled. Memory follows what was read, not what was promised.
[[nodiscard]] DecodedValues decode_scalars(ByteSource& source, const ScalarLayout& layout, std::uint64_t count,
                                           const ReadOptions& options, const std::string& path, const Run& run);

/// Puts `more` behind `values`: both in floats if their types differ.
void append(DecodedValues& values, const DecodedValues& more);

/// Encodes a volume's voxels in pieces, little endian, and hands each piece on. Values must be representable: whole
/// numbers within the range of an integer type (its limits as rounded to float are taken as the limits themselves).
/// \throw InvalidInput naming the first value that is not.
void encode_scalars(const VolumeView::Voxels& values, ScalarType type,
                    const std::function<void(std::span<const std::byte>)>& sink);

}  // namespace isolux::detail
