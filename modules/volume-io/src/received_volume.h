#pragma once

#include "format_checks.h"
#include "scalars.h"
#include "sent_volume.h"

namespace isolux::detail {

struct ReceivedVolume {
  SentVolume header;
  std::string remark;  ///< Volume::remarks; empty if there is none
  DecodedValues values;
};
/// Takes what a child sends. \throw IoError naming `path` if fewer bytes come than are needed; InvalidInput if the size
/// or the voxels' type is not what our own look at the file promises
[[nodiscard]] ReceivedVolume receive_volume(ByteSource& received, const std::string& path,
                                            const CheckedHeader& expected, const ReadOptions& options, const Run& run);

}  // namespace isolux::detail
