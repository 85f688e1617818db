#include "itk_fixture.h"
#include "vti_of_vtk.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace isolux {
namespace {
using test::vti_sample;
using test::VtiParts;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Skipped where isolux is built without pugixml.
class Vti : public test::RampFile {
 protected:
  void SetUp() override {  // NOLINT(readability-identifier-naming): GoogleTest's name
    if (!test::has_reader("vti")) GTEST_SKIP() << "no pugixml in this build";
  }
  [[nodiscard]] Volume volume(const VtiParts& parts, const ReadOptions& options = {}) const {
    return read_volume(folder_.write("a.vti", vti_sample(parts)), options);
  }
  [[nodiscard]] static ReadOptions array(const std::string& name) {
    ReadOptions options;
    options.settings["vti"]["array"] = name;
    return options;
  }
};

TEST_F(Vti, IsReadAsVtkWritesIt) {
  for (const std::string& file :
       {test::kVtkText, test::kVtkBase64, test::kVtkBase64Wide, test::kVtkBase64Zlib, test::kVtkRaw, test::kVtkRawZlib,
        test::kVtkRawWideBigEndian, test::kVtkAppendedBase64, test::kVtkAppendedBase64ZlibWideBigEndian}) {
    const Volume volume = read_volume(folder_.write("a.vti", file));
    expect_ramp(volume);
    EXPECT_EQ(volume.stored_type, ScalarType::kInt16);
    EXPECT_EQ(volume.space, "3D-right-handed");
    EXPECT_THAT(volume.remarks, IsEmpty());
    // What vtkImageData::GetPoint says of points 0, 1 and 3.
    const IndexToWorld& frame = volume.lattice().frame;
    EXPECT_EQ(frame.origin, Vec3(12, 20.5, 46));
    EXPECT_EQ(frame.world({1, 0, 0}), Vec3(12, 21, 46));
    EXPECT_EQ(frame.world({0, 1, 0}), Vec3(10, 20.5, 46));
  }
}

TEST_F(Vti, IsReadInEachCode) {
  for (const bool big_endian : {false, true}) {
    for (const bool wide : {false, true}) {
      for (const std::size_t block : {0, 1, 5, 12, 24, 100}) {
        for (const bool base64 : {false, true}) {
          const std::string data =
              test::vti_coded(test::bytes_of(test::ramp(), big_endian), {big_endian, wide, block, base64});
          VtiParts parts;
          parts.file = fmt::format(R"(type="ImageData" version="2.2" byte_order="{}" header_type="{}"{})",
                                   big_endian ? "BigEndian" : "LittleEndian", wide ? "UInt64" : "UInt32",
                                   block > 0 ? R"( compressor="vtkZLibDataCompressor")" : "");
          parts.array = R"(type="Int16" Name="ramp" format="appended" offset="3")";
          parts.data = "";
          // Another array stands before it, and something behind it.
          parts.appended =
              fmt::format("\"{}\">\n _xyz{}{}", base64 ? "base64" : "raw", data, base64 ? "AAAA" : "</a>_");
          expect_ramp(volume(parts));
          if (!base64) continue;
          parts.array = R"(type="Int16" Name="ramp" format="binary")";
          parts.data = "\r\n" + data.substr(0, 7) + " \n\t" + data.substr(7) + "\n";
          parts.appended = "";
          expect_ramp(volume(parts));
        }
      }
    }
  }
}

TEST_F(Vti, IsReadInEachType) {
  const auto type = [&](const std::string& name, auto zero) {
    const auto values = test::ramp();
    const std::string bytes = test::bytes_of(std::vector<decltype(zero)>(values.begin(), values.end()));
    VtiParts parts;
    parts.array = fmt::format(R"(type="{}" Name="ramp" format="ascii")", name);
    expect_ramp(volume(parts));
    parts.array = fmt::format(R"(type="{}" Name="ramp" format="binary")", name);
    parts.data = test::vti_coded(bytes, {.base64 = true});
    const Volume read = volume(parts);
    expect_ramp(read);
    return read.stored_type;
  };
  EXPECT_EQ(type("Int8", std::int8_t{}), ScalarType::kInt8);
  EXPECT_EQ(type("UInt8", std::uint8_t{}), ScalarType::kUint8);
  EXPECT_EQ(type("Int16", std::int16_t{}), ScalarType::kInt16);
  EXPECT_EQ(type("UInt16", std::uint16_t{}), ScalarType::kUint16);
  EXPECT_EQ(type("Int32", std::int32_t{}), ScalarType::kInt32);
  EXPECT_EQ(type("UInt32", std::uint32_t{}), ScalarType::kUint32);
  EXPECT_EQ(type("Int64", std::int64_t{}), ScalarType::kInt64);
  EXPECT_EQ(type("UInt64", std::uint64_t{}), ScalarType::kUint64);
  EXPECT_EQ(type("Float32", float{}), ScalarType::kFloat32);
  EXPECT_EQ(type("Float64", double{}), ScalarType::kFloat64);
}

TEST_F(Vti, LiesWhereItsFirstIndicesAndDirectionSay) {
  VtiParts parts{.image = R"(WholeExtent="-4 -2 7 8 100 101" Origin="1 2 3" Spacing="0.5 2 4")",
                 .extent = "-4 -2 7 8 100 101"};
  EXPECT_EQ(volume(parts).lattice().frame.origin, Vec3(1 - 2, 2 + 14, 3 + 400));
  parts.image += R"( Direction="0 0 1 1 0 0 0 1 0")";
  const IndexToWorld frame = volume(parts).lattice().frame;
  EXPECT_EQ(frame.axes[0], Vec3(0, 0.5, 0));
  EXPECT_EQ(frame.axes[1], Vec3(0, 0, 2));
  EXPECT_EQ(frame.axes[2], Vec3(4, 0, 0));
  EXPECT_EQ(frame.origin, Vec3(1 + 400, 2 - 2, 3 + 14));
  const IndexToWorld bare = volume({.image = R"(WholeExtent="0 2 0 1 0 1")"}).lattice().frame;
  EXPECT_EQ(bare.origin, Vec3(0));
  EXPECT_EQ(bare.axes, Mat3(1));
}

TEST_F(Vti, HasAVoxelAtTheCentreOfEachCell) {
  const VtiParts parts{.image = R"(WholeExtent="2 5 0 2 -1 1" Origin="10 20 30" Spacing="0.5 2 4")",
                       .extent = "2 5 0 2 -1 1",
                       .section = "CellData"};
  const Volume read = volume(parts);
  expect_ramp(read);
  EXPECT_EQ(read.lattice().frame.origin, Vec3(10 + 1.25, 20 + 1, 30 - 2));
  EXPECT_EQ(read.lattice().frame.spacing(), Vec3(0.5, 2, 4));
  // An image of one layer of points has one layer of cells, in its plane.
  const Volume flat = volume({.image = R"(WholeExtent="0 4 0 3 6 6")", .extent = "0 4 0 3 6 6", .section = "CellData"});
  EXPECT_EQ(flat.lattice().size, Index3(4, 3, 1));
  EXPECT_EQ(flat.lattice().frame.origin, Vec3(0.5, 0.5, 6));
}

TEST_F(Vti, IsReadFromTheArrayThatIsActiveOrNamed) {
  const std::string rest = "1 1 1 1 1 1 1 1 1 1 1</DataArray>";
  const std::string a = R"(<DataArray type="UInt8" Name="a" format="ascii">1 )" + rest;
  const std::string b = R"(<DataArray type="Float32" Name="b&amp;" NumberOfComponents="1" format="ascii">2 )" + rest;
  const std::string v = R"(<DataArray type="Int8" Name="v" NumberOfComponents="3" format="ascii"></DataArray>)";
  const auto file = [&](const std::string& active, const std::string& more) {
    std::string bytes = vti_sample({.section = active, .more = more});
    const std::string first = R"(<DataArray type="Int16" Name="ramp")";
    return folder_.write("a.vti", bytes.replace(bytes.find(first), 0, v + a));
  };
  const auto first_value = [](const Volume& read) { return read.values.values()[0]; };
  const std::string all = file(R"(PointData Scalars="ramp" Vectors="v")", b);
  const Volume active = read_volume(all);
  expect_ramp(active);
  EXPECT_THAT(active.remarks,
              ElementsAre(HasSubstr("'ramp' is read, not 'v' (3 components), 'a', 'b&'; --set-reader")));
  EXPECT_EQ(first_value(read_volume(all, array("a"))), 1.0f);
  EXPECT_EQ(first_value(read_volume(all, array("b&"))), 2.0f);
  EXPECT_THAT(read_volume(all, array("b&")).remarks, IsEmpty()) << "whoever names one knows";
  EXPECT_THAT(test::reading_error(all, array("c")), HasSubstr("an array 'c' of one number a point or cell is needed"));
  EXPECT_THAT(test::reading_error(all, array("v")), HasSubstr("there is 'v' (3 components), 'a', 'ramp', 'b&'"));
  for (const std::string none : {"PointData", R"(PointData Scalars="v")", R"(PointData Scalars="nobody")"})
    EXPECT_EQ(first_value(read_volume(file(none, b))), 1.0f) << none;
}

TEST_F(Vti, IsReadFromPointsBeforeCellsAndNeverFromMarksOfGhosts) {
  const std::string ghosts =
      R"(<DataArray type="UInt8" Name="vtkGhostType" format="ascii">0 0 0 0 0 0 0 0 0 0 0 0</DataArray>)";
  std::string bytes = vti_sample();
  bytes.insert(bytes.find("<DataArray"), ghosts);
  bytes.insert(bytes.find("<PointData"),
               R"(<CellData><DataArray type="Int8" Name="c" format="ascii">8 9</DataArray></CellData>)");
  const Volume read = read_volume(folder_.write("a.vti", bytes));
  expect_ramp(read);
  EXPECT_THAT(read.remarks, ElementsAre(HasSubstr("not 'vtkGhostType', 'c' of cells")));
  const Volume cells = read_volume(folder_.file("a.vti"), array("c"));
  EXPECT_EQ(cells.lattice().size, Index3(2, 1, 1));
  EXPECT_THAT(test::values_of(cells), ElementsAre(8, 9));
}

TEST_F(Vti, IsPutTogetherFromPieces) {
  const auto piece = [](const std::string& extent, const std::vector<std::int16_t>& values) {
    return fmt::format(
        R"(<Piece Extent="{}"><PointData><DataArray type="Int16" Name="s" format="binary">{}</DataArray></PointData></Piece>)",
        extent, test::vti_coded(test::bytes_of(values), {.base64 = true}));
  };
  const auto file = [](const std::string& pieces) {
    return R"(<VTKFile type="ImageData" byte_order="LittleEndian"><ImageData WholeExtent="1 3 0 1 0 1">)" + pieces +
           "</ImageData></VTKFile>";
  };
  const std::string left = piece("1 2 0 1 0 1", {0, 1, 3, 4, 6, 7, 9, 10});
  const std::string right = piece("3 3 0 1 0 1", {2, 5, 8, 11});
  expect_ramp(read_volume(folder_.write("a.vti", file(left + right))));
  EXPECT_TRUE(std::holds_alternative<Grid<std::int16_t>>(read_stored_volume(folder_.file("a.vti")).values));
  // Neighbours share the points of their border.
  expect_ramp(read_volume(folder_.write("a.vti", file(left + piece("2 3 0 1 0 1", {1, 2, 4, 5, 7, 8, 10, 11})))));
  const std::string front = piece("1 3 0 0 0 1", {0, 1, 2, 6, 7, 8});
  expect_ramp(read_volume(folder_.write("a.vti", file(front + piece("1 3 1 1 0 1", {3, 4, 5, 9, 10, 11})))));
  EXPECT_THAT(refused("a.vti", file(front)), HasSubstr("leave out 6 of 12 values"));
  EXPECT_THAT(refused("a.vti", file(left)), HasSubstr("leave out 4 of 12 values"));
  EXPECT_THAT(
      refused("a.vti",
              R"(<VTKFile type="ImageData" byte_order="LittleEndian"><ImageData WholeExtent="0 999 0 999 0 99">)" +
                  piece("0 0 0 0 0 0", {7}) + "</ImageData></VTKFile>"),
      HasSubstr("leave out 99999999 of 100000000 values"));
  EXPECT_THAT(refused("a.vti", file(left + left)), HasSubstr("leave out 4 of 12 values"));
  EXPECT_THAT(refused("a.vti", file(piece("1 4 0 1 0 1", {1}))), HasSubstr("'1 4 0 1 0 1' of a Piece lies beyond"));
  std::string other = right;
  EXPECT_THAT(refused("a.vti", file(left + other.replace(other.find("Int16"), 5, "Int32"))),
              HasSubstr("several types"));
  other = right;
  EXPECT_THAT(refused("a.vti", file(left + other.replace(other.find("\"s\""), 3, "\"t\""))),
              HasSubstr("lacks the array 's'"));
}

TEST_F(Vti, IsToldByItsContent) {
  expect_ramp(read_volume(folder_.write("a.dat", vti_sample())));
  expect_ramp(
      read_volume(folder_.write("a.vti", "\xEF\xBB\xBF<?xml version=\"1.0\"?>\r\n<!-- c -->\r\n" + vti_sample())));
  for (const std::string type : {"StructuredGrid", "UnstructuredGrid", "PImageData"})
    EXPECT_THAT(refused("a.dat", vti_sample({.file = fmt::format("type=\"{}\"", type)})),
                HasSubstr("VTK XML of type '" + type + "': supported is ImageData"));
  EXPECT_THAT(refused("a.vti", "<?xml version=\"1.0\"?><svg></svg>"), HasSubstr("no VTK XML file"));
}

TEST_F(Vti, KeepsValuesThatAreNoNumbersAndTakesOffWhatIsAsked) {
  VtiParts parts{.array = R"(type="Float32" Name="ramp" format="ascii")", .data = "nan -inf 2 3 4 5 6 7 8 9 10 11"};
  const auto values = test::values_of(volume(parts));
  EXPECT_TRUE(std::isnan(values[0]) && std::isinf(values[1]));
  ReadOptions options;
  options.subtract = -5;
  options.nodata = 4;
  const auto changed = test::values_of(volume({}, options));
  EXPECT_EQ(changed[0], 5.0f);
  EXPECT_TRUE(std::isnan(changed[4]));
}

}  // namespace
}  // namespace isolux
