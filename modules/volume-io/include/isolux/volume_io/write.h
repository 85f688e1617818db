#pragma once

#include <isolux/core/volume.h>

#include <string>

namespace isolux {

struct WriteOptions {
  bool compress = false;  ///< gzip, where the format has it
};

/// Writes a volume in the format of its extension (.nrrd, .nhdr, .raw as name_WxHxD_type.raw, and what the itk backend
/// adds), in its stored type. Written beside the target and renamed. \throw InvalidInput naming the writable
/// extensions; IoError.
void write_volume(const VolumeView& volume, const std::string& path, const WriteOptions& options = {});

}  // namespace isolux
