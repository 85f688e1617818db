#pragma once

#include "frames.h"
#include "nrrd_text.h"
#include "scalars.h"

#include <isolux/core/lattice.h>
#include <isolux/volume_io/volume_reader.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isolux::detail {

enum class NrrdEncoding : std::uint8_t { kRaw, kGzip, kText };

/// One axis of a NRRD, as far as its header tells.
struct NrrdAxis {
  std::int64_t size = 0;
  std::optional<Vec3> direction;  ///< space directions; nothing for "none"
  std::optional<double> spacing;
  std::optional<double> min;
  std::optional<double> max;
  bool node_centered = false;
  std::string kind = "???";
};

/// A NRRD header, understood and checked: what follows from it alone is consistent.
struct NrrdHeader {
  std::string path;
  ScalarLayout layout;
  NrrdEncoding encoding = NrrdEncoding::kRaw;
  std::vector<NrrdAxis> axes;  ///< fastest first
  std::string space;           ///< as written; empty if the header names none
  bool has_directions = false;
  std::optional<Vec3> origin;
  std::string data_file;  ///< the file that holds the data: `path` itself where they are attached
  std::uint64_t data_offset = 0;
  std::uint64_t line_skip = 0;
  std::int64_t byte_skip = 0;  ///< -1: the data are the file's last bytes
  std::map<std::string, std::string> key_values;
};

/// \throw IoError, InvalidInput naming the file, the field, its value and what is allowed
[[nodiscard]] NrrdHeader read_nrrd_header(const std::string& path, const ReadOptions& options);

/// The values of one of the volumes that all axes make, in ReadOptions::form and less ReadOptions::subtract; floats
/// where they are written as text. \throw IoError, InvalidInput, Cancelled
[[nodiscard]] DecodedValues read_nrrd_values(const NrrdHeader& header, const Frames& frames, const ReadOptions& options,
                                             const Run& run);

/// The lattice of three of the axes, in LPS where the space is anatomical, and its space's name as Volume has it.
/// \throw InvalidInput for directions that span no volume
struct NrrdFrame {
  Lattice lattice;
  std::string space;
};
[[nodiscard]] NrrdFrame nrrd_frame(const NrrdHeader& header, std::span<const NrrdAxis> axes);

}  // namespace isolux::detail
