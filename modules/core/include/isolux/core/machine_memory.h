#pragma once

#include <cstdint>

namespace isolux {

/// Bytes of memory that the machine has; infinite where the system does not say.
[[nodiscard]] double machine_memory();

/// The most bytes of memory that this process has had at once.
[[nodiscard]] std::uint64_t peak_memory();

}  // namespace isolux
