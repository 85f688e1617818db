#include "scalars.h"

#include "number_text.h"
#include "scaled_values.h"
#include "with_type.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace isolux::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "x86-64 and little-endian Arm are what isolux is built for");
constexpr std::size_t kChunk = 1 << 16;

template <class T>
void swap_bytes(std::span<std::byte> bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(T))
    std::reverse(bytes.begin() + std::ptrdiff_t(i), bytes.begin() + std::ptrdiff_t(i + sizeof(T)));
}

/// Whether `number` is a float, or none at all.
template <class T>
bool is_float(T number) {
  if constexpr (std::is_floating_point_v<T>) {
    return double(float(number)) == double(number) || std::isnan(number);
  } else {
    const auto size = number < 0 ? 0 - std::uint64_t(number) : std::uint64_t(number);
    return size == 0 || std::bit_width(size >> std::countr_zero(size)) <= std::numeric_limits<float>::digits;
  }
}

/// Numbers `first` and on of `path`'s data as floats; whether one of them was rounded. \throw InvalidInput
template <class T>
bool convert(std::span<const T> values, std::span<float> floats, std::uint64_t first, const std::string& path) {
  bool rounded = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    floats[i] = float(values[i]);
    if constexpr (sizeof(T) >= sizeof(float) && !std::is_same_v<T, float>) rounded |= !is_float(values[i]);
    if constexpr (std::is_same_v<T, double>) {
      if (!fits_float(values[i]))
        throw InvalidInput(
            fmt::format("{}: {}, value {} of the data, is beyond what float32 holds, in which volumes "
                        "are kept (+-{:.5g})",
                        path, values[i], first + i, double(std::numeric_limits<float>::max())));
    }
  }
  return rounded;
}

/// Numbers of type T in the file, read into the same or into floats.
template <class T, class Out>
DecodedValues decode(ByteSource& source, bool big_endian, std::uint64_t count, const std::string& path,
                     const Run& run) {
  constexpr bool kConverts = !std::is_same_v<T, Out>;
  std::vector<Out> values;
  bool rounded = false;
  // Reserved memory is touched only as the data come in.
  values.reserve(count);
  std::vector<T> buffer(kConverts ? std::min<std::uint64_t>(count, kChunk) : 0);
  for (std::uint64_t done = 0; done < count;) {
    throw_if_stopped(run);
    const std::size_t wanted = std::min<std::uint64_t>(kChunk, count - done);
    values.resize(done + wanted);
    const std::span<Out> out = std::span(values).subspan(done);
    std::span<std::byte> bytes;
    if constexpr (kConverts)
      bytes = std::as_writable_bytes(std::span(buffer).first(wanted));
    else
      bytes = std::as_writable_bytes(out);
    const std::size_t got = source.read(bytes);
    if (got < bytes.size()) {
      throw IoError(fmt::format("{}: the data are too short: {} bytes expected, {} found", path, count * sizeof(T),
                                done * sizeof(T) + got));
    }
    if (big_endian && sizeof(T) > 1) swap_bytes<T>(bytes);
    if constexpr (kConverts) rounded |= convert(std::span<const T>(buffer).first(wanted), out, done, path);
    done += wanted;
    if (run.progress) run.progress("read", double(done) / double(count));
  }
  return {std::move(values), rounded};
}

template <class T>
T encode_one(float value, std::size_t index) {
  if constexpr (std::is_floating_point_v<T>) {
    return T(value);
  } else {
    constexpr T kLow = std::numeric_limits<T>::min();
    constexpr T kHigh = std::numeric_limits<T>::max();
    if (!(value >= float(kLow) && value <= float(kHigh)) || std::floor(value) != value) {
      throw InvalidInput(fmt::format("voxel {} is {}, which no {}-byte {}signed integer holds; store it as float32",
                                     index, value, sizeof(T), std::is_signed_v<T> ? "" : "un"));
    }
    // The limits of wide types are not floats: the nearest float may lie just beyond.
    if (value >= float(kHigh)) return kHigh;
    return T(value);
  }
}

}  // namespace

std::uint64_t checked_count(const std::string& path, std::span<const std::int64_t> sizes, std::size_t bytes_per_value) {
  constexpr auto kMost = std::uint64_t(std::numeric_limits<std::int64_t>::max());
  std::uint64_t count = 1;
  for (const std::int64_t size : sizes) {
    if (size < 1 || size > std::numeric_limits<int>::max())
      throw InvalidInput(fmt::format("{}: sizes {}: allowed is 1 to {} an axis", path, fmt::join(sizes, " "),
                                     std::numeric_limits<int>::max()));
    if (count > kMost / bytes_per_value / std::uint64_t(size))
      throw InvalidInput(
          fmt::format("{}: sizes {}: their product does not fit in 63 bits", path, fmt::join(sizes, " ")));
    count *= std::uint64_t(size);
  }
  return count;
}

bool fits_float(double value) { return std::isfinite(float(value)) || !std::isfinite(value); }

bool reads_as(ScalarType type, std::string_view text) {
  return with_type(type, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_integral_v<T>) {
      if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
      T value{};
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      return error == std::errc() && end == text.data() + text.size();
    } else {
      const auto value = parse_real(text);
      return value && std::isfinite(T(*value));
    }
  });
}

DecodedValues decode_scalars(ByteSource& source, const ScalarLayout& layout, std::uint64_t count,
                             const ReadOptions& options, const std::string& path, const Run& run) {
  if (options.subtract != 0.0 || options.nodata) return decode_scaled(source, layout, count, {}, options, path, run);
  return with_type(layout.type, [&](auto zero) -> DecodedValues {
    using T = decltype(zero);
    if constexpr (std::is_integral_v<T> && sizeof(T) <= 2) {
      if (options.form == VoxelForm::kStored) return decode<T, T>(source, layout.big_endian, count, path, run);
    }
    return decode<T, float>(source, layout.big_endian, count, path, run);
  });
}

void append(DecodedValues& values, const DecodedValues& more) {
  values.rounded |= more.rounded;
  values.found_nodata |= more.found_nodata;
  if (values.list.index() != more.list.index() && !std::holds_alternative<std::vector<float>>(values.list))
    values.list =
        std::visit([](const auto& list) { return std::vector<float>(list.begin(), list.end()); }, values.list);
  std::visit(
      [](auto& list, const auto& behind) {
        if constexpr (std::is_same_v<decltype(list), std::vector<float>&> ||
                      std::is_same_v<std::decay_t<decltype(list)>, std::decay_t<decltype(behind)>>)
          list.insert(list.end(), behind.begin(), behind.end());
      },
      values.list, more.list);
}

void encode_scalars(const VolumeView::Voxels& values, ScalarType type,
                    const std::function<void(std::span<const std::byte>)>& sink) {
  const std::size_t width = bytes_per_scalar(type);
  std::visit(
      [&](const auto& all) {
        std::vector<std::byte> bytes(std::min(all.size(), kChunk) * width);
        for (std::size_t begin = 0; begin < all.size(); begin += kChunk) {
          const std::size_t count = std::min(kChunk, all.size() - begin);
          with_type(type, [&](auto zero) {
            using T = decltype(zero);
            for (std::size_t i = 0; i < count; ++i) {
              const T value = encode_one<T>(float(all[begin + i]), begin + i);
              std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
            }
          });
          sink(std::span(bytes).first(count * width));
        }
      },
      values);
}

}  // namespace isolux::detail
