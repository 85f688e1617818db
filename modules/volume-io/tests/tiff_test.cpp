#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::Itk;
using test::kSpaced;
using test::two_pages;
using ::testing::HasSubstr;

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
  EXPECT_THAT(with(10 + 2 * 12 + 8, std::uint16_t(12)), HasSubstr("pixels of 12 bits"));
  EXPECT_THAT(with(10 + 5 * 12 + 8, std::uint32_t(4000000000u)), HasSubstr("the file has"));
  EXPECT_THAT(with(10 + 5 * 12 + 4, std::uint32_t(4000000000u)), HasSubstr("more values than"));
  EXPECT_THAT(with(10 + 6 * 12 + 8, std::uint16_t(3)), HasSubstr("grey TIFF pages"));
  EXPECT_THAT(with(10 + 9 * 12, std::uint32_t(8)), HasSubstr("round in a circle"));
}

// The sample with one more tag of a short number, or with another number in one that it has.
std::string tiff_with(std::uint16_t tag, std::uint16_t value, std::string bytes = test::tiff_sample(0)) {
  for (std::size_t at = 10; at < 10 + 9 * 12; at += 12) {
    if (bytes.compare(at, 2, test::bytes_of<std::uint16_t>({tag})) != 0) continue;
    test::put(bytes, at + 8, value);
    return bytes;
  }
  // In the last place, where the number of bytes of the one strip is; it goes to where the next page's offset is.
  const std::string data = bytes.substr(bytes.size() - 12);
  std::string longer = bytes.substr(0, 10 + 9 * 12) + test::bytes_of<std::uint16_t>({tag, 3}) +
                       test::bytes_of<std::uint32_t>({1, value, 0}) + data;
  test::put<std::uint16_t>(longer, 8, 10);
  test::put<std::uint32_t>(longer, 10 + 5 * 12 + 8, std::uint32_t(longer.size() - 12));
  return longer;
}

TEST_F(Itk, ReadsThePixelsThatTiffSays) {
  constexpr std::uint16_t kFormat = 339;
  const auto type = [&](const std::string& bytes) {
    const StoredVolume volume = read_stored_volume(folder_.write("a.tif", bytes), kSpaced);
    EXPECT_EQ(volume_sha256(volume), volume_sha256(read_volume(folder_.file("a.tif"), kSpaced)));
    return volume.stored_type;
  };
  EXPECT_EQ(type(tiff_with(kFormat, 1)), ScalarType::kUint16);
  EXPECT_EQ(type(tiff_with(kFormat, 2)), ScalarType::kInt16);
  EXPECT_EQ(type(tiff_with(kFormat, 4)), ScalarType::kUint16);
  EXPECT_EQ(type(tiff_with(258, 8)), ScalarType::kUint8);
}

// ITK reads them as zeros, as bit patterns, or as colours.
TEST_F(Itk, RefusesPixelsThatTiffMayHaveAndItkMisreads) {
  const auto message = [&](const std::string& bytes) { return refused("a.tif", bytes, kSpaced); };
  EXPECT_THAT(message(tiff_with(339, 3)), HasSubstr("TIFF pixels of 16 bits, SampleFormat 3"));
  EXPECT_THAT(message(tiff_with(258, 32)), HasSubstr("TIFF pixels of 32 bits, SampleFormat 1"));
  EXPECT_THAT(message(tiff_with(339, 2, tiff_with(258, 32))), HasSubstr("TIFF pixels of 32 bits, SampleFormat 2"));
  EXPECT_THAT(message(tiff_with(339, 3, tiff_with(258, 64))), HasSubstr("TIFF pixels of 64 bits, SampleFormat 3"));
  EXPECT_THAT(message(tiff_with(322, 16)), HasSubstr("in tiles"));
  for (const std::uint16_t orientation : {2, 3, 5, 6, 7, 8})
    EXPECT_THAT(message(tiff_with(274, orientation)), HasSubstr("supported are 1 and 4"));
  EXPECT_THAT(message(tiff_with(254, 1)), HasSubstr("smaller copy"));
}

