#include "samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace isolux {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class NrrdKinds : public ::testing::Test {
 protected:
  /// A file of bytes 0, 1, ... with these sizes and kinds.
  [[nodiscard]] std::string file(const std::string& sizes, const std::string& kinds, int count = 12) const {
    const auto axes = std::count(sizes.begin(), sizes.end(), ' ') + 1;
    std::string bytes(std::size_t(count), '\0');
    std::iota(bytes.begin(), bytes.end(), '\0');
    return folder_.write("a.nrrd", fmt::format("NRRD0004\ntype: uchar\nencoding: raw\ndimension: {}\nsizes: {}\n{}\n",
                                               axes, sizes, kinds.empty() ? "" : "kinds: " + kinds + "\n") +
                                       bytes);
  }
  test::TemporaryFolder folder_;
};

TEST_F(NrrdKinds, OfNumbersOfAVoxelAreRefused) {
  for (const std::string kind :
       {"vector", "Vector", "3-vector", "covariant-vector", "normal", "RGB-color", "HSV-color", "XYZ-color", "point",
        "list", "stub", "scalar", "3-gradient", "3D-masked-symmetric-matrix", "2D-matrix", "quaternion"}) {
    const std::string message = test::reading_error(file("3 2 2", kind + " domain domain"));
    EXPECT_THAT(message, HasSubstr("a.nrrd: axis 1 of 3 has 3 samples of the kind")) << kind;
    EXPECT_THAT(message, HasSubstr("a volume has 3 axes of space")) << kind;
  }
  EXPECT_THAT(test::reading_error(file("3 2 2 1", "vector domain domain domain")), HasSubstr("axis 1 of 4"));
  EXPECT_THAT(test::reading_error(file("2 3 1 2", "domain domain domain complex")),
              HasSubstr("axis 4 of 4 has 2 samples of the kind 'complex'"));
  EXPECT_THAT(test::reading_error(file("4 3 1", "RGBA-color domain domain")), HasSubstr("'rgba-color'"));
}

TEST_F(NrrdKinds, OfOneSampleAreLeftOutBeforeAxesOfSpace) {
  for (const auto& [sizes, kinds] : {std::pair("3 4 1 1", "domain domain domain vector"),
                                     {"1 3 4 1", "vector domain domain domain"},
                                     {"1 3 4 1", "time space space space"},
                                     {"3 1 4 1", "??? list none domain"}}) {
    const Volume volume = read_volume(file(sizes, kinds));
    EXPECT_EQ(volume.lattice().size, Index3(3, 4, 1)) << kinds;
    EXPECT_THAT(volume.remarks, IsEmpty()) << kinds;
  }
}

TEST_F(NrrdKinds, OfSpaceAndOfNothingAreRead) {
  for (const std::string kinds : {"", "domain space ???", "none none none", "depth width height"})
    EXPECT_EQ(read_volume(file("3 2 2", kinds)).lattice().size, Index3(3, 2, 2)) << kinds;
}

TEST_F(NrrdKinds, OfTimeAreNoSpaceWhereThereIsEnough) {
  EXPECT_THAT(test::reading_error(file("3 2 1 2", "domain domain domain time")),
              HasSubstr("axis 4 of 4 has 2 samples of the kind 'time'"));
  const Volume pictures = read_volume(file("3 2 2", "domain domain time"));
  EXPECT_EQ(pictures.lattice().size, Index3(3, 2, 2));
  EXPECT_THAT(pictures.remarks, ElementsAre(HasSubstr("a.nrrd: its axis of the kind 'time' is taken as one of space")));
  EXPECT_THAT(read_volume(file("3 4 1", "domain domain time")).remarks, IsEmpty());
  EXPECT_THAT(test::reading_error(file("3 2 2", "time time domain")),
              HasSubstr("axis 1 of 3 has 3 samples of the kind 'time'"));
  EXPECT_THAT(test::reading_error(file("3 1 4", "domain time time")), HasSubstr("axis 3 of 3 has 4 samples"));
  EXPECT_EQ(read_volume(file("3 2 2 1", "domain domain time time")).lattice().size, Index3(3, 2, 2));
}

}  // namespace
}  // namespace isolux
