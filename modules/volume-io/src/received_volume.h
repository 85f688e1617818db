#pragma once

#include "scalars.h"
#include "sent_volume.h"

namespace isolux::detail {

struct ReceivedVolume {
  SentVolume header;
  AnyValues values;
};
/// Takes what a child sends. \throw IoError naming `path` if fewer bytes come than are needed; InvalidInput if the size
/// is not `expected`
[[nodiscard]] ReceivedVolume receive_volume(ByteSource& received, const std::string& path, Index3 expected,
                                            VoxelForm form, const Run& run);

}  // namespace isolux::detail
