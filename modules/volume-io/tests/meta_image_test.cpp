#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::Itk;
using ::testing::HasSubstr;

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

TEST_F(Itk, ReadsMetaImagesWithSignedNumbers) {
  std::string bytes = test::meta_header("LOCAL") + test::bytes_of(test::ramp());
  bytes.replace(bytes.find("10 20 30"), 8, "+10 -20 +3e1");
  bytes.replace(bytes.find("0.5 2 4"), 7, "+.5 +2 4");
  const IndexToWorld frame = read_volume(folder_.write("a.mha", bytes)).lattice().frame;
  EXPECT_EQ(frame.origin, Vec3(10, -20, 30));
  EXPECT_EQ(frame.spacing(), Vec3(0.5, 2, 4));
}

// A parenthesis is a letter like others, also one without its partner.
TEST_F(Itk, ReadsMetaImagesWithParenthesesInTheirTexts) {
  (void)folder_.write("data (1 2).raw", test::bytes_of(test::ramp()));
  expect_ramp(read_volume(folder_.write("a.mhd", test::meta_header("data (1 2).raw"))));
  expect_ramp(read_volume(folder_.write("b.mhd", test::meta_header("data (1 2).raw", "Comment = a ) (\n"))));
}

TEST_F(Itk, RefusesMetaImagesInWordsThatCanBeShown) {
  std::string bytes = test::meta_header("LOCAL");
  bytes.replace(bytes.find("MET_SHORT"), 9, "\x01\xFF" + std::string(5000, 'x'));
  const std::string message = refused("a.mha", bytes);
  EXPECT_THAT(message, HasSubstr("'ElementType = ??xxx"));
  EXPECT_LT(message.size(), 400u);
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
  EXPECT_THAT(edited("NDims = 3\n", ""), HasSubstr("a volume has 3"));
  EXPECT_THAT(edited("BinaryData = True", "HeaderSize = 7"), HasSubstr("allowed beside ElementDataFile = LOCAL"));
  EXPECT_THAT(edited("BinaryData = True", "ElementByteOrderMSB = True"),
              HasSubstr("ElementByteOrderMSB = True says otherwise"));
  EXPECT_THAT(edited("MSB = False", "MSB = Yes"), HasSubstr("allowed are True and False"));
  EXPECT_THAT(edited("BinaryData = True", "ElementToIntensityFunctionSlope = 0"), HasSubstr("other than 0"));
  EXPECT_THAT(edited("BinaryData = True", "Comment = " + std::string(255, 'x')), HasSubstr("255 letters"));
  EXPECT_THAT(edited("ObjectType = Image\nNDims = 3\n", "ObjectType = Image\nDimSize = 3 2 2\nNDims = 3\n"),
              HasSubstr("given twice"));
  std::string late = test::meta_header("LOCAL") + data;
  late.replace(late.find("NDims = 3\n"), 10, "");
  late.replace(late.find("ElementType"), 0, "NDims = 3\n");
  EXPECT_THAT(refused("a.mha", late), HasSubstr("NDims has to stand before it"));
}

// MetaIO takes CompressedDataSize, which many files lack, for what is there, and what it cannot inflate for zeros.
TEST_F(Itk, ReadsCompressedMetaImagesWhateverTheySayOfTheirSize) {
  const std::string packed = test::gzipped(test::bytes_of(test::ramp()));
  for (const std::string size : {"", "CompressedDataSize = 0\n", "CompressedDataSize = 5\n",
                                 "CompressedDataSize = -1\n", "CompressedDataSize = 1000000000000000000\n"}) {
    const std::string fields = "CompressedData = True\n" + size;
    expect_ramp(read_volume(folder_.write("a.mha", test::meta_header("LOCAL", fields) + packed)));
    (void)folder_.write("data.gz", "header" + packed);
    expect_ramp(read_volume(folder_.write("a.mhd", test::meta_header("data.gz", fields + "HeaderSize = 6\n"))));
  }
  const std::string fields = "CompressedData = True\n";
  EXPECT_THAT(refused("a.mhd", test::meta_header("data.gz", fields + "HeaderSize = -1\n")),
              HasSubstr("allowed of compressed data"));
  EXPECT_THAT(refused("a.mha", test::meta_header("LOCAL", fields) + test::gzipped("123")),
              HasSubstr("24 bytes expected, 3 found"));
  EXPECT_THAT(refused("a.mha", test::meta_header("LOCAL", fields) + test::gzipped(std::string(25, 'x'))),
              HasSubstr("24 bytes of data expected, more found"));
}

TEST_F(Itk, ReadsMetaImagesOfEitherByteOrder) {
  for (const std::string key : {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}) {
    for (const std::string word : {"True", "TRUE", "1"}) {
      std::string bytes = test::meta_header("LOCAL") + test::bytes_of(test::ramp(), true);
      const std::string before = "BinaryDataByteOrderMSB = False";
      bytes.replace(bytes.find(before), before.size(), key + " = " + word);
      expect_ramp(read_volume(folder_.write("a.mha", bytes)));
    }
  }
}

TEST_F(Itk, AppliesTheIntensityFunctionOfMetaImages) {
  const std::string fields = "ElementToIntensityFunctionSlope = 0.5\nElementToIntensityFunctionOffset = 100\n";
  const StoredVolume volume =
      read_stored_volume(folder_.write("a.mha", test::meta_header("LOCAL", fields) + test::bytes_of(test::ramp())));
  EXPECT_EQ(volume.stored_type, ScalarType::kFloat32);
  EXPECT_EQ(std::get<Grid<float>>(volume.values)(2, 1, 1), 105.5f);
}

}  // namespace
}  // namespace isolux
