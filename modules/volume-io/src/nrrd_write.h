#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/volume.h>

#include <map>
#include <ostream>
#include <string>

namespace isolux::detail {

/// What a NRRD file of ours holds besides its values.
struct NrrdImage {
  ScalarType type = ScalarType::kFloat32;
  int channels = 1;  ///< more than 1: a fourth axis, the fastest
  Lattice lattice;
  std::string space;
  std::map<std::string, std::string> key_values;
  bool compress = false;
  std::string data_file;  ///< detached: its name; empty where the data follow the header
};

/// The header, `sizes:` before `space:`, with the blank line behind it. \throw InvalidInput for a key that NRRD cannot
/// hold
void write_nrrd_header(std::ostream& out, const NrrdImage& image);

/// The values, gzip or raw, little endian. \throw InvalidInput as encode_scalars
void write_nrrd_values(std::ostream& out, const NrrdImage& image, const VolumeView::Voxels& values);

}  // namespace isolux::detail
