#include "itk_fixture.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace isolux {
namespace {
using ::testing::HasSubstr;

class LegacyVtk : public test::RampFile {};

TEST_F(LegacyVtk, IsReadAsTextAndBinary) {
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

// Names and titles may be words of the format, and lines of the geometry stand in any order.
TEST_F(LegacyVtk, IsReadWhateverItsNamesAndOrder) {
  const auto edited = [&](const std::string& from, const std::string& to) {
    std::string bytes = test::vtk_header("BINARY") + test::bytes_of(test::ramp(), true);
    bytes.replace(bytes.find(from), from.size(), to);
    return folder_.write("a.vtk", bytes);
  };
  for (const std::string name : {"color_scalars", "vectors", "tensors", "float", "lookup_table"}) {
    const Volume volume = read_volume(edited("SCALARS s", "SCALARS " + name));
    expect_ramp(volume);
    EXPECT_EQ(volume.stored_type, ScalarType::kInt16) << name;
  }
  for (const std::string title : {"", "ASCII", "DIMENSIONS 9 9 9"}) expect_ramp(read_volume(edited("title", title)));
  const Volume volume = read_volume(edited("DIMENSIONS 3 2 2\nSPACING 0.5 2 4\nORIGIN 10 20 30\nPOINT_DATA 12\n",
                                           "ORIGIN 10 20 30\nPOINT_DATA 12\nSPACING 0.5 2 4\nDIMENSIONS 3 2 2\n"));
  expect_ramp(volume);
  EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(0.5, 2, 4));
  EXPECT_EQ(volume.lattice().frame.origin, Vec3(10, 20, 30));
}

// As VTK reads it, which lowers all words.
TEST_F(LegacyVtk, IsReadInAnyCase) {
  std::string header = test::vtk_header("BINARY");
  const std::size_t words = header.find("BINARY");
  std::transform(header.begin() + std::ptrdiff_t(words), header.end(), header.begin() + std::ptrdiff_t(words),
                 [](unsigned char c) { return char(std::tolower(c)); });
  expect_ramp(read_volume(folder_.write("a.vtk", header + test::bytes_of(test::ramp(), true))));
  header.replace(header.find("short"), 5, "Short");
  header.replace(header.find("dimensions"), 10, "Dimensions");
  expect_ramp(read_volume(folder_.write("a.vtk", header + test::bytes_of(test::ramp(), true))));
}

TEST_F(LegacyVtk, IsReadInEachTypeOfC) {
  const auto type = [&](const std::string& name, const std::string& data) {
    std::string header = test::vtk_header("BINARY");
    header.replace(header.find("short"), 5, name);
    const Volume volume = read_volume(folder_.write("a.vtk", header + data));
    expect_ramp(volume);
    return volume.stored_type;
  };
  const auto ramp_of = [](auto zero) {
    const auto values = test::ramp();
    return test::bytes_of(std::vector<decltype(zero)>(values.begin(), values.end()), true);
  };
  EXPECT_EQ(type("signed_char", ramp_of(std::int8_t{})), ScalarType::kInt8);
  EXPECT_EQ(type("long_long", ramp_of(std::int64_t{})), ScalarType::kInt64);
  EXPECT_EQ(type("unsigned_long_long", ramp_of(std::uint64_t{})), ScalarType::kUint64);
  EXPECT_EQ(type("vtkIdType", ramp_of(std::int32_t{})), ScalarType::kInt32) << "as VTK writes it";
  EXPECT_EQ(type("vtkTypeUInt64", ramp_of(std::uint64_t{})), ScalarType::kUint64);
}

TEST_F(LegacyVtk, IsPlacedByNumbersWithASign) {
  std::string bytes = test::vtk_header("BINARY") + test::bytes_of(test::ramp(), true);
  bytes.replace(bytes.find("10 20 30"), 8, "+10 -20 3E1");
  bytes.replace(bytes.find("0.5 2 4"), 7, "+.5 +2 4");
  const IndexToWorld frame = read_volume(folder_.write("a.vtk", bytes)).lattice().frame;
  EXPECT_EQ(frame.origin, Vec3(10, -20, 30));
  EXPECT_EQ(frame.spacing(), Vec3(0.5, 2, 4));
}

TEST_F(LegacyVtk, IsRefusedInWordsThatCanBeShown) {
  std::string bytes = test::vtk_header("BINARY");
  bytes.replace(bytes.find("s short 1"), 9, "s \x01\xFF" + std::string(5000, 'x') + " 1");
  const std::string message = refused("a.vtk", bytes);
  EXPECT_THAT(message, HasSubstr("'??xxx"));
  EXPECT_LT(message.size(), 400u);
}

TEST_F(LegacyVtk, IsRefusedWhereItIsHostile) {
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
  EXPECT_THAT(edited("s short 1", "s unsigned_char 2"), HasSubstr("there is 's' (2 components)"));
  EXPECT_THAT(edited("s short 1\nLOOKUP_TABLE default\n" + data, "s bit 1\nLOOKUP_TABLE default\n01"),
              HasSubstr("there is 's' (type 'bit')"));
  EXPECT_THAT(edited("s short 1", "s complex 1"), HasSubstr("'s': of type 'complex'"));
  EXPECT_THAT(edited("s short 1", "s short -1"), HasSubstr("a whole number is needed"));
  EXPECT_THAT(edited("s short 1", "s"), HasSubstr("SCALARS have a name, a type"));
  EXPECT_THAT(edited("LOOKUP_TABLE default\n", ""), HasSubstr("LOOKUP_TABLE"));
  EXPECT_THAT(edited("SCALARS s", "SCALAR s"), HasSubstr("no part of DATASET STRUCTURED_POINTS"));
  EXPECT_THAT(edited("STRUCTURED_POINTS", "POLYDATA"), HasSubstr("supported is DATASET STRUCTURED_POINTS"));
  EXPECT_THAT(edited("3 2 2", "3.7 2 2"), HasSubstr("three whole numbers are needed"));
  EXPECT_THAT(edited("3 2 2", "3e0 2 2"), HasSubstr("three whole numbers are needed"));
  EXPECT_THAT(edited("DIMENSIONS 3 2 2\n", ""), HasSubstr("no DIMENSIONS"));
  EXPECT_THAT(edited("POINT_DATA 12\n", ""), HasSubstr("without POINT_DATA"));
  EXPECT_THAT(edited("BINARY", "PACKED"), HasSubstr("allowed are BINARY and ASCII"));
}

// As binary files do; require_usable() refuses them where they matter.
TEST_F(LegacyVtk, MayHaveNanAndInfinitiesAsText) {
  for (const std::string type : {"float", "double"}) {
    std::string bytes = test::vtk_header("ASCII");
    bytes.replace(bytes.find("s short 1"), 9, "s " + type + " 1");
    const auto values =
        test::values_of(read_volume(folder_.write("a.vtk", bytes + "nan -nan inf -inf 4 5 6 7 8 9 10 11")));
    EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[1]));
    EXPECT_EQ(values[2], std::numeric_limits<float>::infinity());
    EXPECT_EQ(values[3], -std::numeric_limits<float>::infinity());
    EXPECT_EQ(values[4], 4.0f);
  }
}

