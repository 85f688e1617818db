#pragma once

#include "child_process.h"
#include "scalars.h"

#include <isolux/core/lattice.h>
#include <isolux/volume_io/scalar_type.h>

namespace isolux::detail {

/// What a child says of the volume before it sends the values.
struct SentVolume {
  Lattice lattice;
  ScalarType stored_type = ScalarType::kFloat32;
  std::uint64_t blocks = 0;  ///< of values, each with its own type
};

/// In the child.
void send_volume(const SendBytes& send, const SentVolume& volume);
void send_block(const SendBytes& send, ScalarType type, std::span<const std::byte> values);

/// In the parent. \throw IoError naming `path` if fewer bytes come than are needed; InvalidInput if the size is not
/// `expected`
struct ReceivedVolume {
  SentVolume header;
  AnyValues values;
};
[[nodiscard]] ReceivedVolume receive_volume(ByteSource& received, const std::string& path, Index3 expected,
                                            VoxelForm form, const Run& run);

}  // namespace isolux::detail
