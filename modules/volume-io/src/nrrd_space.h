#pragma once

#include <isolux/core/lattice.h>

#include <optional>
#include <string>
#include <string_view>

namespace isolux::detail {

/// A three-dimensional world space of NRRD and how its coordinates become ours.
struct NrrdSpace {
  std::string_view name;  ///< in full, after the conversion
  Vec3 signs{1.0};        ///< factors that bring its coordinates to that space: anatomical ones to LPS
};

/// The space that `name`, in full or short ("RAS"), means; nothing for one that is unknown or not three-dimensional.
[[nodiscard]] std::optional<NrrdSpace> nrrd_space(std::string_view name);

}  // namespace isolux::detail
