// Sites kept in pieces: joined, they are all that came, in order.
#include <gtest/gtest.h>

#include <cstddef>

#include "site_pieces.h"

namespace isolux {
namespace {

/// Sites whose numbers are all that they hold.
Sites numbered(std::size_t first, std::size_t count) {
  Sites sites;
  for (std::size_t i = first; i < first + count; ++i) {
    sites.positions.emplace_back(float(i), 0.0f, 0.0f);
    sites.isovalues.push_back(float(i));
    sites.normals.emplace_back(0.0f, float(i), 0.0f);
  }
  return sites;
}

TEST(SitePieces, JoinToAllThatCameInOrder) {
  // More than fit into one piece, none at all, and more at once than a piece takes.
  SitePieces pieces;
  std::size_t count = 0;
  for (const std::size_t more : {1u, 50000u, 0u, 30000u, 100000u, 7u}) {
    pieces.append(numbered(count, more));
    count += more;
  }
  const Sites all = std::move(pieces).joined();
  const Sites expected = numbered(0, count);
  EXPECT_EQ(all.positions, expected.positions);
  EXPECT_EQ(all.isovalues, expected.isovalues);
  EXPECT_EQ(all.normals, expected.normals);
  EXPECT_EQ(SitePieces().joined().size(), 0u);
}

}  // namespace
}  // namespace isolux
