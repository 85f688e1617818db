#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>

#include <map>
#include <string>

namespace isolux {

/// An illumination grid and the key/value pairs of its file (`isolux.version`, `isolux.scene`, ...).
struct LightFile {
  IlluminationGrid grid;
  std::map<std::string, std::string> metadata;
};

struct LightWriteOptions {
  bool compress = false;  ///< gzip instead of raw
};

/// Writes NRRD0005: float32, little endian, 1 channel as 3 axes or 3 channels as 4 with the channel axis first
/// (`kinds: vector domain domain domain`); a light with slopes has them behind the values on that axis (2 or 6), and
/// what else its detail holds in `isolux.near_field` and `isolux.light_ceiling`; `sizes:` before `space:`, metadata as
/// key/value pairs (newlines escaped as the NRRD definition says). Written beside the target and renamed. \throw
/// IoError
void write_light(const LightFile& light, const std::string& path, const std::string& space,
                 const LightWriteOptions& options = {});

/// Reads it back, from us or from anybody who kept the layout. \throw IoError, InvalidInput
[[nodiscard]] LightFile read_light(const std::string& path);

}  // namespace isolux
