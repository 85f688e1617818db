#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "suite.h"

namespace isolux::bench {

/// A tracer that is wrong or slow on purpose, to show that the suites see it.
struct Fault {
  std::string_view name;  ///< of its tracer
  std::string_view help;
};

/// The faults that can be injected:
/// - `dim_light`: the default tracer, its light times .98
/// - `lost_hits`: a ray forgets one hit in fifty
/// - `no_skipping`: tests every cell on a ray's way, one after another, as if nothing were known of where f can reach
/// `lost_hits` and `no_skipping` know uniform environments and emission only.
[[nodiscard]] const std::vector<Fault>& faults();

/// The stages with the fault's tracer added to them as their default. \throw InvalidInput for an unknown name
[[nodiscard]] Stages with_fault(Stages stages, std::string_view name);

}  // namespace isolux::bench
