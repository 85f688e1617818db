#include "received_volume.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace isolux::detail {
namespace {

template <class T>
T receive_value(ByteSource& received, const std::string& path) {
  T value{};
  if (received.read(std::as_writable_bytes(std::span(&value, 1))) != sizeof(T))
    throw IoError(fmt::format("{}: the library that reads it gave no data", path));
  return value;
}

std::string receive_remark(ByteSource& received, const std::string& path, std::uint64_t bytes) {
  constexpr std::uint64_t kLongest = 1 << 16;
  std::string remark(std::min(bytes, kLongest), '\0');
  if (bytes > kLongest || received.read(std::as_writable_bytes(std::span(remark))) != bytes)
    throw IoError(fmt::format("{}: the library that reads it gave no data", path));
  return remark;
}

void require_type(const std::string& path, const CheckedHeader& expected, ScalarType type) {
  if (expected.type && *expected.type != type)
    throw InvalidInput(fmt::format("{}: the header says voxels of type {}, the library that reads it {}", path,
                                   scalar_type_name(*expected.type), scalar_type_name(type)));
}

/// Whether 16 bits with a sign hold all values, but for NaN. DICOM's library gives unsigned numbers of 16 bits that an
/// intercept shifts below 0 in 32 bits, whatever their values are.
bool fit_int16(const DecodedValues& values) {
  const auto fits = [](float x) { return std::isnan(x) || (x >= -32768.0f && x <= 32767.0f && std::floor(x) == x); };
  const auto* const floats = std::get_if<std::vector<float>>(&values.list);
  return floats != nullptr && std::all_of(floats->begin(), floats->end(), fits);
}

}  // namespace

ReceivedVolume receive_volume(ByteSource& received, const std::string& path, const CheckedHeader& expected,
                              const ReadOptions& options, const Run& run) {
  ReceivedVolume volume;
  volume.header = receive_value<SentVolume>(received, path);
  volume.remark = receive_remark(received, path, volume.header.remark_bytes);
  const Index3 size = volume.header.lattice.size;
  if (size != expected.size)
    throw InvalidInput(fmt::format("{}: the header says {}x{}x{} voxels, the library that reads it {}x{}x{}", path,
                                   expected.size.x, expected.size.y, expected.size.z, size.x, size.y, size.z));
  require_type(path, expected, volume.header.stored_type);
  const std::array<std::int64_t, 3> sizes = {size.x, size.y, size.z};
  const std::uint64_t count = checked_count(path, sizes, sizeof(float));
  const std::uint64_t blocks = volume.header.blocks;
  bool are_int16 = blocks > 0 && volume.header.stored_type == ScalarType::kInt32 && options.subtract == 0.0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const auto block = receive_value<SentBlock>(received, path);
    require_type(path, expected, block.type);
    const std::uint64_t in_block = block.bytes / bytes_per_scalar(block.type);
    if (in_block != count / blocks)
      throw IoError(
          fmt::format("{}: {} values expected of the library that reads it, {} came", path, count / blocks, in_block));
    Run quiet = run;
    if (blocks > 1) quiet.progress = {};
    auto values = decode_scalars(received, {block.type, false}, in_block, options, path, quiet);
    are_int16 = are_int16 && fit_int16(values);
    if (are_int16 && options.form == VoxelForm::kStored && !options.nodata)
      values.list =
          std::visit([](const auto& list) { return std::vector<std::int16_t>(list.begin(), list.end()); }, values.list);
    if (b == 0) {
      volume.values = std::move(values);
      std::visit([&](auto& list) { list.reserve(count); }, volume.values.list);
    } else {
      append(volume.values, values);
    }
    if (blocks > 1 && run.progress) run.progress("read", double(b + 1) / double(blocks));
  }
  if (are_int16) volume.header.stored_type = ScalarType::kInt16;
  return volume;
}

}  // namespace isolux::detail
