#pragma once

#include <isolux/core/lattice.h>
#include <isolux/volume_io/scalar_type.h>

#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>

namespace isolux::detail {

/// Takes bytes to the parent process.
using SendBytes = std::function<void(std::span<const std::byte>)>;

/// What a child says of the volume before it sends the values.
struct SentVolume {
  Lattice lattice;
  ScalarType stored_type = ScalarType::kFloat32;
  std::uint64_t blocks = 0;  ///< of values, each a SentBlock and its bytes; none where the parent reads them itself
  std::uint64_t remark_bytes = 0;  ///< of a remark on the volume, which follows
};
static_assert(std::is_trivially_copyable_v<SentVolume>, "it goes through a pipe between two copies of one program");

/// What a child says of a block of values before it sends them.
struct SentBlock {
  ScalarType type = ScalarType::kUint8;
  std::uint64_t bytes = 0;
};

}  // namespace isolux::detail
