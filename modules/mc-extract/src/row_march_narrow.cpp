#include <isolux/core/parallel.h>

#include <atomic>
#include <new>

#include "row_march.h"
#include "wide_kernels.h"

namespace isolux::mc {

namespace {

/// The values in a narrower type if all fit and there is memory; else nothing.
template <class Narrow>
bool copy_narrow(const Volume& volume, const Run& run, const auto& convert, LargeVector<Narrow>& copy) {
  const auto values = volume.values.values();
  constexpr std::size_t kReadBeyond = 64;
  try {
    copy.resize(values.size() + kReadBeyond);
  } catch (const std::bad_alloc&) {
    return false;  // slower, but the same
  }
  std::atomic<bool> fit = true;
  parallel_blocks(values.size(), std::size_t(1) << 18, run, "", [&](const Block& block) {
    if (fit && !convert(&values[block.begin], block.end - block.begin, &copy[block.begin])) fit = false;
  });
  if (!fit) copy = {};
  return fit;
}

}  // namespace

void RowMarch::keep_bytes(const Volume& volume, const Run& run) {
  if (copy_narrow(volume, run, to_bytes, bytes_)) march_.bytes = bytes_.data();
}

void RowMarch::keep_shorts(const Volume& volume, const Run& run) {
  if (march_.bytes == nullptr && copy_narrow(volume, run, to_shorts, shorts_)) march_.shorts = shorts_.data();
}

}  // namespace isolux::mc
