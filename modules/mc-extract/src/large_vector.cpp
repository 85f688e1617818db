#include <isolux/core/huge_pages.h>
#include <isolux/mc_extract/large_vector.h>

namespace isolux::detail {

void* allocate_large(std::size_t bytes) {
  if (bytes < kHugePage) return ::operator new(bytes);
  void* memory = ::operator new(bytes, std::align_val_t(kHugePage));
  ask_for_huge_pages(memory, bytes / kHugePage * kHugePage);
  return memory;
}

void free_large(void* memory, std::size_t bytes) noexcept {
  if (bytes < kHugePage)
    ::operator delete(memory);
  else
    ::operator delete(memory, std::align_val_t(kHugePage));
}

}  // namespace isolux::detail
