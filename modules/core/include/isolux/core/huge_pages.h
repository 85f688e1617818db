#pragma once

#include <cstddef>

namespace isolux {

inline constexpr std::size_t kHugePage = std::size_t(2) << 20;  ///< bytes

/// Asks the system for huge pages for all of these bytes, whatever else lies in their first and last page (Linux;
/// nothing elsewhere). A page fault then brings 2 MB instead of 4 kB. Advice only: where it is refused, the memory is
/// as good as any.
void ask_for_huge_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace isolux
