#pragma once

#include <isolux/core/sample_set.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace isolux {

/// What rays are spent for.
struct RayBudget {
  double mean_variance = 0.0;  ///< stop where the mean squared standard error is expected to be so small
  double rays = std::numeric_limits<double>::infinity();  ///< nor spend more than these
};

/// The sites whose rays should be doubled next so that every ray takes away as much error as any other (Neyman, "On the
/// two different aspects of the representative method", 1934): a site gets rays as long as its variance divided by them
/// is above a level, the highest one that meets the budget if variances fall as rays^-1.5, as those of nets do where
/// light has edges. Variances are taken together with the neighbours in the list, lest a site that was lucky is left
/// alone. Cost: some 20 ns a site.
[[nodiscard]] std::vector<std::uint32_t> sites_to_double(std::span<const float> variances,
                                                         std::span<const std::uint32_t> rays, const RayBudget& budget);

}  // namespace isolux
