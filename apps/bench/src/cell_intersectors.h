#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace isolux::bench {

/// A ray's way through one cell: corner values less the isovalue (x fastest), and where it enters and leaves, in the
/// cell's coordinates.
struct CellProblem {
  std::array<double, 8> corners{};
  std::array<double, 3> enter{};
  std::array<double, 3> leave{};
};

/// Where the first root is, as a part of the way, 0 to 1.
using CellRoot = std::optional<double>;

/// A way to find the first root, by name and paper.
struct CellIntersector {
  std::string_view name;
  CellRoot (*first_root)(const CellProblem& problem);
};

/// Ours and the published ones.
[[nodiscard]] const std::vector<CellIntersector>& cell_intersectors();

/// The judge: long double, roots isolated at those of the derivatives.
struct CellVerdict {
  bool decided = false;  ///< false where double precision cannot tell: a root nearly double, an end nearly zero
  CellRoot root{};
};
[[nodiscard]] CellVerdict cell_oracle(const CellProblem& problem);

}  // namespace isolux::bench
