#include "itk_fixture.h"

#include <gmock/gmock.h>

#include <string>
#include <tuple>
#include <vector>

namespace isolux {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Files of several volumes, as of times or channels. The k-th of three is 100 k + 0, 1, ... 11, on 3x2x2 voxels.
class SeveralVolumes : public test::RampFile {
 protected:
  static ReadOptions frame(const std::string& reader, const std::string& number) {
    ReadOptions options;
    options.settings[reader]["frame"] = number;
    return options;
  }
  static std::vector<std::int16_t> one_after_another() {
    std::vector<std::int16_t> values;
    for (int k = 0; k < 3; ++k)
      for (const std::int16_t value : test::ramp(12, 100 * k)) values.push_back(value);
    return values;
  }
  static std::vector<std::int16_t> in_turns(int together) {
    std::vector<std::int16_t> values;
    for (int first = 0; first < 12; first += together)
      for (int k = 0; k < 3; ++k)
        for (const std::int16_t value : test::ramp(together, 100 * k + first)) values.push_back(value);
    return values;
  }
  void expect_each(const std::string& reader, const std::string& name, const std::string& bytes) const {
    const std::string path = folder_.write(name, bytes);
    for (int k = 0; k < 3; ++k) expect_ramp(read_volume(path, frame(reader, fmt::format("{}", k))), 100.0f * float(k));
    const std::string advice = "--set-reader " + reader + ".frame=K reads one as a volume, K from 0 to 2";
    EXPECT_THAT(test::reading_error(path), HasSubstr(advice));
    EXPECT_THAT(test::reading_error(path, frame(reader, "3")),
                HasSubstr(name + ": " + reader + ".frame=3: allowed is 0 to 2"));
    EXPECT_THAT(test::reading_error(path, frame(reader, "-2")), HasSubstr("frame"));
  }
  void expect_refused(const std::string& reader, const std::string& name, const std::string& bytes) const {
    EXPECT_THAT(test::reading_error(folder_.write(name, bytes), frame(reader, "1")),
                HasSubstr("bytes of data expected"))
        << name;
  }
};

TEST_F(SeveralVolumes, OfNiftiAreReadByNumber) {
  std::string bytes = test::nifti_sample();
  bytes.resize(352);
  test::put<std::int16_t>(bytes, 40, 4);
  test::put<std::int16_t>(bytes, 48, 3);
  const std::string data = test::bytes_of(one_after_another());
  expect_each("nifti", "a.nii", bytes + data);
  expect_each("nifti", "a.nii.gz", test::gzipped(bytes + data));
  expect_refused("nifti", "a.nii", bytes + data.substr(1));
  EXPECT_THAT(
      test::reading_error(folder_.write("a.nii.gz", test::gzipped(bytes + data.substr(0, 60))), frame("nifti", "2")),
      HasSubstr("a.nii.gz"));
  // Vectors at two times: the axes behind space count on.
  test::put<std::int16_t>(bytes, 40, 5);
  test::put<std::int16_t>(bytes, 50, 2);
  const std::string path = folder_.write("b.nii", bytes + data + test::bytes_of(test::ramp(36, 300)));
  expect_ramp(read_volume(path, frame("nifti", "4")), 312.0f);
  EXPECT_THAT(test::reading_error(path), HasSubstr("6 volumes along the axes behind the third"));
}

TEST_F(SeveralVolumes, OfNumpyLieAlongTheSlowestAxis) {
  const std::string data = test::bytes_of(one_after_another());
  expect_each("npy", "a.npy", test::npy_header("<i2", "(3, 2, 2, 3)") + data);
  expect_each("npy", "a.npy", test::npy_header("<i2", "(3, 2, 2, 3)", true) + data);
  expect_each("npy", "a.npy", test::npy_header("<i2", "(3, 1, 2, 2, 3)") + data);
  expect_refused("npy", "a.npy", test::npy_header("<i2", "(3, 2, 2, 3)") + data.substr(2));
  expect_refused("npy", "a.npy", test::npy_header("<i2", "(3, 2, 2, 3)") + data + "xx");
  const std::string halves = test::npy_header("<f2", "(2, 2, 2, 2)") + std::string(16, '\0') +
                             test::bytes_of<std::uint16_t>({0x3C00, 0x4000, 0, 0, 0, 0, 0, 0});
  EXPECT_THAT(test::values_of(read_volume(folder_.write("h.npy", halves), frame("npy", "1"))),
              ElementsAre(1, 2, 0, 0, 0, 0, 0, 0));
}

TEST_F(SeveralVolumes, OfMrcAreStacks) {
  std::string bytes = test::mrc_sample();
  bytes.resize(1024);
  test::put<std::int32_t>(bytes, 8, 6);
  test::put<std::int32_t>(bytes, 36, 2);
  test::put<std::int32_t>(bytes, 88, 401);
  const std::string path = folder_.write("a.mrc", bytes + test::bytes_of(one_after_another()));
  const Volume one = read_volume(folder_.write("one.mrc", test::mrc_sample()));
  for (int k = 0; k < 3; ++k) {
    const Volume volume = read_volume(path, frame("mrc", fmt::format("{}", k)));
    ASSERT_EQ(volume.lattice().size, one.lattice().size);
    EXPECT_EQ(volume.lattice().frame.origin, one.lattice().frame.origin);
    for (std::size_t i = 0; i < 12; ++i)
      EXPECT_EQ(volume.values.values()[i], one.values.values()[i] + 100.0f * float(k));
  }
  EXPECT_THAT(test::reading_error(path), HasSubstr("a stack of 3 volumes (ISPG 401): --set-reader mrc.frame=K"));
  EXPECT_THAT(test::reading_error(path, frame("mrc", "3")), HasSubstr("allowed is 0 to 2"));
  test::put<std::int32_t>(bytes, 36, 4);
  EXPECT_THAT(refused("b.mrc", bytes + test::bytes_of(one_after_another())),
              HasSubstr("6 sections of a stack of volumes of 4"));
}

TEST_F(SeveralVolumes, OfNrrdLieAlongAnyAxisThatIsNotOfSpace) {
  const auto header = [](const std::string& sizes, const std::string& kinds, const std::string& encoding) {
    return "NRRD0004\ntype: short\ndimension: 4\nsizes: " + sizes + "\nkinds: " + kinds +
           "\nendian: little\nencoding: " + encoding + "\n\n";
  };
  const std::vector<std::tuple<std::string, std::string, int>> files = {{"3 2 2 3", "domain domain domain time", 12},
                                                                        {"3 3 2 2", "vector domain domain domain", 1},
                                                                        {"3 3 2 2", "domain list domain domain", 3},
                                                                        {"3 2 3 2", "domain space RGB-color space", 6}};
  for (const auto& [sizes, kinds, together] : files) {
    const auto values = in_turns(together);
    std::string text;
    for (const std::int16_t value : values) text += fmt::format("{} ", value);
    expect_each("nrrd", "a.nrrd", header(sizes, kinds, "raw") + test::bytes_of(values));
    expect_each("nrrd", "b.nrrd", header(sizes, kinds, "gzip") + test::gzipped(test::bytes_of(values)));
    expect_each("nrrd", "c.nrrd", header(sizes, kinds, "text") + text);
    expect_refused("nrrd", "a.nrrd", header(sizes, kinds, "raw") + test::bytes_of(values).substr(1));
    expect_refused("nrrd", "b.nrrd", header(sizes, kinds, "gzip") + test::gzipped(test::bytes_of(values) + "x"));
    EXPECT_THAT(
        test::reading_error(folder_.write("c.nrrd", header(sizes, kinds, "text") + text + "1"), frame("nrrd", "0")),
        HasSubstr("36 numbers expected, more found"));
  }
  // Without kinds by what has no direction; not where two axes could be meant.
  const std::string directed =
      "NRRD0004\ntype: short\ndimension: 4\nsizes: 3 3 2 2\nspace dimension: 3\nspace directions: "
      "none (1,0,0) (0,1,0) (0,0,1)\nendian: little\nencoding: raw\n\n";
  expect_each("nrrd", "d.nrrd", directed + test::bytes_of(in_turns(1)));
  for (const std::string kinds : {"vector list domain domain", "domain domain domain domain"})
    EXPECT_THAT(
        test::reading_error(folder_.write("e.nrrd", header("3 3 2 2", kinds, "raw") + test::bytes_of(in_turns(1))),
                            frame("nrrd", "0")),
        HasSubstr("a volume has 3"))
        << kinds;
}

TEST_F(SeveralVolumes, AreReadAcrossPiecesOfAnyLength) {
  constexpr int kCount = 50000;
  std::vector<std::int16_t> values;
  for (int i = 0; i < kCount; ++i)
    for (int k = 0; k < 7; ++k) values.push_back(std::int16_t((i * 7 + k) % 30011));
  const std::string path =
      folder_.write("a.nrrd", fmt::format("NRRD0004\ntype: short\ndimension: 4\nsizes: 7 50 100 10\nkinds: list domain "
                                          "domain domain\nendian: little\nencoding: raw\n\n") +
                                  test::bytes_of(values));
  const auto fifth = test::values_of(read_volume(path, frame("nrrd", "5")));
  ASSERT_EQ(fifth.size(), std::size_t(kCount));
  for (int i = 0; i < kCount; ++i) ASSERT_EQ(fifth[std::size_t(i)], float((i * 7 + 5) % 30011)) << i;
}

TEST_F(SeveralVolumes, AreNoneWhereThereIsOne) {
  for (const auto& [reader, name, bytes] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"nifti", "a.nii", test::nifti_sample()},
           {"npy", "a.npy", test::npy_sample("<i2", "(2, 2, 3)")},
           {"mrc", "a.mrc", test::mrc_sample()},
           {"nrrd", "a.nrrd",
            "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\nencoding: raw\n\n" +
                test::bytes_of(test::ramp())}}) {
    const std::string path = folder_.write(name, bytes);
    EXPECT_EQ(test::values_of(read_volume(path, frame(reader, "0"))), test::values_of(read_volume(path)));
    EXPECT_THAT(test::reading_error(path, frame(reader, "1")), HasSubstr("allowed is 0 to 0"));
  }
}

}  // namespace
}  // namespace isolux
