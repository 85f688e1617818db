#include <isolux/core/huge_pages.h>

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace isolux {

void ask_for_huge_pages(void* memory, std::size_t bytes) noexcept {
#ifdef __linux__
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t begin = address / kHugePage * kHugePage;
  const std::uintptr_t end = (address + bytes + kHugePage - 1) / kHugePage * kHugePage;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // NOLINT: an address
#else
  (void)memory;
  (void)bytes;
#endif
}

}  // namespace isolux
