#pragma once

#include <isolux/core/run.h>
#include <isolux/core/volume.h>

#include <span>
#include <string>
#include <string_view>

namespace isolux {

/// A function of the unit cube [0,1]^3 that `gen:NAME` samples. \see docs/file-formats.md for the formulas
struct AnalyticField {
  std::string_view name;
  std::string_view help;
  double (*value)(const Vec3& p);
  Vec3 (*gradient)(const Vec3& p);  ///< of `value`; anything finite where `value` has a kink
};

/// sphere, cavity, two-spheres, ball-over-plane, torus, gyroid, marschner-lobb, hydrogen. (`gen:noise` is no function
/// of position.)
[[nodiscard]] std::span<const AnalyticField> analytic_fields();
/// The field of that name. \throw InvalidInput naming those there are.
[[nodiscard]] const AnalyticField& analytic_field(std::string_view name);

/// The grid of `gen:NAME:n`: n points an axis on the unit cube, the first and last on its faces.
[[nodiscard]] Lattice unit_cube_lattice(int n);

/// `gen:NAME:n` itself, `noise` among the names: uniform in [0,1) from a counter-based generator keyed by `run.seed`
/// and the voxel's index. \throw InvalidInput unless the name is known and 2 <= n <= 2048.
[[nodiscard]] Volume sample_analytic_field(std::string_view name, int n, const Run& run = {});

}  // namespace isolux
