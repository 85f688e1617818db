#include "trace_request.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

namespace isolux {

void require_usable(const Sites& sites, const TraceSettings& settings) {
  require_equal_lengths(sites);
  if (settings.rays < 1) throw InvalidInput(fmt::format("rays = {}: allowed is 1 and more", settings.rays));
  if (settings.bounces < kAllBounces)
    throw InvalidInput(fmt::format("bounces = {}: allowed is -1 (all), 0 and more", settings.bounces));
}

}  // namespace isolux
