#pragma once

#include <vector>

namespace isolux {

/// Empties an array and gives its memory back. `array = {}` would not: that is an assignment of no values, which keeps
/// the memory.
template <class T>
void release(std::vector<T>& array) {
  std::vector<T>().swap(array);
}

}  // namespace isolux
