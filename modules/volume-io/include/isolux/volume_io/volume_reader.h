#pragma once

#include <isolux/core/error.h>
#include <isolux/core/registry.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// What a headerless file cannot say of itself.
struct RawLayout {
  Index3 size{0};
  ScalarType type = ScalarType::kUint8;
  bool big_endian = false;
};

/// Neither its name nor ReadOptions::raw says what a headerless file cannot.
class UnknownLayout : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// The type that voxels are read into.
enum class VoxelForm : std::uint8_t {
  kFloats,  ///< the nearest float to each
  kStored   ///< that of the file where it holds whole numbers of 8 or 16 bits; else floats
};

/// How to read a volume.
struct ReadOptions {
  std::optional<RawLayout> raw;  ///< dims, type and endianness of a headerless file
  bool big_endian = false;       ///< of a headerless file whose name says the rest
  std::optional<Vec3> spacing;   ///< replaces the file's spacing, world units; needed where a format has none
  double subtract = 0.0;         ///< finite; taken off each value before it becomes a float: what is left is float32
  /// Numbers of the file, scaled where it says so, that stand for none: they become NaN, and all others floats.
  /// Where there is none, Volume::remarks says so.
  std::optional<double> nodata{};
  bool allow_external_data = false;                         ///< a header may name a data file outside its own folder
  VoxelForm form = VoxelForm::kFloats;                      ///< set by read_volume and read_stored_volume
  std::map<std::string, Settings, std::less<>> settings{};  ///< options of readers, by their names
};

/// The volume-io stage: reads one family of formats. Backends are immutable and callable from many threads.
class VolumeReader {
 public:
  static constexpr std::string_view kStage = "reader";
  virtual ~VolumeReader() = default;

  /// How sure this reader is that `source` (a path, or `gen:` text) is of its kind: 0 not at all, 1 by its name, 2 by
  /// its content, 3 because the caller says so (`gen:`, ReadOptions::raw).
  [[nodiscard]] virtual int claims(const std::string& source, const ReadOptions& options) const = 0;
  /// Reads it all, in ReadOptions::form. Voxels may be NaN or infinite and axes 1 wide, as in the file: see
  /// require_usable(). \throw IoError if it cannot be opened or is shorter than its header says; InvalidInput for a
  /// header that makes no sense or asks for what is not supported. Every message names the file.
  [[nodiscard]] virtual StoredVolume read(const std::string& source, const ReadOptions& options,
                                          const Run& run) const = 0;
  /// The files that read() takes, the header's own first: `source` alone, if a reader does not say otherwise. \throw as
  /// read(), of the header
  [[nodiscard]] virtual std::vector<std::string> files(const std::string& source,
                                                       const ReadOptions& /*options*/) const {
    return {source};
  }
  /// Whether it takes what files do not say of themselves: ReadOptions::raw and big_endian.
  [[nodiscard]] virtual bool takes_layout() const { return false; }
};

/// raw, nrrd, npy, mrc, nifti, vtk and analytic, and those whose libraries were there when it was built: vti and itk.
[[nodiscard]] Registry<VolumeReader> readers();

}  // namespace isolux
