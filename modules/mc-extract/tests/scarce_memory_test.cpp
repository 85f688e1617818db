// What is made for speed alone must not fail for want of memory. Large arrays come from the aligned operator new, which
// is replaced here so that it can refuse them.
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <utility>

#include "fields.h"

namespace {
std::atomic<std::size_t> most = std::numeric_limits<std::size_t>::max();  ///< bytes that are given at once
std::atomic<int> refused = 0;
}  // namespace

void* operator new(std::size_t bytes, std::align_val_t alignment) {
  if (bytes > most) {
    ++refused;
    throw std::bad_alloc();
  }
  const auto step = std::size_t(alignment);
  if (void* memory = std::aligned_alloc(step, (bytes + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

namespace isolux {
namespace {

TEST(IsoExtractor, GoesOnWithoutANarrowCopy) {
  // 4.6 MB of bytes; bits, lists and the index take .6 at most, and the surface, a small cube's, next to nothing.
  const Volume volume = testing::sampled(Index3(180, 160, 160), {}, [](const Vec3& p) {
    return std::max({std::fabs(p.x - 90.0), std::fabs(p.y - 80.0), std::fabs(p.z - 80.0)}) < 7.0 ? 200.0 : 3.0;
  });
  const ExtractSettings settings{.isovalue = 100.0f};
  IndexedMesh expected;
  IsoExtractor(volume).extract(settings, {}, expected);
  EXPECT_GT(expected.triangles.size(), 1000U);
  using Index = IsoExtractor::Index;
  for (const auto& [index, copies] : {std::pair(Index::kBricksAndBytes, 1), {Index::kBricksAndShorts, 2}}) {
    refused = 0;
    most = std::size_t(4) << 20;
    IndexedMesh mesh;
    EXPECT_NO_THROW(IsoExtractor(volume, {}, index).extract(settings, {}, mesh));
    most = std::numeric_limits<std::size_t>::max();
    EXPECT_EQ(refused, copies);
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.normals, expected.normals);
    EXPECT_EQ(mesh.triangles, expected.triangles);
  }
}

}  // namespace
}  // namespace isolux
