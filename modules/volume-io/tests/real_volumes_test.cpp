#include "support.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

// Real volumes in the folder ISOLUX_DATA, where there is one: their sizes, spacings and ranges as published.
namespace isolux {
namespace {
using testing::HasSubstr;

struct Known {
  std::string file;
  std::string reader;
  Index3 size;
  ScalarType type;
  Vec3 spacing;
  float low;
  float high;
};

const std::vector<Known> kKnown = {
    {"neghip_64x64x64_uint8.raw", "raw", {64, 64, 64}, ScalarType::kUint8, {1, 1, 1}, 0, 255},
    {"nucleon_41x41x41_uint8.raw", "raw", {41, 41, 41}, ScalarType::kUint8, {1, 1, 1}, 0, 249},
    {"silicium_98x34x34_uint8.raw", "raw", {98, 34, 34}, ScalarType::kUint8, {1, 1, 1}, 0, 255},
    {"engine.nrrd", "nrrd", {256, 256, 128}, ScalarType::kUint8, {1, 1, 1}, 0, 255},
    {"hydrogen_f32.nrrd", "nrrd", {64, 64, 64}, ScalarType::kFloat32, {1, 1, 1}, 0, 1},
    {"frog.nrrd", "nrrd", {256, 256, 44}, ScalarType::kUint8, {0.5, 0.5, 1}, 0, 255},
    {"blunt_fin.nrrd", "nrrd", {256, 128, 64}, ScalarType::kUint8, {1, 0.75, 1}, 0, 253},
    {"headsq_quarter.nrrd", "nrrd", {64, 64, 93}, ScalarType::kInt16, {3.2, 3.2, 1.5}, 0, 3926},
    {"stent.nrrd", "nrrd", {128, 128, 256}, ScalarType::kInt16, {1, 1, 1}, 0, 2000},
    {"fetal_t2.nrrd", "nrrd", {117, 159, 126}, ScalarType::kFloat32, {0.86, 0.86, 0.86}, 0, 711},
    {"brain1_anisotropic.nrrd", "nrrd", {256, 256, 25}, ScalarType::kInt16, {0.78, 0.78, 6.5}, 0, 3057},
    {"ct_pitch.nii.gz", "nifti", {175, 248, 58}, ScalarType::kUint8, {0.81, 0.81, 2.4}, 0, 255},
    {"emd3197.map", "mrc", {20, 20, 20}, ScalarType::kFloat32, {11.4, 11.4, 11.4}, -4.1f, 5.6f},
    {"emd3001_permuted_axes.map", "mrc", {43, 25, 73}, ScalarType::kFloat32, {0.45, 0.39, 0.46}, -0.37f, 0.72f},
    {"ironprot.vtk", "vtk", {68, 68, 68}, ScalarType::kUint8, {1, 1, 1}, 0, 255},
    {"carotid_big_endian.vtk", "vtk", {76, 49, 45}, ScalarType::kFloat32, {1, 1, 1}, 0, 580},
};

std::string data_folder() {
  const char* folder = std::getenv("ISOLUX_DATA");
  return folder == nullptr ? "" : folder;
}

class RealVolumes : public testing::Test {
 protected:
  void SetUp() override {  // NOLINT(readability-identifier-naming): GoogleTest's name
    if (data_folder().empty()) GTEST_SKIP() << "ISOLUX_DATA names no folder";
  }
};

TEST_F(RealVolumes, HaveTheirKnownSizesSpacingsAndRanges) {
  for (const auto& known : kKnown) {
    const std::string path = data_folder() + "/" + known.file;
    if (!test::has_reader(known.reader) || !std::filesystem::exists(path)) continue;
    const Volume volume = read_volume(path);
    EXPECT_EQ(volume.lattice().size, known.size) << known.file;
    EXPECT_EQ(volume.stored_type, known.type) << known.file;
    const Vec3 spacing = volume.lattice().frame.spacing();
    // The table gives two or three digits.
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(spacing[a], known.spacing[a], 0.006) << known.file;
    EXPECT_NEAR(value_range(volume).low, known.low, 0.05) << known.file;
    EXPECT_NEAR(value_range(volume).high, known.high, 0.5) << known.file;
  }
}

TEST_F(RealVolumes, SlicesThatAreNotEvenlySpacedAreRefusedOrTakenAsTheCallerSays) {
  if (!test::has_reader("itk")) GTEST_SKIP() << "no ITK in this build";
  for (const auto* folder : {"/dicom_gantry_tilt", "/dicom_abdomen"}) {
    if (!std::filesystem::exists(data_folder() + folder)) continue;
    EXPECT_THAT(test::reading_error(data_folder() + folder), HasSubstr("not evenly spaced"));
  }
  if (!std::filesystem::exists(data_folder() + "/dicom_abdomen")) return;
  const Volume volume = read_volume(data_folder() + "/dicom_abdomen",
                                    {.raw = {}, .spacing = Vec3(0.78125, 0.78125, 1), .allow_external_data = false});
  EXPECT_EQ(volume.lattice().size, Index3(512, 512, 24));
  EXPECT_EQ(value_range(volume).low, -1000.0f);
  EXPECT_GT(value_range(volume).high, 1900.0f);
}

TEST_F(RealVolumes, SurviveTheWayThroughOurFiles) {
  const test::TemporaryFolder folder;
  for (const auto& known : kKnown) {
    const std::string path = data_folder() + "/" + known.file;
    if (!test::has_reader(known.reader) || !std::filesystem::exists(path)) continue;
    const Volume volume = read_volume(path);
    const std::string hash = volume_sha256(volume);
    write_volume(volume, folder.file("a.nrrd"));
    EXPECT_EQ(volume_sha256(read_volume(folder.file("a.nrrd"))), hash) << known.file;
    EXPECT_EQ(volume_sha256(read_stored_volume(path)), hash) << known.file;
  }
}

}  // namespace
}  // namespace isolux
