// Volumes in the type of their file.
#include "samples.h"
#include "scalars.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::bytes_of;

template <class T>
std::vector<T> values_in(const StoredVolume& volume) {
  const auto values = std::get<Grid<T>>(volume.values).values();
  return {values.begin(), values.end()};
}

template <class T>
void expect_kept(ScalarType type) {
  const test::TemporaryFolder folder;
  const std::vector<T> values = {T(1), T(2), T(100), std::numeric_limits<T>::max(), std::numeric_limits<T>::min(),
                                 T(0)};
  const std::string name(scalar_type_name(type));
  for (const bool big : {false, true}) {
    const std::string bytes = bytes_of(values, big);
    const std::string header =
        fmt::format("NRRD0004\ntype: {}\ndimension: 3\nsizes: 3 2 1\nendian: {}\n", name, big ? "big" : "little");
    ReadOptions options;
    options.big_endian = big;
    for (const auto& path : {folder.write(fmt::format("a_3x2x1_{}.raw", name), bytes),
                             folder.write("a.nrrd", header + "encoding: raw\n\n" + bytes),
                             folder.write("b.nrrd", header + "encoding: gzip\n\n" + test::gzipped(bytes))}) {
      const StoredVolume stored = read_stored_volume(path, options);
      EXPECT_EQ(values_in<T>(stored), values) << path << big;
      EXPECT_EQ(stored.stored_type, type);
      const Volume floats = read_volume(path, options);
      EXPECT_EQ(test::values_of(to_floats(stored)), test::values_of(floats));
      EXPECT_EQ(volume_sha256(stored), volume_sha256(floats));
    }
  }
}

TEST(StoredVolume, IsReadInEachNarrowTypeAndBothEndians) {
  expect_kept<std::uint8_t>(ScalarType::kUint8);
  expect_kept<std::int8_t>(ScalarType::kInt8);
  expect_kept<std::uint16_t>(ScalarType::kUint16);
  expect_kept<std::int16_t>(ScalarType::kInt16);
}

TEST(StoredVolume, IsInFloatsWhereTheFileHasOtherNumbers) {
  const test::TemporaryFolder folder;
  for (const auto& path :
       {folder.write("a_3x1x1_int32.raw", bytes_of<std::int32_t>({1, 2, 3})),
        folder.write("a_3x1x1_float64.raw", bytes_of<double>({1, 2, 3})),
        folder.write("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 1 1\nencoding: text\n\n1 2 3\n")})
    EXPECT_EQ(values_in<float>(read_stored_volume(path)), (std::vector<float>{1, 2, 3})) << path;
  EXPECT_TRUE(std::holds_alternative<Grid<float>>(read_stored_volume("gen:sphere:4").values));
  std::string scaled = test::nifti_sample();
  test::put<float>(scaled, 112, 0.5f);
  EXPECT_EQ(values_in<float>(read_stored_volume(folder.write("a.nii", scaled)))[3], 1.5f);
}

TEST(StoredVolume, IsWrittenAndReadBackWithoutFloats) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("a_3x2x2_int16.raw", bytes_of(test::ramp(12, -5)));
  const StoredVolume volume = read_stored_volume(path);
  for (const auto* name : {"b.nrrd", "c.nhdr", "d_3x2x2_int16.raw"}) {
    write_volume(volume, folder.file(name));
    EXPECT_EQ(values_in<std::int16_t>(read_stored_volume(folder.file(name))), test::ramp(12, -5)) << name;
  }
}

TEST(StoredVolume, HashesPartsOfFloatsAsTheWhole) {
  // Larger than a part, and no multiple of one.
  Lattice lattice;
  lattice.size = Index3(101, 53, 3);
  std::vector<std::uint8_t> values(lattice.count());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(i * 37 % 251);
  const StoredVolume volume{
      .values = Grid(lattice, std::move(values)), .name = "a", .stored_type = ScalarType::kUint8, .space = {}};
  EXPECT_EQ(volume_sha256(volume), volume_sha256(to_floats(volume)));
}

TEST(AnyValues, BecomeFloatsWhereTypesMeet) {
  detail::DecodedValues values{std::vector<std::uint8_t>{1, 255}};
  detail::append(values, {std::vector<std::uint8_t>{3}});
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(values.list), (std::vector<std::uint8_t>{1, 255, 3}));
  detail::append(values, {std::vector<std::int16_t>{-4}});
  detail::append(values, {std::vector<std::uint8_t>{5}});
  detail::append(values, {std::vector<float>{0.5f}});
  EXPECT_EQ(std::get<std::vector<float>>(values.list), (std::vector<float>{1, 255, 3, -4, 5, 0.5f}));
}

}  // namespace
}  // namespace isolux
