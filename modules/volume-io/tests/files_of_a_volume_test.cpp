// Which files a volume is: what is read must not be replaced, and what is written is not all named by the user.
#include <gmock/gmock.h>

#include "samples.h"
#include "support.h"

namespace isolux {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Volume small() { return sample_analytic_field("sphere", 4); }

TEST(VolumeFiles, AreTheHeaderAndItsData) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(volume_files("gen:sphere"), ElementsAre());
  const auto gone = folder.file("gone.nrrd");
  EXPECT_THAT(volume_files(gone), ElementsAre(gone));
  const auto raw = folder.write("a_2x2x2_uint8.raw", "12345678");
  EXPECT_THAT(volume_files(raw), ElementsAre(raw));

  const auto detached = folder.file("d.nhdr");
  write_volume(small(), detached);
  EXPECT_THAT(volume_files(detached), ElementsAre(detached, folder.file("d.raw")));
  EXPECT_EQ(files_written(detached), volume_files(detached));
  EXPECT_EQ(files_written(detached, {.compress = true}).back(), folder.file("d.raw.gz"));
}

TEST(VolumeFiles, OfMetaImagesAndFoldersAreAllThatIsRead) {
  if (!test::has_reader("itk")) GTEST_SKIP() << "this build leaves ITK out";
  const test::TemporaryFolder folder;
  const auto data = folder.write("m.raw", "12345678");
  const auto header = folder.write("m.mhd",
                                   "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                   "ElementDataFile = m.raw\n");
  EXPECT_THAT(volume_files(header), ElementsAre(header, data));
  std::filesystem::create_directory(folder.file("slices"));
  const auto slice = folder.write("slices/s1.tif", std::string("II*\0\x08\0\0\0", 8));
  EXPECT_THAT(volume_files(folder.file("slices")), ElementsAre(slice));
}

// A data file takes its name from the header's: what has that name already may be all that somebody has.
TEST(DetachedNrrd, ReplacesNoDataButItsOwn) {
  const test::TemporaryFolder folder;
  const auto precious = folder.write("d.raw", "precious");
  const auto header = folder.file("d.nhdr");
  const auto refused = [&](const WriteOptions& options = {}) {
    return test::error_of([&] { write_volume(small(), header, options); });
  };
  EXPECT_THAT(refused(), HasSubstr("d.raw is there already"));
  EXPECT_EQ(refused({.compress = true}), "");
  EXPECT_THAT(refused(), HasSubstr("d.raw is there already")) << "the header is of other data";
  EXPECT_EQ(test::read_file(precious), "precious");
  std::filesystem::remove(precious);
  EXPECT_EQ(refused(), "");
  EXPECT_EQ(refused(), "") << "its own data";
}

TEST(DetachedNrrd, LeavesNoDataWithoutTheHeader) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.file("d.nhdr"));
  EXPECT_THAT(test::error_of([&] { write_volume(small(), folder.file("d.nhdr")); }), HasSubstr("writing failed"));
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(DetachedNrrd, IsOnlyWrittenUnderNamesThatItsHeaderCanGiveItsData) {
  const test::TemporaryFolder folder;
  for (const std::string name : {" a.nhdr", "\ta.nhdr", "a\nb.nhdr", "a\rb.nhdr", "LIST a.nhdr", "a%d 1 2 3.nhdr"}) {
    EXPECT_THAT(test::error_of([&] { write_volume(small(), folder.file(name)); }), HasSubstr("cannot name its data"))
        << name;
    EXPECT_EQ(folder.entries(), 0u) << name;
  }
  for (const std::string name : {"a b.nhdr", "LIST.nhdr", "50% off.nhdr", "a:=b.nhdr", "#a.nhdr"}) {
    write_volume(small(), folder.file(name));
    EXPECT_EQ(volume_sha256(read_volume(folder.file(name))), volume_sha256(small())) << name;
  }
}

TEST(Nrrd, TakesNothingButZerosBehindItsGzipData) {
  const test::TemporaryFolder folder;
  const auto path = folder.file("a.nrrd");
  write_volume(small(), path, {.compress = true});
  const std::string bytes = test::read_file(path);
  EXPECT_EQ(test::reading_error(folder.write("padded.nrrd", bytes + std::string(100000, '\0'))), "");
  for (const std::string& behind : {std::string("junk"), std::string(100000, '\0') + "x", std::string("\x1Fx")})
    EXPECT_NE(test::reading_error(folder.write("more.nrrd", bytes + behind)), "") << behind.size();
}

TEST(VolumeFiles, AreNotWrittenIfTheyCouldNotBeReadBack) {
  const test::TemporaryFolder folder;
  const Volume none;
  Volume nowhere = small();
  const auto values = nowhere.values.values();
  Lattice lattice = nowhere.lattice();
  lattice.frame.origin.x = std::nan("");
  nowhere.values = Grid<float>(lattice, std::vector<float>(values.begin(), values.end()));
  for (const char* name : {"a.nrrd", "a.nhdr"}) {
    EXPECT_THROW(write_volume(none, folder.file(name)), InvalidInput);
    EXPECT_THROW(write_volume(nowhere, folder.file(name)), InvalidInput);
    EXPECT_FALSE(std::filesystem::exists(folder.file(name)));
  }
}

}  // namespace
}  // namespace isolux
