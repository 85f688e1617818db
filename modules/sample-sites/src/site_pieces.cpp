#include "site_pieces.h"

#include <algorithm>
#include <utility>

namespace isolux {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Joins one array of all pieces, letting each go once it is copied.
template <class T>
std::vector<T> join(std::vector<Sites>& pieces, std::vector<T> Sites::*array) {
  if (pieces.size() == 1) return std::move(pieces.front().*array);
  std::size_t count = 0;
  for (const Sites& piece : pieces) count += (piece.*array).size();
  std::vector<T> all;
  all.reserve(count);
  for (Sites& piece : pieces) append(all, std::exchange(piece.*array, {}));
  return all;
}

}  // namespace

void SitePieces::append(const Sites& more) {
  if (pieces_.empty() || pieces_.back().size() + more.size() > kSitesAPiece) {
    const std::size_t room = std::max(kSitesAPiece, more.size());
    pieces_.emplace_back();
    pieces_.back().positions.reserve(room);
    pieces_.back().isovalues.reserve(room);
    pieces_.back().normals.reserve(room);
  }
  Sites& piece = pieces_.back();
  isolux::append(piece.positions, more.positions);
  isolux::append(piece.isovalues, more.isovalues);
  isolux::append(piece.normals, more.normals);
}

Sites SitePieces::joined() && {
  return {.positions = join(pieces_, &Sites::positions),
          .isovalues = join(pieces_, &Sites::isovalues),
          .normals = join(pieces_, &Sites::normals)};
}

}  // namespace isolux
