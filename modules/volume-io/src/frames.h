#pragma once

#include "byte_source.h"

#include <isolux/core/options.h>

#include <cstdint>
#include <memory>
#include <string>

namespace isolux::detail {

/// Which of the volumes of a file is read: their values take turns, `together` of one before those of the next.
struct Frames {
  std::uint64_t count = 1;
  std::uint64_t together = 0;
  std::uint64_t wanted = 0;  ///< counted from 0

  /// Whether the value of this place among all of them is of the one that is read.
  [[nodiscard]] bool has(std::uint64_t value) const { return count == 1 || value / together % count == wanted; }
};

/// The option of readers of such files.
struct FrameOptions {
  int frame = -1;
  void describe(OptionVisitor& option);
};

/// \throw InvalidInput naming `path` and what is allowed: a file of several volumes, with `frame` below 0, or one
/// beyond them; `reader` is the backend's name and `what` what the file calls them
[[nodiscard]] std::uint64_t wanted_frame(const std::string& path, const std::string& reader, int frame,
                                         std::uint64_t count, const std::string& what);

/// The bytes of one of the volumes, of `values` values each, and what follows behind them all; the others' are read and
/// dropped. \pre frames.together divides `values`
[[nodiscard]] std::unique_ptr<ByteSource> frame_source(std::unique_ptr<ByteSource> source, const Frames& frames,
                                                       std::uint64_t values, std::size_t bytes_per_value);

}  // namespace isolux::detail
