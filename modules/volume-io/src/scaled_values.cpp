#include "scaled_values.h"

#include "with_type.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace isolux::detail {
namespace {

constexpr std::size_t kPiece = 1 << 16;

template <class T>
double number_of(const std::byte* bytes) {
  T number;
  std::memcpy(&number, bytes, sizeof(T));
  return double(number);
}

}  // namespace

DecodedValues decode_scaled(ByteSource& source, const ScalarLayout& layout, std::uint64_t count, const Scaling& scaling,
                            const ReadOptions& options, const std::string& path, const Run& run) {
  const auto [slope, intercept] = scaling;
  AsWanted as_wanted(options, layout.type == ScalarType::kFloat32 || slope != 1.0 || intercept != 0.0);
  const std::size_t width = bytes_per_scalar(layout.type);
  const auto number = with_type(layout.type, [](auto zero) { return number_of<decltype(zero)>; });
  std::vector<float> values;
  bool rounded = false;
  values.reserve(count);
  std::vector<std::byte> piece(std::min<std::uint64_t>(count, kPiece) * width);
  while (values.size() < count) {
    throw_if_stopped(run);
    const std::size_t wanted = std::min<std::uint64_t>(kPiece, count - values.size());
    const std::span<std::byte> bytes = std::span(piece).first(wanted * width);
    if (const std::size_t got = source.read(bytes); got < bytes.size())
      throw IoError(fmt::format("{}: the data are too short: {} bytes expected, {} found", path, count * width,
                                values.size() * width + got));
    for (std::size_t i = 0; i < bytes.size(); i += width) {
      if (layout.big_endian) std::reverse(&bytes[i], &bytes[i] + width);
      const double stored = number(&bytes[i]);
      const double scaled = as_wanted(slope * stored + intercept);
      if (!fits_float(scaled) || (std::isinf(scaled) && std::isfinite(stored)))
        throw InvalidInput(
            fmt::format("{}: {}, value {} of the data, is {:.5g} as {} * x + {}, by which values are scaled: "
                        "beyond what float32 holds, in which volumes are kept",
                        path, stored, values.size(), scaled, slope, intercept - options.subtract));
      values.push_back(float(scaled));
      rounded |= double(values.back()) != scaled && !std::isnan(scaled);
    }
    if (run.progress) run.progress("read", double(values.size()) / double(count));
  }
  return {std::move(values), rounded, as_wanted.found_nodata()};
}

}  // namespace isolux::detail
