#include "itk_pixels.h"

#include "scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <array>
#include <type_traits>

namespace isolux::detail {
namespace {

static_assert(std::is_trivially_copyable_v<SentVolume>, "it goes through a pipe between two copies of one program");

struct BlockHeader {
  ScalarType type = ScalarType::kUint8;
  std::uint64_t bytes = 0;
};

template <class T>
void send_value(const SendBytes& send, const T& value) {
  send(std::as_bytes(std::span(&value, 1)));
}

template <class T>
T receive_value(ByteSource& received, const std::string& path) {
  T value{};
  if (received.read(std::as_writable_bytes(std::span(&value, 1))) != sizeof(T))
    throw IoError(fmt::format("{}: the library that reads it gave no data", path));
  return value;
}

}  // namespace

void send_volume(const SendBytes& send, const SentVolume& volume) { send_value(send, volume); }

void send_block(const SendBytes& send, ScalarType type, std::span<const std::byte> values) {
  send_value(send, BlockHeader{type, values.size()});
  send(values);
}

ReceivedVolume receive_volume(ByteSource& received, const std::string& path, Index3 expected, VoxelForm form,
                              const Run& run) {
  ReceivedVolume volume;
  volume.header = receive_value<SentVolume>(received, path);
  const Index3 size = volume.header.lattice.size;
  if (size != expected)
    throw InvalidInput(fmt::format("{}: the header says {}x{}x{} voxels, the library that reads it {}x{}x{}", path,
                                   expected.x, expected.y, expected.z, size.x, size.y, size.z));
  const std::array<std::int64_t, 3> sizes = {size.x, size.y, size.z};
  const std::uint64_t count = checked_count(path, sizes, sizeof(float));
  const std::uint64_t blocks = volume.header.blocks;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const auto block = receive_value<BlockHeader>(received, path);
    const std::uint64_t in_block = block.bytes / bytes_per_scalar(block.type);
    if (in_block != count / blocks)
      throw IoError(
          fmt::format("{}: {} values expected of the library that reads it, {} came", path, count / blocks, in_block));
    Run quiet = run;
    if (blocks > 1) quiet.progress = {};
    auto values = decode_scalars(received, {block.type, false}, in_block, form, path, quiet);
    if (b == 0) {
      volume.values = std::move(values);
      std::visit([&](auto& list) { list.reserve(count); }, volume.values);
    } else {
      append(volume.values, values);
    }
    if (blocks > 1 && run.progress) run.progress("read", double(b + 1) / double(blocks));
  }
  return volume;
}

}  // namespace isolux::detail
