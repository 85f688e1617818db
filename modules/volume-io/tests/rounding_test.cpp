// What becomes of numbers that are no floats.
#include "samples.h"

#include <gmock/gmock.h>

#include <limits>

namespace isolux {
namespace {
using test::bytes_of;
using testing::ElementsAre;
using testing::HasSubstr;

class Rounding : public testing::Test {
 protected:
  template <class T>
  Volume read(std::string_view type, const std::vector<T>& values, double subtract = 0.0) const {
    ReadOptions options;
    options.subtract = subtract;
    return read_volume(folder_.write(fmt::format("a_{}x1x1_{}.raw", values.size(), type), bytes_of(values)), options);
  }
  /// Files of each, by what its numbers go through.
  std::vector<std::string> of_every_format() const {
    std::string text;
    for (int i = 0; i < 12; ++i) text += fmt::format("{} ", i);
    const std::string nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\nencoding: ";
    return {folder_.write("a.nii", test::nifti_sample()),
            folder_.write("a.mrc", test::mrc_sample()),
            folder_.write("a.vtk", test::vtk_header("ASCII") + text),
            folder_.write("b.vtk", test::vtk_header("BINARY") + bytes_of(test::ramp(), true)),
            folder_.write("a.nrrd", nrrd + "raw\n\n" + bytes_of(test::ramp())),
            folder_.write("b.nrrd", nrrd + "gzip\n\n" + test::gzipped(bytes_of(test::ramp()))),
            folder_.write("c.nrrd", nrrd + "text\n\n" + text),
            "gen:sphere:3"};
  }
  test::TemporaryFolder folder_;
};

TEST_F(Rounding, IsToldOfWhereANumberIsNoFloat) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(read<double>("float64", {0.0, -0.5, 0x1p100, nan, infinity, -infinity}).rounded);
  EXPECT_TRUE(read<double>("float64", {0.0, 0.1}).rounded);
  EXPECT_TRUE(read<double>("float64", {1e6 + 1e-3}).rounded);
  EXPECT_FALSE(read<std::int32_t>("int32", {0, 1 << 24, -(1 << 30), std::numeric_limits<int>::min()}).rounded);
  EXPECT_TRUE(read<std::int32_t>("int32", {0, (1 << 24) + 1}).rounded);
  EXPECT_TRUE(read<std::int32_t>("int32", {-(1 << 24) - 1}).rounded);
  EXPECT_FALSE(read<std::int64_t>("int64", {std::numeric_limits<std::int64_t>::min()}).rounded);
  EXPECT_TRUE(read<std::uint64_t>("uint64", {std::numeric_limits<std::uint64_t>::max()}).rounded);
  EXPECT_FALSE(read<float>("float32", {0.1f}).rounded);
  EXPECT_FALSE(read<std::uint16_t>("uint16", {65535}).rounded);
}

TEST_F(Rounding, IsToldOfInScaledValuesAndInText) {
  std::string scaled = test::nifti_sample();
  EXPECT_FALSE(read_volume(folder_.write("a.nii", scaled)).rounded);
  test::put<float>(scaled, 112, 0.1f);
  EXPECT_TRUE(read_volume(folder_.write("a.nii", scaled)).rounded);
  const std::string header = "NRRD0004\ntype: double\ndimension: 3\nsizes: 2 1 1\nencoding: text\n\n";
  EXPECT_FALSE(read_volume(folder_.write("a.nrrd", header + "1 .5")).rounded);
  EXPECT_TRUE(read_volume(folder_.write("a.nrrd", header + "1 .1")).rounded);
}

// Of 1e6 + 1e-3 a float holds nothing behind the point.
TEST_F(Rounding, LosesLessOfWhatAnOffsetIsTakenOff) {
  const double step = 0x1p-10;
  EXPECT_THAT(test::values_of(read<double>("float64", {1e6, 1e6 + step, 1e6 - step}, 1e6)),
              ElementsAre(0.0f, float(step), -float(step)));
  EXPECT_THAT(test::values_of(read<std::int64_t>("int64", {(1ll << 40) + 1, 1ll << 40}, 0x1p40)),
              ElementsAre(1.0f, 0.0f));
  const Volume bytes = read<std::uint8_t>("uint8", {3, 4}, 0.5);
  EXPECT_THAT(test::values_of(bytes), ElementsAre(2.5f, 3.5f));
  EXPECT_EQ(bytes.stored_type, ScalarType::kFloat32) << "2.5 is no byte";
}

TEST_F(Rounding, OffsetsAreTakenOffEveryFormat) {
  ReadOptions options;
  options.subtract = 100.0;
  for (const std::string& path : of_every_format()) {
    const std::vector<float> plain = test::values_of(read_volume(path));
    const std::vector<float> less = test::values_of(to_floats(read_stored_volume(path, options)));
    ASSERT_EQ(less.size(), plain.size()) << path;
    for (std::size_t i = 0; i < less.size(); ++i) EXPECT_EQ(less[i], float(double(plain[i]) - 100.0)) << path;
  }
}

TEST(Reading, RefusesOffsetsThatAreNoNumbers) {
  for (const double offset : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    ReadOptions options;
    options.subtract = offset;
    EXPECT_THROW((void)read_volume("gen:sphere:4", options), InvalidInput) << offset;
  }
}

TEST_F(Rounding, ValuesForNoneThatNoVoxelHasAreRemarked) {
  for (const std::string& path : of_every_format()) {
    ReadOptions options;
    EXPECT_TRUE(read_volume(path, options).remarks.empty()) << path;
    options.nodata = double(test::values_of(read_volume(path))[5]);
    EXPECT_TRUE(read_volume(path, options).remarks.empty()) << path;
    options.nodata = -9999.5;
    EXPECT_THAT(read_volume(path, options).remarks,
                ElementsAre(path + ": no voxel has the value -9999.5 that stands for none"));
    EXPECT_EQ(read_stored_volume(path, options).remarks.size(), 1u) << path;
  }
}

TEST(Reading, SaysHowFilesOfNoFormatAreRead) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::reading_error(folder.write("a.bin", "1234")), HasSubstr("--dims and --type read any other file"));
  EXPECT_THAT(test::reading_error(folder.write("a.bin.gz", test::gzipped("1234"))),
              HasSubstr("known are gzip of NIfTI (.nii.gz) and MRC"));
}

}  // namespace
}  // namespace isolux
