#pragma once

#include <isolux/core/error.h>

#include <new>
#include <stdexcept>
#include <string>

namespace isolux {

/// Has the C library give large arrays back to the system when they are freed (glibc; nothing elsewhere). By itself it
/// does so only up to the size of the largest one freed so far, up to 32 MB, and keeps what is smaller: stages that
/// each take and free tens of megabytes then hold much of it all together. Before anything is allocated.
void return_large_arrays();

/// Does `work`; where memory does not suffice, the error says for what it does not. \throw Error
template <class Work>
auto with_memory_for(const std::string& what, Work&& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw Error("not enough memory for " + what);
}

}  // namespace isolux
