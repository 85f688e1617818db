#include "samples.h"

#include <gmock/gmock.h>

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

TEST(Npy, RefusesWhatIsNoArrayOfThreeAxesOfNumbers) {
  const test::TemporaryFolder folder;
  const auto says = [&](const std::string& header) {
    return test::reading_error(folder.write("a.npy", header + test::bytes_of(test::ramp())), {});
  };
  EXPECT_THAT(says(test::npy_header("<i2", "(12,)")), HasSubstr("three axes"));
  EXPECT_THAT(says(test::npy_header("<i2", "(1, 2, 2, 3)")), HasSubstr("three axes"));
  EXPECT_THAT(says(test::npy_header("<f2", "(2, 2, 3)")), HasSubstr("'<f2'"));
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
