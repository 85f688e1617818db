#include "samples.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace isolux {
namespace {
using testing::HasSubstr;

TEST(Mrc, PutsPermutedAxesInOrder) {
  const test::TemporaryFolder folder;
  for (const bool big : {false, true}) {
    const Volume volume = read_volume(folder.write("a.map", test::mrc_sample(big)));
    // Sections run along x, columns along y, rows along z.
    ASSERT_EQ(volume.lattice().size, Index3(2, 3, 2));
    for (int x = 0; x < 2; ++x) {
      for (int y = 0; y < 3; ++y) {
        for (int z = 0; z < 2; ++z) EXPECT_EQ(volume.values(x, y, z), float(y + 3 * z + 6 * x));
      }
    }
    // Cell edges 2, 6, 8 over 2, 3, 2 intervals; columns start at 1 (y), rows at 5 (z).
    EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(1, 2, 4));
    EXPECT_EQ(volume.lattice().frame.origin, Vec3(0, 2, 20));
    EXPECT_EQ(volume.stored_type, ScalarType::kInt16);
  }
}

TEST(Mrc, PrefersTheOriginAndReadsObliqueCells) {
  const test::TemporaryFolder folder;
  std::string bytes = test::mrc_sample();
  test::put<float>(bytes, 196, 7.0f);
  test::put<float>(bytes, 56, 60.0f);
  const IndexToWorld frame = read_volume(folder.write("a.mrc", bytes)).lattice().frame;
  EXPECT_EQ(frame.origin, Vec3(7, 0, 0));
  // beta = 60 degrees between a and c; the file's float angle is exact.
  EXPECT_NEAR(glm::dot(glm::normalize(frame.axes[0]), glm::normalize(frame.axes[2])), 0.5, 1e-12);
  EXPECT_NEAR(glm::length(frame.axes[2]), 4.0, 1e-12);
}

TEST(Mrc, RefusesHostileHeadersInWords) {
  const test::TemporaryFolder folder;
  const auto refused = [&](std::size_t offset, auto value) {
    std::string bytes = test::mrc_sample();
    test::put(bytes, offset, value);
    return test::reading_error(folder.write("a.mrc", bytes));
  };
  const float nan = std::nanf("");
  EXPECT_THAT(refused(0, std::int32_t(-3)), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(refused(0, std::int32_t(2000000000)), HasSubstr("bytes"));
  EXPECT_THAT(refused(12, std::int32_t(4)), HasSubstr("MRC mode 4: supported are 0"));
  EXPECT_THAT(refused(28, std::int32_t(0)), HasSubstr("at least 1 is needed"));
  EXPECT_THAT(refused(40, 0.0f), HasSubstr("finite and above 0"));
  EXPECT_THAT(refused(40, nan), HasSubstr("finite and above 0"));
  EXPECT_THAT(refused(52, 180.0f), HasSubstr("below 180"));
  EXPECT_THAT(refused(52, 1e-3f), HasSubstr("span no volume"));
  EXPECT_THAT(refused(64, std::int32_t(3)), HasSubstr("permutation of 1, 2, 3"));
  EXPECT_THAT(refused(64, std::int32_t(0)), HasSubstr("permutation of 1, 2, 3"));
  EXPECT_THAT(refused(92, std::int32_t(-1)), HasSubstr("extended header of -1"));
  EXPECT_THAT(refused(92, std::int32_t(8)), HasSubstr("need 1056 bytes, 1048 found"));
  EXPECT_THAT(refused(196, nan), HasSubstr("origin is not finite"));
  EXPECT_THAT(refused(208, std::int32_t(0)), HasSubstr("'MAP' is missing"));
  EXPECT_THAT(test::reading_error(folder.write("b.mrc", test::mrc_sample().substr(0, 1030))), HasSubstr("1030 found"));
  EXPECT_THAT(test::reading_error(folder.write("c.mrc", "MAP")), HasSubstr("'MAP' is missing"));
}

}  // namespace
}  // namespace isolux
