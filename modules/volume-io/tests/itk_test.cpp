#include "itk_fixture.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>

namespace isolux {
namespace {
using test::Itk;
using test::kSpaced;
using testing::HasSubstr;

TEST_F(Itk, ReadsNiftiInLps) {
  for (const bool big : {false, true}) {
    for (const bool gzip : {false, true}) {
      const std::string bytes = test::nifti_sample(big);
      const Volume volume =
          read_volume(folder_.write(gzip ? "a.nii.gz" : "a.nii", gzip ? test::gzipped(bytes) : bytes));
      expect_ramp(volume);
      EXPECT_EQ(volume.stored_type, ScalarType::kInt16);
      EXPECT_EQ(volume.space, "left-posterior-superior");
      const IndexToWorld& frame = volume.lattice().frame;
      // The sform is RAS: x and y change sign. ITK goes through float quaternions.
      EXPECT_LT(glm::distance(frame.world(Vec3(0)), Vec3(10, -20, 30)), 1e-5);
      EXPECT_LT(glm::distance(frame.world(Vec3(2, 1, 1)), Vec3(9, -22, 34)), 1e-5);
    }
  }
}

// ITK tells NIfTI, and whether it is compressed, by the name.
TEST_F(Itk, ReadsNiftiUnderAnyName) {
  const std::string bytes = test::nifti_sample();
  for (const std::string name : {"scan", "scan.bin", "scan.nii.gz", "scan.mha"})
    expect_ramp(read_volume(folder_.write(name, bytes)));
  for (const std::string name : {"packed", "packed.nii"})
    expect_ramp(read_volume(folder_.write(name, test::gzipped(bytes))));
  const test::TemporaryFolder names;
  setenv("TMPDIR", names.file(".").c_str(), 1);
  expect_ramp(read_volume(folder_.file("scan")));
  EXPECT_TRUE(std::filesystem::is_empty(names.file("."))) << "the other name goes again";
  setenv("TMPDIR", names.file("gone").c_str(), 1);
  EXPECT_THAT(test::reading_error(folder_.file("scan")), HasSubstr("scan: its name should end in .nii"));
  unsetenv("TMPDIR");
}

// What no content tells is judged by its name.
TEST_F(Itk, SaysOfABrokenFileWhatItsNamePromises) {
  EXPECT_THAT(refused("a.vtk", "a\nb"), HasSubstr("VTK"));
  EXPECT_THAT(refused("a.mha", "a\nb"), HasSubstr("MetaImage"));
  EXPECT_THAT(refused("a.tif", "a\nb", kSpaced), HasSubstr("TIFF"));
  EXPECT_THAT(refused("a.dcm", "a\nb"), HasSubstr("DICOM"));
  EXPECT_THAT(refused("a.nii", "a\nb"), HasSubstr("NIfTI"));
}

TEST_F(Itk, AppliesNiftiScaling) {
  std::string bytes = test::nifti_sample();
  test::put<float>(bytes, 112, 0.5f);
  test::put<float>(bytes, 116, 100.0f);
  const Volume volume = read_volume(folder_.write("a.nii", bytes));
  EXPECT_EQ(volume.values(2, 1, 1), 105.5f);
}

TEST_F(Itk, RefusesHostileNifti) {
  const auto with = [&](std::size_t offset, auto value) {
    std::string bytes = test::nifti_sample();
    test::put(bytes, offset, value);
    const std::string packed = test::gzipped(bytes);
    std::string message = refused("a.nii", bytes);
    EXPECT_FALSE(refused("b.nii.gz", packed).empty());
    return message;
  };
  const float nan = std::nanf("");
  EXPECT_THAT(refused("a.nii", test::nifti_sample().substr(0, 370)), HasSubstr("376 bytes expected, 370 found"));
  EXPECT_THAT(refused("a.nii.gz", test::gzipped(test::nifti_sample().substr(0, 370))),
              HasSubstr("376 bytes expected, 370 found"));
  const std::string packed = test::gzipped(test::nifti_sample());
  EXPECT_THAT(refused("a.nii.gz", packed.substr(0, packed.size() - 20)), HasSubstr("end early"));
  EXPECT_THAT(refused("a.nii", "nothing of the kind"), HasSubstr("no NIfTI file"));
  EXPECT_THAT(with(40, std::int16_t(9)), HasSubstr("allowed is 1 to 7"));
  EXPECT_THAT(with(42, std::int16_t(-3)), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(with(42, std::int16_t(32767)), HasSubstr("bytes expected"));
  EXPECT_THAT(with(70, std::int16_t(128)), HasSubstr("datatype 128"));
  EXPECT_THAT(with(72, std::int16_t(8)), HasSubstr("bitpix is 8"));
  EXPECT_THAT(with(80, 0.0f), HasSubstr("other than 0"));
  EXPECT_THAT(with(80, nan), HasSubstr("finite numbers"));
  EXPECT_THAT(with(108, nan), HasSubstr("vox_offset is nan"));
  EXPECT_THAT(with(108, 1e30f), HasSubstr("vox_offset"));
  EXPECT_THAT(with(108, 353.0f), HasSubstr("377 bytes expected"));
  EXPECT_THAT(with(112, nan), HasSubstr("intensity scaling"));
  EXPECT_THAT(with(280, nan), HasSubstr("the sform"));
}

TEST_F(Itk, RefusesATimeSeries) {
  std::string bytes = test::nifti_sample();
  test::put<std::int16_t>(bytes, 40, 4);
  test::put<std::int16_t>(bytes, 46, 1);
  test::put<std::int16_t>(bytes, 48, 2);
  EXPECT_THAT(refused("a.nii", bytes), HasSubstr("2 samples on axis 4"));
}

TEST_F(Itk, ReadsMetaImages) {
  const std::string data = test::bytes_of(test::ramp());
  (void)folder_.write("data.raw", data);
  (void)folder_.write("data.foreign", "header" + data);
  for (const auto& path : {folder_.write("a.mha", test::meta_header("LOCAL") + data),
                           folder_.write("a.mhd", test::meta_header("data.raw")),
                           folder_.write("b.mhd", test::meta_header("data.foreign", "HeaderSize = 6\n")),
                           folder_.write("c.mhd", test::meta_header("data.foreign", "HeaderSize = -1\n"))}) {
    const Volume volume = read_volume(path);
    expect_ramp(volume);
    // Rows of the TransformMatrix are the axes' directions.
    EXPECT_EQ(volume.lattice().frame.axes, Mat3(0, 0.5, 0, -2, 0, 0, 0, 0, 4)) << path;
    EXPECT_EQ(volume.lattice().frame.origin, Vec3(10, 20, 30));
  }
}

TEST_F(Itk, RefusesHostileMetaImages) {
  const std::string data = test::bytes_of(test::ramp());
  const auto edited = [&](const std::string& from, const std::string& to) {
    std::string bytes = test::meta_header("LOCAL") + data;
    bytes.replace(bytes.find(from), from.size(), to);
    return refused("a.mha", bytes);
  };
  (void)folder_.write("short.raw", "abc");
  EXPECT_THAT(refused("a.mha", test::meta_header("LOCAL") + data.substr(1)),
              HasSubstr("24 bytes of data expected, 23 found"));
  EXPECT_THAT(test::reading_error(folder_.write("a.mhd", test::meta_header("short.raw"))),
              HasSubstr("24 bytes of data expected, 3 found"));
  EXPECT_THAT(refused("a.mhd", test::meta_header("/etc/passwd")), HasSubstr("outside the header's folder"));
  EXPECT_THAT(refused("a.mhd", test::meta_header("../x")), HasSubstr("outside the header's folder"));
  EXPECT_THAT(refused("a.mhd", test::meta_header("LIST")), HasSubstr("LOCAL and the name of one file"));
  EXPECT_THAT(refused("a.mhd", test::meta_header("s%03d.raw 1 2 1")), HasSubstr("LOCAL and the name of one file"));
  EXPECT_THAT(refused("a.mha", test::meta_header("LOCAL", "CompressedData = True\n") + "junk"), HasSubstr("damaged"));
  EXPECT_THAT(edited("3 2 2", "3 2"), HasSubstr("3 numbers are needed"));
  EXPECT_THAT(edited("3 2 2", "3 2 -2"), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(edited("3 2 2", "4294967297 4294967297 4294967297"), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(edited("3 2 2", "2147483647 2147483647 2147483647"), HasSubstr("63 bits"));
  EXPECT_THAT(edited("0.5 2 4", "0 2 4"), HasSubstr("other than 0"));
  EXPECT_THAT(edited("0.5 2 4", "nan 2 4"), HasSubstr("finite numbers"));
  EXPECT_THAT(edited("0 1 0 -1 0 0 0 0 1", "0 0 0 0 0 0 0 0 0"), HasSubstr("span a volume"));
  EXPECT_THAT(edited("MET_SHORT", "MET_STRING"), HasSubstr("supported are MET_"));
  EXPECT_THAT(edited("NDims = 3", "NDims = 2"), HasSubstr("a volume has 3"));
  EXPECT_THAT(edited("BinaryData = True", "BinaryData = False"), HasSubstr("supported is True"));
  EXPECT_THAT(edited("Offset = 10 20 30", "DimSize = 3 2 2"), HasSubstr("given twice"));
  EXPECT_THAT(edited("Offset = 10 20 30", "ElementNumberOfChannels = 3"), HasSubstr("one number a voxel"));
  EXPECT_THAT(edited("ElementDataFile", "ElementData"), HasSubstr("not of the form"));
}

TEST_F(Itk, ReadsLegacyVtkInAsciiAndBinary) {
  std::string text;
  for (int i = 0; i < 12; ++i) text += fmt::format("{} ", i);
  for (const auto& path : {folder_.write("a.vtk", test::vtk_header("BINARY") + test::bytes_of(test::ramp(), true)),
                           folder_.write("b.vtk", test::vtk_header("ASCII") + text)}) {
    const Volume volume = read_volume(path);
    expect_ramp(volume);
    EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(0.5, 2, 4));
    EXPECT_EQ(volume.lattice().frame.origin, Vec3(10, 20, 30));
    EXPECT_EQ(volume.space, "3D-right-handed");
  }
}

TEST_F(Itk, RefusesHostileVtk) {
  const std::string data = test::bytes_of(test::ramp(), true);
  const auto edited = [&](const std::string& from, const std::string& to) {
    std::string bytes = test::vtk_header("BINARY") + data;
    bytes.replace(bytes.find(from), from.size(), to);
    return refused("a.vtk", bytes);
  };
  EXPECT_THAT(refused("a.vtk", test::vtk_header("BINARY") + data.substr(2)),
              HasSubstr("24 bytes of data expected, 22 found"));
  EXPECT_THAT(refused("a.vtk", test::vtk_header("ASCII") + "1 2 3"), HasSubstr("12 numbers of data expected, 3 found"));
  EXPECT_THAT(edited("3 2 2", "3 2 0"), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(edited("3 2 2", "2147483647 2147483647 2147483647"), HasSubstr("63 bits"));
  EXPECT_THAT(edited("0.5 2 4", "0 2 4"), HasSubstr("other than 0"));
  EXPECT_THAT(edited("10 20 30", "10 inf 30"), HasSubstr("finite numbers"));
  EXPECT_THAT(edited("POINT_DATA 12", "POINT_DATA 13"), HasSubstr("DIMENSIONS make 12"));
  EXPECT_THAT(edited("s short 1", "s short 3"), HasSubstr("one component"));
  EXPECT_THAT(edited("s short 1", "s bit 1"), HasSubstr("supported are"));
  EXPECT_THAT(edited("STRUCTURED_POINTS", "POLYDATA"), HasSubstr("supported is DATASET STRUCTURED_POINTS"));
  EXPECT_THAT(edited("BINARY", "PACKED"), HasSubstr("allowed are BINARY and ASCII"));
}

// ITK would take the first word that it cannot read, and all behind it, for 0.
TEST_F(Itk, RefusesVtkTextThatIsNoNumberOfItsType) {
  const auto with = [&](const std::string& type, const std::string& word) {
    std::string bytes = test::vtk_header("ASCII");
    bytes.replace(bytes.find("s short 1"), 9, "s " + type + " 1");
    return bytes + "0 1 2 " + word + " 4 5 6 7 8 9 10 11";
  };
  const auto expect_refused = [&](const std::string& type, const std::vector<std::string>& words, const char* name) {
    for (const std::string& word : words)
      EXPECT_THAT(refused("a.vtk", with(type, word)),
                  HasSubstr("'" + word + "', value 3 of the data, is no finite " + name));
  };
  expect_refused("float", {"abc", "1,5", "0x10", "1e39", "1e999", "nan", "+-3", "++3", "--3"}, "float32");
  expect_refused("double", {"1e999", "nan", "inf", "-inf"}, "float64");
  expect_refused("short", {"3.0", "3e2", "70000", "-32769", "++3", "+-3"}, "int16");
  expect_refused("unsigned_char", {"1.5", "300", "-1", "3."}, "uint8");
  expect_refused("long", {"9223372036854775808", "1e3"}, "int64");
  expect_ramp(read_volume(folder_.write("a.vtk", with("short", "3"))));
  expect_ramp(read_volume(folder_.write("a.vtk", with("int", "+3"))));
  expect_ramp(read_volume(folder_.write("a.vtk", with("unsigned_char", "3"))));
  expect_ramp(read_volume(folder_.write("a.vtk", with("double", "+3.0e0"))));
  EXPECT_EQ(read_volume(folder_.write("a.vtk", with("double", "1e-400"))).values.values()[3], 0.0f);
}

TEST_F(Itk, ReadsAStackOfTiffsInNumberOrder) {
  (void)folder_.write("s10.tif", test::tiff_sample(6));
  (void)folder_.write("s9.tif", test::tiff_sample(0));
  (void)folder_.write("notes.txt", "not a page");
  const Volume volume = read_volume(folder_.file("."), kSpaced);
  expect_ramp(volume);
  EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(0.5, 2, 4));
  EXPECT_THAT(test::reading_error(folder_.file(".")), HasSubstr("give --spacing"));
}

TEST_F(Itk, RefusesHostileTiff) {
  const auto with = [&](std::size_t offset, auto value) {
    std::string bytes = test::tiff_sample(0);
    test::put(bytes, offset, value);
    return refused("a.tif", bytes, kSpaced);
  };
  // Entries begin at byte 10, 12 bytes each, the value at 8 within.
  EXPECT_THAT(refused("a.tif", test::tiff_sample(0).substr(0, 130), kSpaced), HasSubstr("the file has 130"));
  EXPECT_THAT(refused("a.tif", test::tiff_sample(0).substr(0, 40), kSpaced), HasSubstr("the file has 40"));
  EXPECT_THAT(with(4, std::uint32_t(0)), HasSubstr("without a page"));
  EXPECT_THAT(with(4, std::uint32_t(4000000000u)), HasSubstr("the file has"));
  EXPECT_THAT(with(10 + 8, std::uint32_t(0)), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(with(10 + 8, std::uint16_t(60000)), HasSubstr("bytes expected, 12 found"));
  EXPECT_THAT(with(10 + 2 * 12 + 8, std::uint16_t(12)), HasSubstr("8, 16, 32 or 64 bits"));
  EXPECT_THAT(with(10 + 5 * 12 + 8, std::uint32_t(4000000000u)), HasSubstr("the file has"));
  EXPECT_THAT(with(10 + 5 * 12 + 4, std::uint32_t(4000000000u)), HasSubstr("more values than"));
  EXPECT_THAT(with(10 + 6 * 12 + 8, std::uint16_t(3)), HasSubstr("grey TIFF pages"));
  EXPECT_THAT(with(10 + 9 * 12, std::uint32_t(8)), HasSubstr("round in a circle"));
}

TEST_F(Itk, SaysWhatAFolderLacks) {
  EXPECT_THAT(test::reading_error(folder_.file(".")), HasSubstr("without DICOM slices"));
}

}  // namespace
}  // namespace isolux
