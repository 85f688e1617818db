#include "samples.h"

#include <gmock/gmock.h>

#include <cmath>

namespace isolux {
namespace {
using testing::HasSubstr;

TEST(Npy, TheLastIndexIsXInCsOrder) {
  const test::TemporaryFolder folder;
  const Volume volume = read_volume(folder.write("a.npy", test::npy_sample("<i2", "(2, 2, 3)")));
  EXPECT_EQ(volume.lattice().size, Index3(3, 2, 2));
  EXPECT_EQ(volume.values(1, 0, 0), 1.0f);
  EXPECT_EQ(volume.values(0, 0, 1), 6.0f);
  EXPECT_EQ(volume.stored_type, ScalarType::kInt16);
  EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(1));
}

TEST(Npy, TheFirstIndexIsXInFortrans) {
  const test::TemporaryFolder folder;
  const Volume volume = read_volume(folder.write("a.npy", test::npy_sample("<i2", "(3, 2, 2)", true)));
  EXPECT_EQ(volume.lattice().size, Index3(3, 2, 2));
  EXPECT_EQ(volume.values(1, 0, 0), 1.0f);
}

TEST(Npy, ReadsEveryVersionTypeAndOrderOfBytes) {
  const test::TemporaryFolder folder;
  for (const int version : {1, 2, 3}) {
    const std::string header = test::npy_header("<i2", "(2, 2, 3)", false, version);
    EXPECT_EQ(read_volume(folder.write("a.npy", header + test::bytes_of(test::ramp()))).values(2, 1, 1), 11.0f);
  }
  const std::string big = test::npy_header(">f8", "(1, 1, 2)") + test::bytes_of<double>({0.5, -2.0}, true);
  EXPECT_EQ(read_volume(folder.write("b.npy", big)).values(1, 0, 0), -2.0f);
  const std::string bytes = test::npy_header("|u1", "(1, 1, 3)") + test::bytes_of<std::uint8_t>({1, 2, 255});
  EXPECT_EQ(read_volume(folder.write("c.npy", bytes)).values(2, 0, 0), 255.0f);
}

TEST(Npy, ReadsMasksAndHalves) {
  const test::TemporaryFolder folder;
  const std::string mask = test::npy_header("|b1", "(1, 1, 3)") + test::bytes_of<std::uint8_t>({1, 0, 1});
  const Volume of_mask = read_volume(folder.write("a.npy", mask));
  EXPECT_THAT(test::values_of(of_mask), ::testing::ElementsAre(1.0f, 0.0f, 1.0f));
  EXPECT_EQ(of_mask.stored_type, ScalarType::kUint8);
  for (const bool big : {false, true}) {
    const std::string halves = test::npy_header(big ? ">f2" : "<f2", "(1, 1, 4)") +
                               test::bytes_of<std::uint16_t>({0x3C00, 0xC100, 0x0001, 0x7C00}, big);
    const Volume volume = read_volume(folder.write("b.npy", halves));
    EXPECT_THAT(test::values_of(volume), ::testing::ElementsAre(1.0f, -2.5f, 0x1p-24f, HUGE_VALF));
    EXPECT_EQ(volume.stored_type, ScalarType::kFloat32);
  }
}

TEST(Npy, LeavesOutFurtherAxesOfOneSample) {
  const test::TemporaryFolder folder;
  for (const std::string shape :
       {"(1, 2, 2, 3)", "(2, 2, 3, 1)", "(2, 1, 2, 3)", "(1, 1, 2, 2, 3)", "(1, 2, 1, 2, 3, 1)"}) {
    const Volume volume = read_volume(folder.write("a.npy", test::npy_sample("<i2", shape)));
    EXPECT_EQ(volume.lattice().size, Index3(3, 2, 2)) << shape;
    EXPECT_EQ(volume.values(2, 1, 1), 11.0f) << shape;
  }
  EXPECT_EQ(read_volume(folder.write("a.npy", test::npy_sample("<i2", "(1, 4, 3, 1)"))).lattice().size, Index3(1, 3, 4))
      << "those in front before those at the end";
  EXPECT_EQ(read_volume(folder.write("a.npy", test::npy_sample("<i2", "(1, 4, 3)"))).lattice().size, Index3(3, 4, 1))
      << "no more than there must be";
}

TEST(Npy, RefusesWhatIsNoArrayOfThreeAxesOfNumbers) {
  const test::TemporaryFolder folder;
  const auto says = [&](const std::string& header) {
    return test::reading_error(folder.write("a.npy", header + test::bytes_of(test::ramp())), {});
  };
  EXPECT_THAT(says(test::npy_header("<i2", "(12,)")), HasSubstr("three axes"));
  EXPECT_THAT(says(test::npy_header("<i2", "(2, 2, 2, 2, 3)")), HasSubstr("three axes"));
  EXPECT_THAT(says(test::npy_header("<i2", "(1, 12)")), HasSubstr("three axes"));
  EXPECT_THAT(says(test::npy_header("<f16", "(2, 2, 3)")), HasSubstr("'<f16'"));
  EXPECT_THAT(says(test::npy_header("<c8", "(2, 2, 3)")), HasSubstr("'<c8'"));
  EXPECT_THAT(says(test::npy_header("", "(2, 2, 3)")), HasSubstr("''"));
  EXPECT_THAT(says(test::npy_header("<i2", "(0, 2, 3)")), HasSubstr("a.npy"));
  EXPECT_THAT(says(test::npy_header("<i2", "(99999999999999999999, 2, 3)")), HasSubstr("a.npy"));
  EXPECT_THAT(says(test::npy_header("<i2", "(3, 2, 3)")), HasSubstr("bytes"));
  EXPECT_THAT(says(test::npy_header("<i2", "(1, 2, 3)")), HasSubstr("a.npy"));
  EXPECT_THAT(says(test::npy_header("<i2", "(2, 2, 3)", false, 4)), HasSubstr("version 4"));
  EXPECT_THAT(test::reading_error(folder.write("b.npy", "none"), {}), HasSubstr("b.npy"));
}

}  // namespace
}  // namespace isolux
