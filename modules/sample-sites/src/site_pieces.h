#pragma once

#include <isolux/core/sample_set.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// Sites of which nobody knows how many will come: kept in pieces, so that growing copies nothing, and joined with
/// hardly more memory than all of them take.
class SitePieces {
 public:
  void append(const Sites& more);
  [[nodiscard]] Sites joined() &&;

 private:
  /// Large enough that an allocator gives a piece back when it is let go.
  static constexpr std::size_t kSitesAPiece = 65536;

  std::vector<Sites> pieces_;
};

}  // namespace isolux
