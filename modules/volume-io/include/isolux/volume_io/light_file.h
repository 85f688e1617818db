#pragma once

#include <isolux/core/field.h>
#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>

#include <map>
#include <optional>
#include <string>

namespace isolux {

/// An illumination grid and the key/value pairs of its file (`isolux.version`, `isolux.scene`, ...).
struct LightFile {
  IlluminationGrid grid;  ///< of the outer side
  std::map<std::string, std::string> metadata;
  std::optional<IlluminationGrid> inner{};  ///< of the inner side, if both were lit; laid out as `grid`
  std::string path{};                       ///< the file that it was read from; empty for a light that was made
};

/// The light of one side. \throw InvalidInput if the light does not have it; `path` names it
[[nodiscard]] const IlluminationGrid& light_of_side(const LightFile& light, LevelSetSide side, const std::string& path);

struct LightWriteOptions {
  bool compress = false;  ///< gzip instead of raw
};

/// Writes NRRD0005: float32, little endian, 1 channel as 3 axes or 3 channels as 4 with the channel axis first
/// (`kinds: vector domain domain domain`); a light with slopes has them behind the values on that axis (2 or 6),
/// and those along the normal's x, y and z behind these (5 or 15; 4 or 12 without slopes over the isovalue;
/// `isolux.texel_numbers` says so); what else
/// its detail holds in `isolux.near_field` (`isolux.own_near_field`: TexelLight), `isolux.light_ceiling` and
/// `isolux.iso_range`; a light of both sides has the inner side's numbers behind all of the outer's (2, 6; 4, 12 with
/// slopes, and so on), `isolux.sides` = `both`, and `isolux.inner.*` for its detail; `sizes:` before `space:`, metadata
/// as key/value pairs (newlines escaped as the NRRD definition says). Written beside the target and renamed. `space` is
/// what the file says of its axes (Volume::space). \throw IoError; InvalidInput if the grid is not complete or the
/// sides are laid out differently
void write_light(const LightFile& light, const std::string& path, const std::string& space,
                 const LightWriteOptions& options = {});

/// Reads it back, from us or from anybody who kept the layout. \throw IoError, InvalidInput
[[nodiscard]] LightFile read_light(const std::string& path);

}  // namespace isolux
