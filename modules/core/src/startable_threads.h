#pragma once

namespace isolux::detail {

/// How many of `wanted` threads the system lets this process have at once, its own included: a limit on processes or
/// on memory may allow fewer. Tried out the first time that so many are wanted; from any thread.
[[nodiscard]] int startable_threads(int wanted);

}  // namespace isolux::detail
