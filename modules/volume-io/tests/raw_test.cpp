#include "raw_name.h"
#include "support.h"

#include <gmock/gmock.h>

#include <limits>
#include <type_traits>

namespace isolux {
namespace {
using test::bytes_of;
using testing::HasSubstr;

ReadOptions layout(Index3 size, ScalarType type, bool big_endian) {
  return {.raw = RawLayout{.size = size, .type = type, .big_endian = big_endian},
          .spacing = {},
          .allow_external_data = false};
}

template <class T>
void expect_type(const test::TemporaryFolder& folder, ScalarType type) {
  using Limits = std::numeric_limits<std::conditional_t<std::is_same_v<T, double>, float, T>>;
  const std::vector<T> values = {T(1), T(2), T(100), T(Limits::max()), T(Limits::lowest()), T(0)};
  for (const bool big : {false, true}) {
    const auto path = folder.write("data.bin", bytes_of(values, big));
    const Volume volume = read_volume(path, layout({3, 2, 1}, type, big));
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(volume.values.values()[i], float(values[i]));
    EXPECT_EQ(volume.stored_type, type);
  }
}

TEST(Raw, ReadsEveryTypeInBothEndians) {
  const test::TemporaryFolder folder;
  expect_type<std::int8_t>(folder, ScalarType::kInt8);
  expect_type<std::uint8_t>(folder, ScalarType::kUint8);
  expect_type<std::int16_t>(folder, ScalarType::kInt16);
  expect_type<std::uint16_t>(folder, ScalarType::kUint16);
  expect_type<std::int32_t>(folder, ScalarType::kInt32);
  expect_type<std::uint32_t>(folder, ScalarType::kUint32);
  expect_type<std::int64_t>(folder, ScalarType::kInt64);
  expect_type<std::uint64_t>(folder, ScalarType::kUint64);
  expect_type<float>(folder, ScalarType::kFloat32);
  expect_type<double>(folder, ScalarType::kFloat64);
}

TEST(Raw, ReadsItsLayoutFromTheName) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("my_data_3x1x2_uint16.raw", bytes_of<std::uint16_t>({1, 2, 3, 4, 5, 600}));
  const Volume volume = read_volume(path);
  EXPECT_EQ(volume.lattice().size, Index3(3, 1, 2));
  EXPECT_EQ(volume.values(2, 0, 1), 600.0f);
  EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(1));
  EXPECT_EQ(detail::parse_raw_name("a_64x64_uint8.raw"), std::nullopt);
  EXPECT_EQ(detail::parse_raw_name("a_1x2x3_uint9.raw"), std::nullopt);
  EXPECT_EQ(detail::parse_raw_name("a_1x2x9999999999_uint8.raw"), std::nullopt);
}

TEST(Raw, AloneTakesALayout) {
  const test::TemporaryFolder folder;
  const auto named = folder.write("a_2x1x1_uint8.raw", "ab");
  const auto other = folder.write("a.bin", "ab");
  EXPECT_TRUE(takes_layout(named));
  EXPECT_TRUE(takes_layout(other, layout({2, 1, 1}, ScalarType::kUint8, false)));
  EXPECT_THROW((void)takes_layout(other), InvalidInput);
  EXPECT_FALSE(takes_layout("gen:sphere:4", layout({4, 4, 4}, ScalarType::kFloat32, true)));
  const auto nrrd = folder.file("a.nrrd");
  write_volume(read_volume("gen:sphere:4"), nrrd);
  EXPECT_FALSE(takes_layout(nrrd));
}

TEST(Raw, RoundTripsUnderItsOwnNameOnly) {
  const test::TemporaryFolder folder;
  Volume volume = read_volume("gen:gyroid:5");
  write_volume(volume, folder.file("g_5x5x5_float32.raw"));
  EXPECT_EQ(test::values_of(read_volume(folder.file("g_5x5x5_float32.raw"))), test::values_of(volume));
  for (const auto* name : {"g.raw", "g_5x5x4_float32.raw", "g_005x5x4_FLOAT32.raw"})
    EXPECT_THAT(test::error_of([&] { write_volume(volume, folder.file(name)); }), HasSubstr(": g_5x5x5_float32.raw"));
  EXPECT_THAT(test::error_of([&] { write_volume(volume, folder.file("g.xyz")); }), HasSubstr(".nrrd, .nhdr"));
}

TEST(Raw, RefusesWrongSizes) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::reading_error(folder.write("a_2x2x2_uint8.raw", "1234567")), HasSubstr("are 8 bytes, 7 found"));
  EXPECT_THAT(test::reading_error(folder.write("b_2x2x2_uint8.raw", "123456789")), HasSubstr("are 8 bytes, 9 found"));
  EXPECT_THAT(test::reading_error(folder.write("c_2000000000x2000000000x2000000000_float64.raw", "1")),
              HasSubstr("63 bits"));
  EXPECT_THAT(test::reading_error(folder.write("d_0x2x2_uint8.raw", "1")), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(test::reading_error(folder.write("e.raw", "1")), HasSubstr("says its size and type in its name"));
  const auto path = folder.write("f.bin", "1234");
  EXPECT_THAT(test::reading_error(path, layout({-2, 2, 1}, ScalarType::kUint8, false)), HasSubstr("allowed is 1 to"));
  ReadOptions bad = layout({2, 2, 1}, ScalarType::kUint8, false);
  for (const double step : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    bad.spacing = Vec3(1, step, 1);
    EXPECT_THAT(test::reading_error(path, bad), HasSubstr("finite number above 0"));
  }
}

TEST(ScalarTypes, HaveNamesThatReadBack) {
  for (int type = 0; type < 10; ++type)
    EXPECT_EQ(parse_scalar_type(scalar_type_name(ScalarType(type))), ScalarType(type));
  EXPECT_EQ(bytes_per_scalar(ScalarType::kFloat64), 8u);
  EXPECT_THAT(test::error_of([] { (void)parse_scalar_type("uint12"); }), HasSubstr("allowed are int8, uint8"));
}

TEST(VolumeHash, FollowsValuesSizeAndFrame) {
  const Volume volume = read_volume("gen:torus:4");
  // Of a 4^3 grid: 3 sizes, 12 frame numbers, 64 floats; the digest has 256 bits.
  EXPECT_EQ(volume_sha256(volume).size(), 64u);
  EXPECT_EQ(volume_sha256(volume), volume_sha256(read_volume("gen:torus:4")));
  Volume other = volume;
  other.values(3, 3, 3) += 1.0f;
  EXPECT_NE(volume_sha256(other), volume_sha256(volume));
  EXPECT_NE(volume_sha256(read_volume("gen:torus:4", {.raw = {}, .spacing = Vec3(1), .allow_external_data = false})),
            volume_sha256(volume));
}

}  // namespace
}  // namespace isolux
