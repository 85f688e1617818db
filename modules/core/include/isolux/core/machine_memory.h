#pragma once

namespace isolux {

/// Bytes of memory that the machine has; infinite where the system does not say.
[[nodiscard]] double machine_memory();

}  // namespace isolux
