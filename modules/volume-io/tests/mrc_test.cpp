#include "samples.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

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

// A stack lies in the file as a volume does (MRC2014): only the header tells.
TEST(Mrc, RefusesStacksOfVolumesAndOfImages) {
  const test::TemporaryFolder folder;
  const auto with = [&](std::int32_t group, std::int32_t of_each) {
    std::string bytes = test::mrc_sample();
    test::put(bytes, 36, of_each);
    test::put(bytes, 88, group);
    return folder.write("a.mrc", bytes);
  };
  EXPECT_THAT(test::reading_error(with(401, 1)),
              HasSubstr("a.mrc: a stack of 2 volumes (ISPG 401): --set-reader mrc.frame=K"));
  EXPECT_THAT(test::reading_error(with(0, 1)), HasSubstr("a.mrc: a stack of 2 images (ISPG 0, MZ 1)"));
  ReadOptions spaced;
  spaced.spacing = Vec3(1, 2, 3);
  EXPECT_EQ(read_volume(with(0, 1), spaced).lattice().frame.spacing(), Vec3(1, 2, 3));
  // Many programs call volumes images, crystals may fill several cells, and a stack may have one volume.
  for (const auto& [group, of_each] : {std::pair(0, 2), {1, 2}, {1, 1}, {19, 1}, {401, 2}})
    EXPECT_EQ(test::reading_error(with(group, of_each)), "") << group << " " << of_each;
}

// The sample with other voxels in the mode.
std::string with_mode(std::int32_t mode, const std::string& data) {
  std::string bytes = test::mrc_sample().substr(0, 1024);
  test::put(bytes, 12, mode);
  return bytes + data;
}

TEST(Mrc, TellsBytesWithASignFromThoseWithout) {
  const test::TemporaryFolder folder;
  const std::string data("\xFA\0\1\2\3\4\5\6\7\x8\x9\xA", 12);
  const auto first = [&](const std::string& bytes, std::size_t remarks = 0) {
    const Volume volume = read_volume(folder.write("a.mrc", bytes));
    EXPECT_EQ(volume.remarks.size(), remarks);
    return volume.values.values()[0];
  };
  std::string bytes = with_mode(0, data);
  EXPECT_EQ(first(bytes), -6.0f);
  test::put(bytes, 80, 250.0f);
  EXPECT_EQ(first(bytes, 1), 250.0f) << "no signed byte is 250, the largest value by the header";
  test::put(bytes, 152, std::int32_t(1146047817));  // IMOD's stamp
  EXPECT_EQ(first(bytes), 250.0f);
  test::put(bytes, 156, std::int32_t(1));
  EXPECT_EQ(first(bytes), -6.0f);
}

TEST(Mrc, ReadsHalfFloats) {
  const test::TemporaryFolder folder;
  const std::vector<std::uint16_t> halves = {0x3C00, 0xC000, 0x7BFF, 0x0400, 0x0001, 0x8000,
                                             0x3555, 0x7C00, 0xFC00, 0x7E00, 0x0000, 0x4248};
  for (const bool big : {false, true}) {
    std::string bytes = test::mrc_sample(big).substr(0, 1024);
    test::put<std::int32_t>(bytes, 12, 12, big);
    for (std::int32_t axis = 0; axis < 3; ++axis)
      test::put<std::int32_t>(bytes, 64 + 4 * std::size_t(axis), axis + 1, big);
    const Volume volume = read_volume(folder.write("a.mrc", bytes + test::bytes_of(halves, big)));
    const std::vector<float> values = test::values_of(volume);
    EXPECT_EQ(volume.stored_type, ScalarType::kFloat32);
    EXPECT_EQ(std::vector(values.begin(), values.begin() + 6),
              (std::vector<float>{1.0f, -2.0f, 65504.0f, 0x1p-14f, 0x1p-24f, -0.0f}));
    EXPECT_EQ(values[6], 0x1.554p-2f);
    EXPECT_EQ(values[7], std::numeric_limits<float>::infinity());
    EXPECT_EQ(values[8], -std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(values[9]));
  }
}

TEST(Mrc, IsReadOutOfGzip) {
  const test::TemporaryFolder folder;
  const std::string plain = test::mrc_sample();
  const Volume expected = read_volume(folder.write("a.mrc", plain));
  for (const char* name : {"b.mrc.gz", "b.map.gz", "b"}) {
    const Volume volume = read_volume(folder.write(name, test::gzipped(plain)));
    EXPECT_EQ(volume_sha256(volume), volume_sha256(expected));
  }
  const auto refused = [&](const std::string& bytes) { return test::reading_error(folder.write("c.mrc.gz", bytes)); };
  EXPECT_THAT(refused(test::gzipped(plain.substr(0, 1040))), HasSubstr("24 bytes expected, 16 found"));
  EXPECT_THAT(refused(test::gzipped(plain + "more")), HasSubstr("more found"));
  EXPECT_THAT(refused(test::gzipped("MAP")), HasSubstr("'MAP' is missing"));
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
