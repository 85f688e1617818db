#include "samples.h"

#include <gmock/gmock.h>
#include <isolux/core/random.h>

#include <set>
#include <thread>

// What every reader of the catalogue owes, on a small file of its own and on files that are none.
namespace isolux {
namespace {
using testing::HasSubstr;

struct Sample {
  std::string reader;
  std::string name;
  std::string bytes;
  ReadOptions options;
};

std::vector<Sample> samples() {
  const std::string data = test::bytes_of(test::ramp());
  const ReadOptions spaced{.raw = {}, .spacing = Vec3(1), .allow_external_data = false};
  return {{"raw", "a_3x2x2_int16.raw", data, {}},
          {"nrrd",
           "a.nrrd",
           "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\nencoding: raw\n\n" + data,
           {}},
          {"mrc", "a.mrc", test::mrc_sample(), {}},
          {"npy", "a.npy", test::npy_sample("<i2", "(2, 2, 3)"), {}},
          {"nifti", "a.nii", test::nifti_sample(), {}},
          {"nifti", "a.nii.gz", test::gzipped(test::nifti_sample()), {}},
          {"itk", "a.mha", test::meta_header("LOCAL") + data, {}},
          {"vtk", "a.vtk", test::vtk_header("BINARY") + data, {}},
          {"vti", "a.vti", test::vti_zlib_sample(), {}},
          {"vti", "raw.vti", test::vti_raw_sample(), {}},
          {"itk", "a.tif", test::tiff_sample(0), spaced},
          {"itk", "a.dcm", test::dicom_sample({}), {}}};
}

class ReaderContract : public testing::TestWithParam<Sample> {
 protected:
  void SetUp() override {  // NOLINT(readability-identifier-naming): GoogleTest's name
    if (!test::has_reader(GetParam().reader)) GTEST_SKIP() << "not in this build";
  }
  test::TemporaryFolder folder_;
};

TEST_P(ReaderContract, ClaimsItsOwnFileMostSurely) {
  const Sample& sample = GetParam();
  const auto registry = readers();
  std::vector<std::string> names = {sample.name};
  const bool needs_name = sample.reader == "raw" || sample.name.starts_with("a.nii");
  if (!needs_name) names.emplace_back("no-extension");
  for (const auto& name : names) {
    const auto path = folder_.write(name, sample.bytes);
    std::set<std::pair<int, std::string>> claims;
    for (const auto& info : registry.backends()) {
      if (info.unavailable.empty()) claims.emplace(registry.create(info.name)->claims(path, sample.options), info.name);
    }
    EXPECT_EQ(claims.rbegin()->second, sample.reader);
    EXPECT_GT(claims.rbegin()->first, std::next(claims.rbegin())->first) << "no tie";
    EXPECT_EQ(test::reading_error(path, sample.options), "");
  }
}

TEST_P(ReaderContract, RefusesEveryTruncationNamingTheFile) {
  const Sample& sample = GetParam();
  // Many lengths of our own formats, fewer where each costs a process; always the last byte.
  const std::size_t step = sample.reader == "itk" ? 37 : 7;
  for (std::size_t length = 0; length < sample.bytes.size(); length += std::min(step, sample.bytes.size() - length)) {
    const auto path = folder_.write(sample.name, sample.bytes.substr(0, length));
    EXPECT_THAT(test::reading_error(path, sample.options), HasSubstr(sample.name)) << length;
  }
  const auto path = folder_.write(sample.name, sample.bytes.substr(0, sample.bytes.size() - 1));
  EXPECT_THAT(test::reading_error(path, sample.options), HasSubstr(sample.name));
}

TEST_P(ReaderContract, GivesTheSameVolumeOnManyThreads) {
  const Sample& sample = GetParam();
  const auto path = folder_.write(sample.name, sample.bytes);
  const auto reader = readers().create(sample.reader);
  const std::string hash = volume_sha256(reader->read(path, sample.options, {}));
  std::vector<std::string> hashes(4);
  {
    std::vector<std::jthread> threads;
    for (auto& own : hashes) threads.emplace_back([&] { own = volume_sha256(reader->read(path, sample.options, {})); });
  }
  for (const auto& own : hashes) EXPECT_EQ(own, hash);
}

TEST_P(ReaderContract, GivesTheSameVolumeInTheFilesType) {
  const auto path = folder_.write(GetParam().name, GetParam().bytes);
  const StoredVolume stored = read_stored_volume(path, GetParam().options);
  // DICOM's library turns what has an intercept into other types.
  if (stored.stored_type == ScalarType::kInt16) {
    EXPECT_TRUE(std::holds_alternative<Grid<std::int16_t>>(stored.values));
  }
  const Volume floats = read_volume(path, GetParam().options);
  EXPECT_EQ(stored.stored_type, floats.stored_type);
  EXPECT_EQ(volume_sha256(stored), volume_sha256(floats));
}

TEST_P(ReaderContract, StopsWhenAsked) {
  const auto path = folder_.write(GetParam().name, GetParam().bytes);
  std::stop_source stop;
  stop.request_stop();
  isolux::Run run;
  run.stop = stop.get_token();
  EXPECT_THROW((void)read_volume(path, GetParam().options, run), Cancelled);
}

TEST_P(ReaderContract, TakesTheCallersSpacing) {
  ReadOptions options = GetParam().options;
  options.spacing = Vec3(3, 5, 7);
  const auto path = folder_.write(GetParam().name, GetParam().bytes);
  const Vec3 spacing = read_volume(path, options).lattice().frame.spacing();
  // Directions that are normalised and scaled again: a few roundings.
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(spacing[a], (*options.spacing)[a], 1e-14 * 7);
}

INSTANTIATE_TEST_SUITE_P(AllFormats, ReaderContract, testing::ValuesIn(samples()), [](const auto& test) {
  std::string name = test.param.name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

std::vector<std::string> reader_names() {
  std::vector<std::string> names;
  const auto registry = readers();
  for (const auto& info : registry.backends()) {
    if (info.unavailable.empty()) names.push_back(info.name);
  }
  return names;
}

/// What needs no file of the reader's own.
class EveryReader : public testing::TestWithParam<std::string> {
 protected:
  /// Names of files that it reads.
  [[nodiscard]] static std::vector<std::string> own_names() {
    std::vector<std::string> names;
    for (const Sample& sample : samples()) {
      if (sample.reader == GetParam()) names.push_back(sample.name);
    }
    return names;
  }
  [[nodiscard]] std::string reading_error(const std::string& source) const {
    return test::error_of([&] { (void)reader_->read(source, {}, {}); });
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<VolumeReader> reader_ = readers().create(GetParam());
};

TEST_P(EveryReader, HasASampleInThisFile) {
  const bool reads_no_files = GetParam() == "analytic";
  EXPECT_TRUE(reads_no_files || !own_names().empty())
      << "ReaderContract tests nothing of '" << GetParam() << "': add a small file of it to samples()";
}

TEST_P(EveryReader, RefusesFilesThatAreNoneOfItsOwnNamingThem) {
  std::vector<std::string> names = own_names();
  names.emplace_back("other.data");
  RandomStream random(1, 2);
  std::string noise(999, ' ');
  for (char& byte : noise) byte = char(random.next_bits() & 0xff);
  for (const auto& name : names) {
    for (const std::string& bytes : {std::string(), std::string("hello"), noise}) {
      const auto path = folder_.write(name, bytes);
      EXPECT_LE(reader_->claims(path, {}), 1) << "by its name at most: " << path;
      EXPECT_THAT(reading_error(path), HasSubstr(name)) << bytes.size() << " bytes";
    }
  }
}

TEST_P(EveryReader, RefusesWhatIsNoFileNamingIt) {
  std::filesystem::create_directory(folder_.file("empty-folder"));
  for (const std::string name : {"none.nrrd", "none_2x2x2_uint8.raw", "empty-folder"}) {
    EXPECT_LE(reader_->claims(folder_.file(name), {}), 1) << name;
    EXPECT_THAT(reading_error(folder_.file(name)), HasSubstr(name));
  }
  EXPECT_EQ(reader_->claims("", {}), 0);
  EXPECT_NE(reading_error(""), "");
}

TEST_P(EveryReader, SaysThatAFileCannotBeOpened) {
  for (const auto& name : own_names()) EXPECT_THROW((void)reader_->read(folder_.file(name), {}, {}), IoError) << name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryReader, testing::ValuesIn(reader_names()),
                         [](const auto& backend) { return backend.param; });

TEST(Readers, NameWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::reading_error(folder.file("none.nrrd")), HasSubstr("none.nrrd: no such file"));
  EXPECT_THAT(test::reading_error(folder.write("empty.nii", "")), HasSubstr("empty.nii: "));
  EXPECT_THAT(test::reading_error(folder.write("text.txt", "hello")),
              HasSubstr("not a volume that can be read: known are"));
  std::filesystem::create_directory(folder.file("dir.nrrd"));
  EXPECT_THAT(test::reading_error(folder.file("dir.nrrd")), HasSubstr("dir.nrrd"));
  EXPECT_THAT(test::reading_error("/dev/zero"), HasSubstr("not a regular file"));
  EXPECT_THAT(test::reading_error(""), HasSubstr("no such file"));
}

TEST(Readers, SayWhichReaderTheBuildLacks) {
  Registry<VolumeReader> registry;
  registry.add_unavailable("itk", "package ITK was not found");
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::error_of([&] { (void)read_volume(folder.write("a.nii", "x"), {}, {}, registry); }),
              HasSubstr("itk: package ITK was not found"));
}

TEST(Readers, PreferContentToTheName) {
  const test::TemporaryFolder folder;
  const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\na";
  EXPECT_EQ(read_volume(folder.write("a.raw", nrrd)).values(0, 0, 0), float('a'));
  // Unless the caller says what it is.
  const ReadOptions raw{
      .raw = RawLayout{.size = Index3(int(nrrd.size()), 1, 1), .type = ScalarType::kUint8, .big_endian = false},
      .spacing = {},
      .allow_external_data = false};
  EXPECT_EQ(read_volume(folder.file("a.raw"), raw).values(0, 0, 0), float('N'));
}

}  // namespace
}  // namespace isolux
