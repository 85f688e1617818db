#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::vti_sample;
using test::VtiParts;
using ::testing::HasSubstr;

class RefusedVti : public test::RampFile {
 protected:
  void SetUp() override {  // NOLINT(readability-identifier-naming): GoogleTest's name
    if (!test::has_reader("vti")) GTEST_SKIP() << "no pugixml in this build";
  }
  [[nodiscard]] std::string edited(std::string bytes, const std::string& from, const std::string& to) const {
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refused("a.vti", bytes.replace(at, from.size(), to));
  }
  [[nodiscard]] std::string edited(const std::string& from, const std::string& to) const {
    return edited(vti_sample(), from, to);
  }
  /// A file with `bytes` as its appended data.
  [[nodiscard]] std::string appended(const std::string& bytes, bool compressed, bool wide = false) const {
    VtiParts parts;
    parts.file += wide ? R"( header_type="UInt64")" : "";
    parts.file += compressed ? R"( compressor="vtkZLibDataCompressor")" : "";
    parts.array = R"(type="Int16" Name="ramp" format="appended" offset="0")";
    parts.data = "";
    parts.appended = "\"raw\">_" + bytes;
    return refused("a.vti", vti_sample(parts));
  }
};

TEST_F(RefusedVti, NamesWhatItsHeaderLacksOrHasTooMuch) {
  EXPECT_THAT(edited("version=\"1.0\"", "version=\"3.0\""), HasSubstr("version '3.0': supported are 0.1 to 2.2"));
  EXPECT_THAT(edited("type=\"ImageData\" ", ""), HasSubstr("VTKFile has no 'type'"));
  EXPECT_THAT(edited("WholeExtent", "Extent"), HasSubstr("ImageData has no 'WholeExtent'"));
  EXPECT_THAT(edited("<Piece Extent", "<Piece Whole"), HasSubstr("Piece has no 'Extent'"));
  EXPECT_THAT(edited("type=\"Int16\"", "type=\"Bit\""),
              HasSubstr("one number a point or cell is needed; there is 'ramp' (type 'Bit')"));
  EXPECT_THAT(edited("type=\"Int16\"", "type=\"Int16\" NumberOfComponents=\"2\""), HasSubstr("'ramp' (2 components)"));
  EXPECT_THAT(edited("format=\"ascii\"", ""), HasSubstr("DataArray has no 'format'"));
  EXPECT_THAT(edited("format=\"ascii\"", "format=\"text\""), HasSubstr("supported are ascii, binary, appended"));
  EXPECT_THAT(edited("=\"0 2 0 1 0 1\" O", "=\"0 2 0 1 0 1.5\" O"), HasSubstr("whole numbers of 32 bits are needed"));
  EXPECT_THAT(edited("=\"0 2 0 1 0 1\" O", "=\"0 2 0 1 0 9999999999\" O"), HasSubstr("whole numbers of 32 bits"));
  EXPECT_THAT(edited("=\"0 2 0 1 0 1\" O", "=\"0 2 0 1 0\" O"), HasSubstr("6 numbers are needed"));
  EXPECT_THAT(edited("=\"0 2 0 1 0 1\" O", "=\"0 2 0 1 0 1 2\" O"), HasSubstr("6 numbers are needed"));
  EXPECT_THAT(refused("a.vti", vti_sample({.image = "WholeExtent=\"2 0 0 1 0 1\"", .extent = "2 0 0 1 0 1"})),
              HasSubstr("allowed is 1 to"));
  EXPECT_THAT(edited("0.5 2 4", "0.5 nan 4"), HasSubstr("finite numbers are needed"));
  EXPECT_THAT(edited("0.5 2 4", "0.5 0 4"), HasSubstr("other than 0"));
  EXPECT_THAT(edited("0.5 2 4", "0.5 x 4"), HasSubstr("Spacing is '0.5 x 4': 3 numbers are needed"));
  EXPECT_THAT(edited("10 20 30", "10 inf 30"), HasSubstr("Origin is 10 inf 30"));
  EXPECT_THAT(edited("Spacing=", "Direction=\"1 0 1 0 1 0 1 0 1\" Spacing="), HasSubstr("span no volume"));
  EXPECT_THAT(edited("Spacing=", "Direction=\"1 0 0 0 1\" Spacing="), HasSubstr("9 numbers are needed"));
}

