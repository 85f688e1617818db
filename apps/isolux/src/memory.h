#pragma once

#include <isolux/core/error.h>

#include <new>
#include <stdexcept>
#include <string>

namespace isolux {

/// Has the C library keep what is freed of arrays up to 32 MB for the next ones, and no more of it than that (glibc;
/// nothing elsewhere): a bake takes the same arrays for every part of the isovalues, and would spend up to half of its
/// time having them cleared anew. Larger ones go back to the system at once. To be called first in a program. Programs
/// that have this also ask for huge pages for arrays from 1 MB on: memory.cpp replaces operator new.
void reuse_arrays();

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