TEST_F(LegacyVtk, IsRefusedWhereItsTextHasMoreNumbersThanItsSizes) {
  const std::string data = test::vtk_header("ASCII") + "0 1 2 3 4 5 6 7 8 9 10 11";
  for (const std::string more : {" 12", "\n12 13\n", "\n1e3", " -1\nVECTORS v float\n0 0 0\n"})
    EXPECT_THAT(refused("a.vtk", data + more), HasSubstr("12 numbers of data expected, more found")) << more;
  for (const std::string no_more : {"", " \n\n", "\nSCALARS t float 1\nLOOKUP_TABLE default\n12 13"})
    expect_ramp(read_volume(folder_.write("a.vtk", data + no_more)));
}

TEST_F(LegacyVtk, IsRefusedWhereItsTextIsNoNumberOfItsType) {
  const auto with = [&](const std::string& type, const std::string& word) {
    std::string bytes = test::vtk_header("ASCII");
    bytes.replace(bytes.find("s short 1"), 9, "s " + type + " 1");
    return bytes + "0 1 2 " + word + " 4 5 6 7 8 9 10 11";
  };
  const auto expect_refused = [&](const std::string& type, const std::vector<std::string>& words, const char* name) {
    for (const std::string& word : words)
      EXPECT_THAT(refused("a.vtk", with(type, word)), HasSubstr("'" + word + "', value 3 of the data, is no " + name));
  };
  expect_refused("float", {"abc", "1,5", "0x10", "1e39", "1e999", "+-3", "++3", "--3"}, "float32");
  expect_refused("double", {"1e999", "nan()x", "infinite"}, "float64");
  expect_refused("short", {"3.0", "3e2", "70000", "-32769", "++3", "+-3", "nan", "inf"}, "int16");
  expect_refused("unsigned_char", {"1.5", "300", "-1", "3."}, "uint8");
  expect_refused("long", {"9223372036854775808", "1e3"}, "int64");
  expect_ramp(read_volume(folder_.write("a.vtk", with("short", "3"))));
  expect_ramp(read_volume(folder_.write("a.vtk", with("int", "+3"))));
  expect_ramp(read_volume(folder_.write("a.vtk", with("unsigned_char", "3"))));
  expect_ramp(read_volume(folder_.write("a.vtk", with("double", "+3.0e0"))));
  EXPECT_EQ(read_volume(folder_.write("a.vtk", with("double", "1e-400"))).values.values()[3], 0.0f);
}

}  // namespace
}  // namespace isolux
