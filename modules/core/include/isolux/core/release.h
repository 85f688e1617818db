#pragma once

#include <vector>

namespace isolux {

/// Empties an array and gives its memory back. `array = {}` would not: that is an assignment of no values, which keeps
/// the memory.
template <class T>
void release(std::vector<T>& array) {
  std::vector<T>().swap(array);
}

/// Has the allocator give the system what has been freed in small pieces, which it would keep (glibc): for the moment
/// between much that is let go and much that is asked for. Some milliseconds for each GB.
void return_freed_memory();

}  // namespace isolux
