#include "make_volume.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace isolux::detail {

Volume make_volume(const std::string& name, Lattice lattice, std::vector<float> values, ScalarType stored,
                   std::string space, const ReadOptions& options) {
  if (options.spacing) {
    for (int a = 0; a < 3; ++a) {
      const double step = (*options.spacing)[a];
      if (!std::isfinite(step) || step <= 0.0)
        throw InvalidInput(fmt::format("{}: spacing {} on axis {}: allowed is a finite number above 0", name, step, a));
      lattice.frame.axes[a] = glm::normalize(lattice.frame.axes[a]) * step;
    }
  }
  return {.values = Grid<float>(lattice, std::move(values)),
          .name = name,
          .stored_type = stored,
          .space = std::move(space)};
}

}  // namespace isolux::detail
