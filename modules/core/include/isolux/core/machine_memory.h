#pragma once

#include <cstdint>

namespace isolux {

/// Bytes of memory that this process can have: the machine's, or what its control group (a container, a batch job) may;
/// infinite where the system says neither.
[[nodiscard]] double machine_memory();

/// What no process has taken of these, and this one still may (`ulimit -v`); memory that only caches files is free.
/// Infinite likewise.
[[nodiscard]] double free_memory();

/// What `ulimit -v` leaves this process of addresses; infinite without.
[[nodiscard]] double free_addresses();

/// The most bytes of memory that this process has had at once.
[[nodiscard]] std::uint64_t peak_memory();

}  // namespace isolux
