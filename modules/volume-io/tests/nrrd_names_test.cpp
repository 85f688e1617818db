#include "samples.h"

#include <gmock/gmock.h>

#include <chrono>

// teem, whose format NRRD is, reads names in either case and takes the first ":=" for a pair's.
namespace isolux {
namespace {

std::string header_of(const std::string& lines) {
  return "NRRD0005\ndimension: 3\nsizes: 3 2 2\n" + lines + "\n" + test::bytes_of(test::ramp());
}

TEST(NrrdNames, AreReadInEitherCase) {
  const test::TemporaryFolder folder;
  for (const std::string type : {"SHORT", "Short", "Signed Short"}) {
    const Volume volume =
        read_volume(folder.write("a.nrrd", header_of("type: " + type + "\nencoding: Raw\nendian: Little\n")));
    EXPECT_EQ(volume.stored_type, ScalarType::kInt16) << type;
    EXPECT_EQ(volume.values(2, 1, 1), 11.0f) << type;
  }
}

TEST(NrrdNames, OfCenteringsAreReadInEitherCase) {
  const test::TemporaryFolder folder;
  const auto origin = [&](const std::string& word) {
    const std::string fields =
        "type: short\nencoding: raw\nendian: little\naxis mins: 1 1 1\nspacings: 2 2 2\ncenterings: ";
    return read_volume(folder.write("a.nrrd", header_of(fields + word + " " + word + " " + word + "\n")))
        .lattice()
        .frame.origin;
  };
  EXPECT_EQ(origin("Node"), Vec3(1));
  EXPECT_EQ(origin("CELL"), Vec3(2));
}

TEST(NrrdNumbers, HaveOneSign) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& spacings, const std::string& skip) {
    const std::string fields = "type: short\nencoding: raw\nendian: little\nspacings: " + spacings;
    return folder.write("a.nrrd", header_of(fields + "\nbyte skip: " + skip + "\n"));
  };
  EXPECT_EQ(read_volume(read("+1 2e0 +.5", "+0")).lattice().frame.spacing(), Vec3(1, 2, 0.5));
  EXPECT_THAT(test::reading_error(read("+-1 2 3", "0")), ::testing::HasSubstr("spacings"));
  EXPECT_THAT(test::reading_error(read("1 2 3", "+-1")), ::testing::HasSubstr("byte skip"));
}

TEST(NrrdNames, OfPairsMayHaveColons) {
  const test::TemporaryFolder folder;
  const std::string fields = "type: short\nencoding: raw\nendian: little\n";
  for (const std::string pair : {"a:b:=c", "a:=b: c", "DICOM_0008:0060:=CT"})
    EXPECT_EQ(test::reading_error(folder.write("a.nrrd", header_of(fields + pair + "\n"))), "") << pair;
  EXPECT_NE(test::reading_error(folder.write("a.nrrd", header_of(fields + "a: b:=c\n"))), "") << "a field 'a'";
}

TEST(NrrdNames, OfSeveralDataFilesAreRefusedForWhatTheyAre) {
  const test::TemporaryFolder folder;
  const std::string fields = "NRRD0004\ntype: uchar\nencoding: raw\ndimension: 3\nsizes: 3 2 2\ndata file: ";
  for (const std::string files : {"LIST\ns0.raw\ns1.raw\n", "LIST 2\nC:\\s0.raw\nb: c\n", "LIST", "s%d.raw 0 1 1\n"})
    EXPECT_THAT(test::reading_error(folder.write("a.nhdr", fields + files)),
                ::testing::AllOf(::testing::HasSubstr("a.nhdr: 'data file: "), ::testing::HasSubstr("join them first")))
        << files;
  EXPECT_THAT(test::reading_error(folder.write("a.nhdr", "NRRD0004\ndata file: LIST\ntype: uchar\n")),
              ::testing::HasSubstr("join them first"))
      << "whatever else is missing";
}

// Names may be long, but not read anew for every line behind them, or shown whole.
TEST(NrrdNames, OfDataFilesAreReadOnce) {
  const test::TemporaryFolder folder;
  std::string names = "data file: ";
  for (int i = 0; i < 1000000; ++i) names += "x ";
  std::string comments;
  for (int i = 0; i < 2000; ++i) comments += "# a comment\n";
  const std::string fields = "type: uchar\nencoding: raw\ndimension: 3\nsizes: 3 2 2\n";
  for (const std::string& first : {names, names + "%"}) {
    const std::string path = folder.write("a.nhdr", "NRRD0004\n" + fields + first + "\n" + comments);
    const auto start = std::chrono::steady_clock::now();
    const std::string message = test::reading_error(path);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    EXPECT_THAT(message, ::testing::HasSubstr("x x x"));
    EXPECT_LT(message.size(), 1000u);
  }
}

TEST(Nrrd, ReadsEveryVersion) {
  const test::TemporaryFolder folder;
  for (const char version : std::string("123456")) {
    const std::string rest = "\ntype: uint8\nencoding: raw\ndimension: 3\nsizes: 2 1 2\n\nabcd";
    EXPECT_EQ(read_volume(folder.write("a.nrrd", std::string("NRRD000") + version + rest)).values(1, 0, 1), float('d'));
  }
}

}  // namespace
}  // namespace isolux
