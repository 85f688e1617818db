#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using ::testing::HasSubstr;

// VTK writes all volumes of unsigned bytes as colours.
class VtkColours : public test::RampFile {
 protected:
  /// 8x8x4 points, in 9.1's words.
  static std::string header(const std::string& encoding, const std::string& components = "1") {
    return "# vtk DataFile Version 5.1\nvtk output\n" + encoding +
           "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 8 8 4\nSPACING 0.5 2 4\nORIGIN 10 20 30\nPOINT_DATA 256\n"
           "COLOR_SCALARS my%20scalars " +
           components + "\n";
  }
  /// Fractions in six digits, as VTK's streams print them.
  static std::string fractions() {
    std::string text;
    for (int i = 0; i < 256; ++i) text += fmt::format("{:.6g}{}", double(float(i)) / 255.0, i % 2 == 0 ? " \n" : " ");
    return text + "\n";
  }
  static std::string all_bytes() {
    std::string bytes;
    for (int i = 0; i < 256; ++i) bytes += char(i);
    return bytes + "\n";
  }
};

TEST_F(VtkColours, OfOneComponentAreBytes) {
  const std::string other = "FIELD FieldData 1\nother 1 256 float\n";
  for (const std::string& bytes : {header("BINARY") + all_bytes(), header("ASCII") + fractions()}) {
    const StoredVolume volume = read_stored_volume(folder_.write("a.vtk", bytes));
    EXPECT_EQ(volume.stored_type, ScalarType::kUint8);
    ASSERT_TRUE(std::holds_alternative<Grid<std::uint8_t>>(volume.values));
    const auto& grid = std::get<Grid<std::uint8_t>>(volume.values);
    EXPECT_EQ(grid.lattice().size, Index3(8, 8, 4));
    EXPECT_EQ(grid.lattice().frame.origin, Vec3(10, 20, 30));
    for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(grid.values()[i], i);
    EXPECT_TRUE(volume.remarks.empty());
    EXPECT_EQ(volume_sha256(volume), volume_sha256(read_volume(folder_.file("a.vtk"))));
    EXPECT_THAT(read_volume(folder_.write("a.vtk", bytes + other)).remarks,
                ::testing::Contains(HasSubstr("'my scalars' is read, not 'other'")));
  }
}

TEST_F(VtkColours, AsTextAreReadByTheirBytes) {
  const std::string path = folder_.write("a.vtk", header("ASCII") + fractions());
  ReadOptions options;
  options.subtract = 100.0;
  EXPECT_EQ(read_volume(path, options).values.values()[7], -93.0f);
  options = {};
  options.nodata = 7.0;
  const Volume holes = read_volume(path, options);
  EXPECT_NE(holes.values.values()[7], holes.values.values()[7]);
  EXPECT_TRUE(holes.remarks.empty());
}

TEST_F(VtkColours, AreRefusedWhereTheyAreMore) {
  EXPECT_THAT(refused("a.vtk", header("BINARY", "3") + std::string(768, '0')),
              HasSubstr("'my scalars' (3 components)"));
  const std::string three = header("ASCII", "3") + fractions() + fractions() + fractions();
  EXPECT_THAT(refused("a.vtk", three), HasSubstr("'my scalars' (3 components)"));
  EXPECT_THAT(refused("a.vtk", header("BINARY", "") + all_bytes()), HasSubstr("words are missing"));
}

TEST_F(VtkColours, AreRefusedWhereTheirDataAreWrong) {
  EXPECT_THAT(refused("a.vtk", header("BINARY") + all_bytes().substr(0, 255)),
              HasSubstr("256 bytes of data expected, 255 found"));
  EXPECT_THAT(refused("a.vtk", header("ASCII") + "0 1 0"), HasSubstr("256 numbers of data expected"));
  std::string few = fractions();
  few.resize(few.size() / 2);
  EXPECT_THAT(refused("a.vtk", header("ASCII") + few), HasSubstr("256 numbers of data expected"));
  EXPECT_THAT(refused("a.vtk", header("ASCII") + fractions() + "0.5"), HasSubstr("more found: '0.5'"));
  for (const std::string word : {"2", "-.1", "nan", "x", "1.001"})
    EXPECT_THAT(refused("a.vtk", header("ASCII") + "0 1 " + word + " " + fractions()),
                HasSubstr("'" + word + "', value 2 of the data, is no number from 0 to 1"));
}

}  // namespace
}  // namespace isolux