TEST_F(Itk, RefusesTiffPagesOfSeveralTypes) {
  (void)folder_.write("s1.tif", test::tiff_sample(0));
  (void)folder_.write("s2.tif", tiff_with(339, 2));
  EXPECT_THAT(test::reading_error(folder_.file("."), kSpaced), HasSubstr("3x2 int16 pixels"));
  EXPECT_THAT(refused("a.tif", two_pages(test::tiff_sample(0), tiff_with(339, 2)), kSpaced),
              HasSubstr("page 1 is 3x2 int16, the first 3x2 uint16"));
}

// ITK counts pages in its own way, and crashes where it counted too few.
TEST_F(Itk, RefusesTiffPagesThatItkCountsOtherwise) {
  constexpr std::uint16_t kKind = 254;
  constexpr std::uint16_t kOldKind = 255;
  const std::string plain = test::tiff_sample(0);
  const auto message = [&](const std::string& one, const std::string& other) {
    return refused("a.tif", two_pages(one, other), kSpaced);
  };
  EXPECT_THAT(message(plain, tiff_with(kKind, 0)), HasSubstr("page 1 has the NewSubfileType 0, the first none"));
  EXPECT_THAT(message(tiff_with(kKind, 0), plain), HasSubstr("page 1 has the NewSubfileType none, the first 0"));
  EXPECT_THAT(message(tiff_with(kKind, 2), tiff_with(kKind, 0)), HasSubstr("NewSubfileType 0, the first 2"));
  EXPECT_THAT(message(tiff_with(kKind, 0), tiff_with(kOldKind, 3)), HasSubstr("NewSubfileType 2, the first 0"));
  EXPECT_THAT(message(plain, tiff_with(kOldKind, 2)), HasSubstr("smaller copy"));
  EXPECT_THAT(message(plain, tiff_with(kKind, 4)), HasSubstr("a mask"));
}

TEST_F(Itk, ReadsTiffPagesThatItkCountsAsWeDo) {
  const std::string plain = test::tiff_sample(0);
  const auto with_kind = [](std::uint16_t tag, std::uint16_t kind) {
    return tiff_with(tag, kind, test::tiff_sample(6));
  };
  for (const auto& pages : {two_pages(plain, test::tiff_sample(6)), two_pages(tiff_with(254, 0), with_kind(254, 0)),
                            two_pages(tiff_with(254, 2), with_kind(254, 2)), two_pages(plain, with_kind(254, 2)),
                            two_pages(plain, with_kind(255, 3)), two_pages(plain, with_kind(255, 1))})
    expect_ramp(read_volume(folder_.write("a.tif", pages), kSpaced));
}

// ITK turns them all as the first.
TEST_F(Itk, RefusesTiffPagesOfSeveralOrientations) {
  EXPECT_THAT(refused("a.tif", two_pages(test::tiff_sample(0), tiff_with(274, 4)), kSpaced),
              HasSubstr("page 1 has the Orientation 4, the first 1"));
  EXPECT_THAT(refused("a.tif", two_pages(tiff_with(274, 4), tiff_with(274, 1)), kSpaced),
              HasSubstr("page 1 has the Orientation 1, the first 4"));
}

// The tag is one that each page has to have.
TEST_F(Itk, RefusesTiffPagesThatDoNotSayWhatTheirNumbersAre) {
  std::string bytes = test::tiff_sample(0);
  test::put<std::uint16_t>(bytes, 10 + 4 * 12, 260);
  EXPECT_THAT(refused("a.tif", bytes, kSpaced), HasSubstr("without PhotometricInterpretation"));
}

// Rows from the bottom up are turned.
TEST_F(Itk, ReadsTiffsFromTheBottomUp) {
  const Volume volume = read_volume(folder_.write("a.tif", tiff_with(274, 4)), kSpaced);
  EXPECT_EQ(test::values_of(volume), (std::vector<float>{3, 4, 5, 0, 1, 2}));
}

TEST_F(Itk, GivesItsWordsWithoutAddresses) {
  // LZW data that are none.
  EXPECT_THAT(refused("a.tif", tiff_with(259, 5), kSpaced),
              ::testing::AllOf(HasSubstr("ITK cannot read it: "), ::testing::Not(HasSubstr("(0x")),
                               ::testing::Not(HasSubstr("ITK ERROR"))));
}

}  // namespace
}  // namespace isolux
