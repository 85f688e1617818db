#pragma once

#include <isolux/core/field.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace isolux::bench {

/// Noise in [0,1) within a shell, one grid point thick, of value 2: on every level set below 1 the side of lower values
/// is closed.
[[nodiscard]] Volume closed_noise(int n, std::uint64_t seed);

/// The level sets of gen:gyroid whose side of lower values is one piece, open to the box's faces from everywhere: light
/// gets in at all of their points. Further down that side falls apart into pockets, dark by definition.
[[nodiscard]] ValueRange open_gyroid();

/// Volumes whose values or frames invite overflow, underflow and lost digits.
[[nodiscard]] std::vector<Volume> nasty_volumes();

/// A volume, an image of it, and how rays (index space) and isovalues go from one to the other.
struct Transformed {
  Volume volume;
  Volume transformed;
  std::function<Vec3(const Vec3&)> position;
  std::function<Vec3(const Vec3&)> direction;
  std::function<float(float)> isovalue;
  OuterSide outer = OuterSide::kLower;
};
/// Mirroring, rotation of the axes, f -> a f + b for a > 0 and a < 0: values are whole numbers, so that every map is
/// exact in float.
[[nodiscard]] std::vector<std::pair<std::string, Transformed>> transformations(const Run& run);

}  // namespace isolux::bench