TEST_F(RefusedVti, NamesWhatIsNoXml) {
  EXPECT_THAT(edited("</PointData>", "</Points>"), HasSubstr("no well-formed XML: Start-end tags mismatch at byte"));
  EXPECT_THAT(edited("WholeExtent=\"", "WholeExtent="), HasSubstr("no well-formed XML"));
  EXPECT_THAT(edited("</VTKFile>", ""), HasSubstr("'</VTKFile>' is missing at its end: the file is cut off"));
  EXPECT_THAT(edited("<ImageData ", "<Image "), HasSubstr("no well-formed XML"));
  EXPECT_THAT(refused("a.vti", "<VTKFile type=\"ImageData\"></VTKFile>"), HasSubstr("VTKFile has no 'ImageData'"));
  EXPECT_THAT(refused("a.vti", "<VTKFile type=\"ImageData\"><ImageData/></VTKFile>"),
              HasSubstr("ImageData has no 'Piece'"));
  EXPECT_THAT(edited("<PointData Scalars=\"ramp\">", "<PointData><a></a></PointData><PointData>"),
              HasSubstr("an array of one number a point or cell is needed; there is none"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(edited("<Piece", deep + "<Piece"), HasSubstr("no well-formed XML"));
}

TEST_F(RefusedVti, CountsTheNumbersOfItsText) {
  EXPECT_THAT(edited(" 11<", "<"), HasSubstr("12 numbers of data expected, 11 found"));
  EXPECT_THAT(edited(" 11<", " 11 12<"), HasSubstr("12 numbers of data expected, more found"));
  EXPECT_THAT(edited(" 11<", " 11.5<"), HasSubstr("'11.5', value 11 of the data, is no int16"));
  EXPECT_THAT(edited("0 1 2 3 4 5 6 7 8 9 10 11", ""), HasSubstr("DataArray 'ramp' has no data"));
  EXPECT_THAT(
      refused("a.vti", vti_sample({.image = "WholeExtent=\"0 999 0 999 0 999\"", .extent = "0 999 0 999 0 999"})),
      HasSubstr("1000000000 values of 2 bytes expected, more than a file of"));
}

TEST_F(RefusedVti, CountsTheBytesOfItsData) {
  const std::string data = test::bytes_of(test::ramp());
  const auto size = [](std::uint32_t bytes) { return test::bytes_of<std::uint32_t>({bytes}); };
  EXPECT_THAT(appended(size(22) + data, false), HasSubstr("24 bytes of data expected, their header says 22"));
  EXPECT_THAT(appended(size(24) + data, false, true), HasSubstr("24 bytes of data expected, their header says"));
  EXPECT_THAT(refused("a.vti", vti_sample({.array = R"(type="Int16" Name="ramp" format="appended" offset="0")"})),
              HasSubstr("there are no AppendedData"));
  const std::string raw = test::vti_raw_sample();
  EXPECT_THAT(edited(raw, "offset=\"0\"", "offset=\"-1\""), HasSubstr("offset '-1': a whole number is needed"));
  EXPECT_THAT(edited(raw, "offset=\"0\"", "offset=\"99999\""), HasSubstr("offset 99999 lies behind the file's end"));
  EXPECT_THAT(edited(raw, "offset=\"0\"", "offset=\"100\""), HasSubstr("the data end within"));
  EXPECT_THAT(edited(raw, "offset=\"0\"", ""), HasSubstr("DataArray has no 'offset'"));
  EXPECT_THAT(edited(raw, "\"raw\">_", "\"raw\">"), HasSubstr("AppendedData do not begin with '_'"));
  EXPECT_THAT(edited(raw, "\"raw\"", "\"hex\""), HasSubstr("encoding 'hex': supported are raw, base64"));
  EXPECT_THAT(edited(raw, "LittleEndian", "Middle"), HasSubstr("byte_order 'Middle'"));
  EXPECT_THAT(edited(raw, "byte_order=\"LittleEndian\"", ""), HasSubstr("VTKFile has no 'byte_order'"));
  EXPECT_THAT(edited(raw, "byte_order", "header_type=\"UInt16\" byte_order"), HasSubstr("header_type 'UInt16'"));
  EXPECT_THAT(edited(raw, "byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order"),
              HasSubstr("compressor 'vtkLZ4DataCompressor': supported is vtkZLibDataCompressor"));
}

TEST_F(RefusedVti, HasNoOtherLettersInBase64) {
  const std::string letters = test::vti_coded(test::bytes_of(test::ramp()), {.base64 = true});
  const auto with = [&](const std::string& text) {
    return refused("a.vti", vti_sample({.array = R"(type="Int16" Name="ramp" format="binary")", .data = text}));
  };
  EXPECT_THAT(with(letters.substr(0, 10) + "*" + letters.substr(11)), HasSubstr("'*' in base64 data"));
  EXPECT_THAT(with(letters.substr(0, 10)), HasSubstr("base64 data end within a group of letters"));
  EXPECT_THAT(with(letters.substr(0, 12)), HasSubstr("24 bytes expected, 5 found"));
  EXPECT_THAT(with("="), HasSubstr("'=' in base64 data"));
  EXPECT_THAT(with("AA=A" + letters), HasSubstr("'A' in base64 data"));
  EXPECT_THAT(with(letters + "AAAA"), HasSubstr("24 bytes of data expected, more found"));
}

TEST_F(RefusedVti, HoldsItsBlocksToTheirHeader) {
  const std::string data = test::bytes_of(test::ramp());
  const auto blocks = [](const std::vector<std::uint64_t>& header) { return test::bytes_of(header); };
  const std::string whole = test::vti_coded(data, {.wide = true, .block = 24});
  const std::uint64_t size = whole.size() - 32;
  const std::string stream = whole.substr(32);
  const std::uint64_t most = ~std::uint64_t(0);
  for (const auto& header : std::vector<std::vector<std::uint64_t>>{{0, 24, 0},
                                                                    {1, 0, 0},
                                                                    {2, 24, 0},
                                                                    {1, 25, 0},
                                                                    {1, 24, 25},
                                                                    {most, 24, 0},
                                                                    {most, most, most},
                                                                    {2, most, 25},
                                                                    {most / 2, 2, 26}})
    EXPECT_THAT(appended(blocks(header) + blocks({size}) + stream, true, true), HasSubstr("their header says"));
  // A million blocks may be right for the voxels; that many sizes are not there.
  EXPECT_THAT(appended(blocks({24, 1, 0, size}), true, true), HasSubstr("end within the header before them"));
  for (const std::uint64_t wrong : {std::uint64_t(0), size - 1, size + 1, most})
    EXPECT_THAT(appended(blocks({1, 24, 0, wrong}) + stream, true, true), HasSubstr("block 0 of the compressed data"));
  std::string damaged = stream;
  damaged.back() = char(damaged.back() ^ 1);
  EXPECT_THAT(appended(blocks({1, 24, 0, size}) + damaged, true, true), HasSubstr("incorrect data check"));
  const std::string shorter = test::vti_coded(data.substr(0, 22), {.wide = true, .block = 22});
  const std::string longer = test::vti_coded(data + data, {.wide = true, .block = 48});
  for (const std::string& other : {shorter, longer})
    EXPECT_THAT(appended(blocks({1, 24, 0, other.size() - 32}) + other.substr(32), true, true), HasSubstr("block 0"));
  // Sizes that deflate cannot reach are refused before memory is asked for.
  VtiParts bomb{.image = "WholeExtent=\"0 9999 0 9999 0 9999\"", .extent = "0 9999 0 9999 0 9999"};
  bomb.file += R"( compressor="vtkZLibDataCompressor")";
  bomb.array = R"(type="Int16" Name="ramp" format="binary")";
  EXPECT_THAT(refused("a.vti", vti_sample(bomb)), HasSubstr("1000000000000 values of 2 bytes expected, more than"));
}

}  // namespace
}  // namespace isolux
