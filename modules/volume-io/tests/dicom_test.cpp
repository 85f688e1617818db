#include "itk_fixture.h"

#include <isolux/core/error.h>

#include <glm/geometric.hpp>
#include <optional>

namespace isolux {
namespace {
using test::Itk;
using test::kSpaced;
using ::testing::HasSubstr;

TEST_F(Itk, StacksDicomSlicesByPosition) {
  // File names and instance numbers run against the positions.
  (void)folder_.write("a.dcm",
                      test::dicom_sample({.position = "10\\20\\34", .series = "1.2.3", .instance = "1", .first = 6}));
  (void)folder_.write("b.dcm",
                      test::dicom_sample({.position = "10\\20\\30", .series = "1.2.3", .instance = "2", .first = 0}));
  const Volume volume = read_volume(folder_.file("."));
  // The rescale intercept of -1000 is applied.
  expect_ramp(volume, -1000.0f);
  EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(0.5, 2, 4));
  EXPECT_EQ(volume.lattice().frame.origin, Vec3(10, 20, 30));
  EXPECT_EQ(volume.space, "left-posterior-superior");
}

// An intercept below 0 makes no wider type of unsigned numbers unless their values need it.
TEST_F(Itk, KeepsDicomIn16BitsWhereTheyHoldIt) {
  const auto unsigned_slice = [&](const std::string& z, int first) {
    std::string bytes = test::dicom_sample({.position = "10\\20\\" + z, .series = "1", .instance = z, .first = first});
    const std::string tag = test::bytes_of<std::uint16_t>({0x28, 0x103}) + "US" + test::bytes_of<std::uint16_t>({2});
    bytes[bytes.find(tag) + tag.size()] = 0;
    (void)folder_.write(z, bytes);
  };
  unsigned_slice("30", 0);
  unsigned_slice("34", 6);
  const auto stored_as = [&](ScalarType type, auto zero, float last) {
    const StoredVolume stored = read_stored_volume(folder_.file("."));
    EXPECT_EQ(stored.stored_type, type);
    ASSERT_TRUE(std::holds_alternative<Grid<decltype(zero)>>(stored.values));
    const Volume floats = read_volume(folder_.file("."));
    EXPECT_EQ(floats.stored_type, type);
    EXPECT_EQ(floats.values.values()[11], last);
    EXPECT_EQ(volume_sha256(stored), volume_sha256(floats));
  };
  stored_as(ScalarType::kInt16, std::int16_t{}, -989.0f);
  unsigned_slice("34", 33762);
  stored_as(ScalarType::kInt16, std::int16_t{}, 32767.0f);
  unsigned_slice("34", 33763);
  stored_as(ScalarType::kInt32, float{}, 32768.0f);
}

TEST_F(Itk, ReadsATiltedGantryAsAnObliqueAxis) {
  (void)folder_.write("a", test::dicom_sample({.position = "10\\20\\30", .series = "1", .instance = "1", .first = 0}));
  (void)folder_.write("b", test::dicom_sample({.position = "10\\21\\34", .series = "1", .instance = "2", .first = 6}));
  const Volume volume = read_volume(folder_.file("."));
  expect_ramp(volume, -1000.0f);
  EXPECT_EQ(volume.lattice().frame.axes[2], Vec3(0, 1, 4));
  // The caller says how far slices are apart, not which way they lie.
  const Volume spaced = read_volume(folder_.file("."), kSpaced);
  EXPECT_LT(glm::distance(spaced.lattice().frame.axes[2], 4.0 * glm::normalize(Vec3(0, 1, 4))), 1e-12);
}

// What moves in its own plane has no direction from slice to slice.
TEST_F(Itk, StacksSlicesOfOnePlaceAlongTheirNormal) {
  (void)folder_.write("a", test::dicom_sample({.position = "10\\20\\30", .series = "1", .instance = "1", .first = 0}));
  (void)folder_.write("b",
                      test::dicom_sample({.position = "13\\20\\30.001", .series = "1", .instance = "2", .first = 6}));
  EXPECT_EQ(read_volume(folder_.file("."), kSpaced).lattice().frame.axes[2], Vec3(0, 0, 4));
}

// Which files are to blame is seen from the gaps, not from the places in an even stack.
TEST_F(Itk, NamesTheDicomSlicesBetweenWhichAGapIsWrong) {
  using ::testing::AllOf;
  const auto slice = [&](const std::string& name, const std::string& z) {
    (void)folder_.write(name,
                        test::dicom_sample({.position = "10\\20\\" + z, .series = "1", .instance = name, .first = 0}));
  };
  const auto why = [&] {
    const std::string error = test::reading_error(folder_.file("."));
    const Volume spaced = read_volume(folder_.file("."), kSpaced);
    EXPECT_EQ(spaced.remarks.size(), 1u);
    EXPECT_THAT(spaced.remarks[0], HasSubstr("4 mm apart all the same"));
    const std::string reason = error.substr(error.find("spaced: "), error.find(';') - error.find("spaced: "));
    EXPECT_THAT(spaced.remarks[0], HasSubstr(reason));
    return reason;
  };
  const auto pair = [&](const char* a, const char* b) {
    return folder_.file("./") + a + " and " + folder_.file("./") + b;
  };
  for (int i = 1; i <= 5; ++i) slice(std::to_string(i), std::to_string(30 + 4 * i));
  EXPECT_TRUE(read_volume(folder_.file("."), kSpaced).remarks.empty());
  slice("5", "54");
  EXPECT_THAT(why(), AllOf(HasSubstr("a slice is missing between " + pair("4", "5")), HasSubstr("8 mm apart"),
                           HasSubstr("usual gap is 4 mm")));
  slice("5", "58");
  EXPECT_THAT(why(), HasSubstr("2 slices are missing between " + pair("4", "5")));
  slice("5", "42");
  EXPECT_THAT(why(), HasSubstr("two slices at the same place: " + pair("3", "5")));
  slice("5", "51");
  slice("1", "35");
  EXPECT_THAT(why(), AllOf(HasSubstr("smallest gap is 3 mm, between " + pair("1", "2")),
                           HasSubstr("largest 5 mm, between " + pair("4", "5"))));
  for (int i = 1; i <= 5; ++i) slice(std::to_string(i), "30");
  EXPECT_THAT(why(), HasSubstr("all 5 lie at one place"));
}

TEST_F(Itk, RefusesUnevenMixedAndBrokenDicomFolders) {
  const auto slice = [&](const std::string& name, const std::string& position, const std::string& series = "1") {
    (void)folder_.write(name,
                        test::dicom_sample({.position = position, .series = series, .instance = name, .first = 0}));
  };
  const auto read = [&](const ReadOptions& options = {}) { return test::reading_error(folder_.file("."), options); };
  slice("1", "10\\20\\30");
  slice("2", "10\\20\\34");
  slice("3", "10\\20\\39");
  EXPECT_THAT(read(), HasSubstr("not evenly spaced"));
  EXPECT_EQ(read(kSpaced), "") << "the caller's spacing overrules";
  slice("3", "10\\20\\34");
  EXPECT_THAT(read(), HasSubstr("not evenly spaced"));
  slice("3", "10\\20\\38", "2");
  EXPECT_THAT(read(), ::testing::AllOf(HasSubstr("2 DICOM series"), HasSubstr("1, 2")));
  EXPECT_THROW((void)read_volume(folder_.file(".")), InvalidInput) << "the child's exception, by its type";
  slice("3", "10\\20\\38");
  EXPECT_EQ(read(), "");
  const std::string whole = test::read_file(folder_.file("3"));
  (void)folder_.write("3", whole.substr(0, whole.size() - 1));
  EXPECT_THAT(read(), HasSubstr("12 bytes of pixel data expected, 11 found"));
  (void)folder_.write("3", whole.substr(0, 300));
  EXPECT_THAT(read(), ::testing::AnyOf(HasSubstr("ends early"), HasSubstr("the file has 300")));
}

// The sample with another value in one element, or without it where there is none.
std::string dicom_with(std::uint16_t element, const std::optional<std::string>& value, std::uint16_t group = 0x28) {
  std::string bytes = test::dicom_sample({});
  const std::size_t at = bytes.find(test::bytes_of<std::uint16_t>({group, element}), 132);
  const auto length = std::size_t(static_cast<unsigned char>(bytes[at + 6]));
  const std::string kind = bytes.substr(at + 4, 2);
  return bytes.replace(at, 8 + length, value ? test::dicom_element(group, element, kind, *value) : "");
}

// GDCM crashes on palettes, and takes what it does not know for grey.
TEST_F(Itk, RefusesDicomThatIsNotGrey) {
  for (const std::string kind : {"PALETTE COLOR", "RGB", "MONOCHROME", "MONOCHROME3", ""})
    EXPECT_THAT(refused("a.dcm", dicom_with(4, kind)),
                HasSubstr("PhotometricInterpretation '" + kind + "': supported are MONOCHROME1 and MONOCHROME2"));
  EXPECT_EQ(test::reading_error(folder_.write("a.dcm", dicom_with(4, "MONOCHROME1"))), "");
}

// GDCM's assertions end the program, or it gives zeros.
TEST_F(Itk, RefusesDicomPixelsThatGdcmCannotTake) {
  const auto with = [&](const std::string& photometric, char bits, char stored_bits) {
    std::string bytes = dicom_with(0x100, std::string{bits, '\0'});
    const std::string tag = test::bytes_of<std::uint16_t>({0x28, 0x101}) + "US" + test::bytes_of<std::uint16_t>({2});
    bytes[bytes.find(tag) + tag.size()] = stored_bits;
    bytes.replace(bytes.find("MONOCHROME2"), 11, photometric);
    if (bits < 32) return bytes;
    bytes.resize(bytes.size() + 12, '\0');
    test::put<std::uint32_t>(bytes, bytes.size() - 28, 24);
    return bytes;
  };
  const std::string one = "MONOCHROME1";
  const std::string two = "MONOCHROME2";
  EXPECT_THAT(refused("a.dcm", with(one, 16, 12)),
              HasSubstr("MONOCHROME1 of pixels of 16 bits of which 12 are stored, with a sign: GDCM"));
  EXPECT_THAT(refused("a.dcm", with(one, 32, 32)), HasSubstr("MONOCHROME1 of pixels of 32 bits"));
  EXPECT_THAT(refused("a.dcm", with(two, 32, 20)), HasSubstr("32 bits of which 20 are stored"));
  EXPECT_THAT(refused("a.dcm", with(one, 8, 7)), HasSubstr("8 bits of which 7 are stored"));
  for (const std::string& bytes :
       {with(one, 16, 16), with(one, 16, 13), with(one, 8, 8), with(two, 16, 12), with(two, 8, 8), with(two, 32, 32)})
    EXPECT_EQ(test::reading_error(folder_.write("a.dcm", bytes)), "");
}

// GDCM leaves it aside.
TEST_F(Itk, RefusesDicomWithATableOfWhatValuesStandFor) {
  const std::string item = test::bytes_of<std::uint16_t>({0xFFFE, 0xE000, 0, 0});
  const std::string end = test::bytes_of<std::uint16_t>({0xFFFE, 0xE0DD, 0, 0});
  const auto with = [&](const std::string& items, bool has_end = false) {
    const std::string head = test::bytes_of<std::uint16_t>({0x28, 0x3000}) + "SQ" + std::string(2, '\0');
    const std::uint32_t length = has_end ? 0xFFFFFFFFu : std::uint32_t(items.size());
    std::string bytes = test::dicom_sample({});
    return bytes.insert(bytes.rfind(test::bytes_of<std::uint16_t>({0x7FE0, 0x10})),
                        head + test::bytes_of<std::uint32_t>({length}) + items + (has_end ? end : ""));
  };
  for (const bool has_end : {false, true}) {
    EXPECT_THAT(refused("a.dcm", with(item, has_end)), HasSubstr("a ModalityLUTSequence"));
    EXPECT_EQ(test::reading_error(folder_.write("a.dcm", with("", has_end))), "");
  }
}

// GDCM takes them for the world's axes.
TEST_F(Itk, RefusesDicomDirectionsThatAreNotAtRightAngles) {
  for (const std::string text :
       {"1\\0\\0\\1\\0\\0", "1\\0\\0\\.002\\1\\0", "1\\0\\0\\0\\0\\0", "1\\0\\0\\0\\1", "1\\0\\0\\x\\1\\0"})
    EXPECT_THAT(refused("a.dcm", dicom_with(0x37, text, 0x20)), HasSubstr("directions at right angles are needed"));
  const Volume volume = read_volume(folder_.write("a.dcm", dicom_with(0x37, "0\\2\\0\\ 0 \\+0\\-1", 0x20)));
  EXPECT_EQ(volume.lattice().frame.axes[0], Vec3(0, 0.5, 0));
  EXPECT_EQ(volume.lattice().frame.axes[1], Vec3(0, 0, -2));
}

// GDCM takes it for 1.
TEST_F(Itk, RefusesDicomWithoutASpacingUnlessTheCallerGivesOne) {
  for (const std::string text : {"0\\2", "2\\-1", "2", "nan\\2", ""}) {
    EXPECT_THAT(refused("a.dcm", dicom_with(0x30, text)), HasSubstr("two numbers above 0 are needed"));
    EXPECT_EQ(read_volume(folder_.file("a.dcm"), kSpaced).lattice().frame.spacing(), Vec3(0.5, 2, 4)) << text;
  }
  EXPECT_THAT(refused("a.dcm", dicom_with(0x30, {})), HasSubstr("without PixelSpacing"));
  EXPECT_EQ(read_volume(folder_.file("a.dcm"), kSpaced).lattice().frame.spacing(), Vec3(0.5, 2, 4));
}

// GDCM takes it for 1.
TEST_F(Itk, RefusesDicomOfTheSlopeZero) {
  for (const std::string text : {"0", "0.0", " -0"})
    EXPECT_THAT(refused("a.dcm", dicom_with(0x1053, text)), HasSubstr("RescaleSlope 0"));
}

TEST_F(Itk, RefusesDicomWithoutItsMark) {
  const std::string bytes = test::dicom_sample({});
  EXPECT_THAT(refused("a.dcm", bytes.substr(132)), HasSubstr("the mark DICM at byte 128 is missing"));
  EXPECT_THAT(refused("a.dcm", std::string(132, 'x') + bytes.substr(132)), HasSubstr("the mark DICM"));
}

// An element of which the head says a kind and a length.
std::string head(std::uint16_t group, const std::string& kind, std::uint32_t length) {
  const std::string tag = test::bytes_of<std::uint16_t>({group, 0x10});
  return tag + kind + std::string(2, '\0') + test::bytes_of<std::uint32_t>({length});
}

// GDCM takes gigabytes for it wherever it stands.
TEST_F(Itk, RefusesDicomElementsThatAreLongerThanTheFile) {
  const std::string bytes = test::dicom_sample({});
  const std::string item = test::bytes_of<std::uint16_t>({0xFFFE, 0xE000});
  const std::string eight(8, 'x');
  const std::string element = head(0x31, "OB", 0x70000000) + eight;
  const std::string end = test::bytes_of<std::uint16_t>({0xFFFE, 0xE0DD, 0, 0});
  for (const std::string& bad :
       {element, head(0x31, "SQ", 16) + item + test::bytes_of<std::uint32_t>({0x70000000}) + eight,
        head(0x31, "SQ", 28) + item + test::bytes_of<std::uint32_t>({20}) + element,
        head(0x31, "SQ", 0xFFFFFFFF) + item + test::bytes_of<std::uint32_t>({20}) + element + end}) {
    const std::size_t pixels = bytes.rfind(test::bytes_of<std::uint16_t>({0x7FE0, 0x10}));
    for (const std::size_t at : {pixels, bytes.size()})
      EXPECT_THAT(refused("a.dcm", std::string(bytes).insert(at, bad)),
                  HasSubstr("a DICOM element of 1879048192 bytes"));
  }
}

TEST_F(Itk, RefusesKindsThatThereAreNotInTheHeadOfDicom) {
  std::string bytes = test::dicom_sample({});
  bytes[bytes.find("UI", 132) + 1] = '#';
  EXPECT_THAT(refused("a.dcm", bytes), HasSubstr("an element of the kind 'U#'"));
}

TEST_F(Itk, ReadsDicomWithMoreBehindItsPixels) {
  const std::string bytes = test::dicom_sample({});
  const std::string item = test::bytes_of<std::uint16_t>({0xFFFE, 0xE000}) + test::bytes_of<std::uint32_t>({20});
  const auto read = [&](const std::string& tail) { return test::reading_error(folder_.write("a.dcm", bytes + tail)); };
  for (const std::string& tail : {std::string(3, 'x'), std::string(16, '\0'), head(0xFFFC, "OB", 4) + "abcd",
                                  head(0x7FE1, "SQ", 28) + item + head(0x31, "OB", 8) + "12345678"})
    EXPECT_EQ(read(tail), "") << tail.size();
  EXPECT_THAT(read(std::string(5, '\0')), HasSubstr("a.dcm: the DICOM header ends early"));
  EXPECT_THAT(read(head(0x7FE1, "BO", 0xFFF0)), HasSubstr("behind the pixel data, is no DICOM element"));
}

// GDCM takes seconds and gigabytes for it.
TEST_F(Itk, RefusesDicomPixelsThatAreLongerThanTheFile) {
  for (const std::uint32_t length : {0xFFFFFFFEu, 0xFFFFFFFFu, 14u}) {
    std::string bytes = test::dicom_sample({});
    test::put(bytes, bytes.size() - 16, length);
    EXPECT_THAT(refused("a.dcm", bytes), HasSubstr(fmt::format("pixel data of {} bytes, the file has 12", length)));
  }
}

}  // namespace
}  // namespace isolux
