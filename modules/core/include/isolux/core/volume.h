#pragma once

#include <isolux/core/grid.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace isolux {

/// The scalar type that a file stores.
enum class ScalarType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// A scalar field sampled at grid points, in floats; its trilinear interpolant f is what every stage sees (see
/// field.h).
struct Volume {
  Grid<float> values;  ///< finite; at least 2 points an axis for anything but reading and writing
  std::string name;    ///< the file's path or `gen:` text, for messages and file headers
  ScalarType stored_type = ScalarType::kFloat32;  ///< what the file held before conversion to float
  std::string space = "left-posterior-superior";  ///< NRRD's name of the world space
  bool rounded = false;                           ///< a value of the file is no float: the nearest one is here
  std::vector<std::string> remarks{};             ///< what its reader has to say of it, each a line that names the file

  [[nodiscard]] const Lattice& lattice() const { return values.lattice(); }
};

/// The same with its values in the type that the file stores, where that is whole numbers of 8 or 16 bits, else in
/// floats: a quarter or half of the memory for who needs no floats, such as the extraction of a surface. Every value of
/// the narrow types is a float, so both kinds of volume are the same field.
struct StoredVolume {
  std::variant<Grid<float>, Grid<std::uint8_t>, Grid<std::int8_t>, Grid<std::uint16_t>, Grid<std::int16_t>> values;
  std::string name;
  ScalarType stored_type = ScalarType::kFloat32;
  std::string space = "left-posterior-superior";
  bool rounded = false;
  std::vector<std::string> remarks{};

  [[nodiscard]] const Lattice& lattice() const;
};

/// The volume in floats. Those that are there already are moved, not copied.
[[nodiscard]] Volume to_floats(StoredVolume volume);
/// The volume as it is, in floats.
[[nodiscard]] StoredVolume keep_floats(Volume volume);

/// Looks at a volume of either kind, which it does not own: what takes it needs no floats.
class VolumeView {
 public:
  using Voxels = std::variant<std::span<const float>, std::span<const std::uint8_t>, std::span<const std::int8_t>,
                              std::span<const std::uint16_t>, std::span<const std::int16_t>>;

  VolumeView(const Volume& volume);        // NOLINT(google-explicit-constructor)
  VolumeView(const StoredVolume& volume);  // NOLINT(google-explicit-constructor)

  [[nodiscard]] const Lattice& lattice() const { return *lattice_; }
  [[nodiscard]] const std::string& name() const { return *name_; }
  [[nodiscard]] const std::string& space() const { return *space_; }
  [[nodiscard]] ScalarType stored_type() const { return stored_type_; }
  /// x fastest. For inner loops: std::visit.
  [[nodiscard]] const Voxels& voxels() const { return voxels_; }
  [[nodiscard]] float operator()(int i, int j, int k) const;
  /// The values from number `first` on, as floats. \pre there are as many
  void copy(std::size_t first, std::span<float> out) const;

 private:
  const Lattice* lattice_;
  const std::string* name_;
  const std::string* space_;
  ScalarType stored_type_;
  Voxels voxels_;
};

struct ValueRange {
  float low = 0.0f;
  float high = 0.0f;
};

/// Smallest and largest value. \pre at least one voxel. Cost: one pass.
[[nodiscard]] ValueRange value_range(const VolumeView& volume);

/// \throw InvalidInput, naming the volume, if an axis has fewer than two grid points, a value is not finite, the axes
/// span no volume, do not tell grid points apart or leave what floats hold: what every stage after reading relies on.
void require_usable(const VolumeView& volume);

}  // namespace isolux
