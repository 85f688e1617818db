#pragma once

#include <isolux/core/volume.h>

#include <string>
#include <vector>

namespace isolux {

struct WriteOptions {
  bool compress = false;  ///< gzip, where the format has it
};

/// The files that write_volume() writes: `path`, and behind it the data file of a detached header. \throw InvalidInput
/// naming the writable extensions, or for a name that no header can give its data file; IoError if such a data file is
/// there already and is not that of the header at `path`
[[nodiscard]] std::vector<std::string> files_written(const std::string& path, const WriteOptions& options = {});

/// That a headerless file's name says the volume's size, and a type: other formats take any name. \throw InvalidInput
/// with the name that does
void require_name_of(const VolumeView& volume, const std::string& path);

/// Writes a volume in the format of its extension (.nrrd, .nhdr, .raw as name_WxHxD_type.raw), in its stored type.
/// Written beside the target and renamed. NRRD knows some spaces by name; any other is written as three dimensions
/// without a name, which is read back as 3D-right-handed. \throw as files_written() and require_name_of(); IoError;
/// InvalidInput for volumes that could not be read back: without grid points, or with axes that span no volume
void write_volume(const VolumeView& volume, const std::string& path, const WriteOptions& options = {});

}  // namespace isolux
