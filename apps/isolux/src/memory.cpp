#include "memory.h"

#include <isolux/core/huge_pages.h>
#include <isolux/core/sanitized.h>

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#ifndef ISOLUX_SANITIZED
namespace {
constexpr std::size_t kLarge = std::size_t(1) << 20;
}  // namespace

void* operator new(std::size_t bytes) {
  void* const memory = std::malloc(bytes > 0 ? bytes : 1);  // NOLINT: what new stands on
  if (memory == nullptr) throw std::bad_alloc();
  if (bytes >= kLarge) isolux::ask_for_huge_pages(memory, bytes);
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }                         // NOLINT: as above
void operator delete(void* memory, std::size_t /*bytes*/) noexcept { std::free(memory); }  // NOLINT: as above
#endif

namespace isolux {

void reuse_arrays() {
#ifdef __GLIBC__
  constexpr int kKept = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
#endif
}

}  // namespace isolux
