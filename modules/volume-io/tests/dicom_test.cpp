#include "itk_fixture.h"

#include <isolux/core/error.h>
#include <glm/geometric.hpp>

namespace isolux {
namespace {
using test::Itk;
using test::kSpaced;
using testing::HasSubstr;

TEST_F(Itk, StacksDicomSlicesByPosition) {
  // File names and instance numbers run against the positions.
  (void)folder_.write("a.dcm",
                      test::dicom_sample({.position = "10\\20\\34", .series = "1.2.3", .instance = "1", .first = 6}));
  (void)folder_.write("b.dcm",
                      test::dicom_sample({.position = "10\\20\\30", .series = "1.2.3", .instance = "2", .first = 0}));
  const Volume volume = read_volume(folder_.file("."));
  // The rescale intercept of -1000 is applied.
  expect_ramp(volume, -1000.0f);
  EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(0.5, 2, 4));
  EXPECT_EQ(volume.lattice().frame.origin, Vec3(10, 20, 30));
  EXPECT_EQ(volume.space, "left-posterior-superior");
}

TEST_F(Itk, ReadsATiltedGantryAsAnObliqueAxis) {
  (void)folder_.write("a", test::dicom_sample({.position = "10\\20\\30", .series = "1", .instance = "1", .first = 0}));
  (void)folder_.write("b", test::dicom_sample({.position = "10\\21\\34", .series = "1", .instance = "2", .first = 6}));
  const Volume volume = read_volume(folder_.file("."));
  expect_ramp(volume, -1000.0f);
  EXPECT_EQ(volume.lattice().frame.axes[2], Vec3(0, 1, 4));
  // The caller says how far slices are apart, not which way they lie.
  const Volume spaced = read_volume(folder_.file("."), kSpaced);
  EXPECT_LT(glm::distance(spaced.lattice().frame.axes[2], 4.0 * glm::normalize(Vec3(0, 1, 4))), 1e-12);
}

// What moves in its own plane has no direction from slice to slice.
TEST_F(Itk, StacksSlicesOfOnePlaceAlongTheirNormal) {
  (void)folder_.write("a", test::dicom_sample({.position = "10\\20\\30", .series = "1", .instance = "1", .first = 0}));
  (void)folder_.write("b",
                      test::dicom_sample({.position = "13\\20\\30.001", .series = "1", .instance = "2", .first = 6}));
  EXPECT_EQ(read_volume(folder_.file("."), kSpaced).lattice().frame.axes[2], Vec3(0, 0, 4));
}

TEST_F(Itk, RefusesUnevenMixedAndBrokenDicomFolders) {
  const auto slice = [&](const std::string& name, const std::string& position, const std::string& series = "1") {
    (void)folder_.write(name,
                        test::dicom_sample({.position = position, .series = series, .instance = name, .first = 0}));
  };
  const auto read = [&](const ReadOptions& options = {}) { return test::reading_error(folder_.file("."), options); };
  slice("1", "10\\20\\30");
  slice("2", "10\\20\\34");
  slice("3", "10\\20\\39");
  EXPECT_THAT(read(), HasSubstr("not evenly spaced"));
  EXPECT_EQ(read(kSpaced), "") << "the caller's spacing overrules";
  slice("3", "10\\20\\34");
  EXPECT_THAT(read(), HasSubstr("not evenly spaced"));
  slice("3", "10\\20\\38", "2");
  EXPECT_THAT(read(), testing::AllOf(HasSubstr("2 DICOM series"), HasSubstr("1, 2")));
  EXPECT_THROW((void)read_volume(folder_.file(".")), InvalidInput) << "the child's exception, by its type";
  slice("3", "10\\20\\38");
  EXPECT_EQ(read(), "");
  const std::string whole = test::read_file(folder_.file("3"));
  (void)folder_.write("3", whole.substr(0, whole.size() - 1));
  EXPECT_THAT(read(), HasSubstr("12 bytes of pixel data expected, 11 found"));
  (void)folder_.write("3", whole.substr(0, 300));
  EXPECT_THAT(read(), testing::AnyOf(HasSubstr("ends early"), HasSubstr("the file has 300")));
}

// GDCM takes seconds and gigabytes for it.
TEST_F(Itk, RefusesDicomPixelsThatAreLongerThanTheFile) {
  for (const std::uint32_t length : {0xFFFFFFFEu, 0xFFFFFFFFu, 14u}) {
    std::string bytes = test::dicom_sample({});
    test::put(bytes, bytes.size() - 16, length);
    EXPECT_THAT(refused("a.dcm", bytes), HasSubstr(fmt::format("pixel data of {} bytes, the file has 12", length)));
  }
}

}  // namespace
}  // namespace isolux
