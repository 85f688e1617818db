#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace isolux {

namespace detail {
/// Memory for `bytes` bytes; from 2 MB on aligned to 2 MB and marked for huge pages, where page faults cost an eighth.
[[nodiscard]] void* allocate_large(std::size_t bytes);
void free_large(void* memory, std::size_t bytes) noexcept;
}  // namespace detail

/// An allocator for big arrays of plain values: huge pages, and elements that resize() adds are left uninitialised.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>& /*other*/) {}  // NOLINT: allocators convert

  [[nodiscard]] T* allocate(std::size_t count) { return static_cast<T*>(detail::allocate_large(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t count) noexcept { detail::free_large(memory, count * sizeof(T)); }
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Args>
  void construct(U* place, Args&&... args) {
    ::new (static_cast<void*>(place)) U(static_cast<Args&&>(args)...);
  }
  template <class U>
  bool operator==(const LargeAllocator<U>& /*other*/) const {
    return true;
  }
};

/// A vector whose resize() does not clear. To grow one that holds nothing of worth, clear() it first.
template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace isolux
