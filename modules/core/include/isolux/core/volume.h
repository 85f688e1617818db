#pragma once

#include <isolux/core/grid.h>

#include <cstdint>
#include <string>

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

/// A scalar field sampled at grid points; its trilinear interpolant f is what every stage sees (see field.h).
struct Volume {
  Grid<float> values;  ///< finite; at least 2 points an axis for anything but reading and writing
  std::string name;    ///< the file's path or `gen:` text, for messages and file headers
  ScalarType stored_type = ScalarType::kFloat32;  ///< what the file held before conversion to float
  std::string space = "left-posterior-superior";  ///< NRRD's name of the world space

  [[nodiscard]] const Lattice& lattice() const { return values.lattice(); }
};

struct ValueRange {
  float low = 0.0f;
  float high = 0.0f;
};

/// Smallest and largest value. \pre at least one voxel. Cost: one pass.
[[nodiscard]] ValueRange value_range(const Volume& volume);

/// \throw InvalidInput, naming the volume, if an axis has fewer than two grid points or a value is not finite: what
/// every stage after reading relies on.
void require_usable(const Volume& volume);

}  // namespace isolux
