#include <isolux/mc_extract/large_vector.h>

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace isolux::detail {

namespace {
constexpr std::size_t kHugePage = std::size_t(2) << 20;
}  // namespace

void* allocate_large(std::size_t bytes) {
  if (bytes < kHugePage) return ::operator new(bytes);
  void* memory = ::operator new(bytes, std::align_val_t(kHugePage));
#ifdef __linux__
  // Advice only: where it is refused the memory is as good as any.
  madvise(memory, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_large(void* memory, std::size_t bytes) noexcept {
  if (bytes < kHugePage)
    ::operator delete(memory);
  else
    ::operator delete(memory, std::align_val_t(kHugePage));
}

}  // namespace isolux::detail
