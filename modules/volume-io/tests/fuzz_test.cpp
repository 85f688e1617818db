#include "samples.h"
#include "stress.h"
#include "vti_of_vtk.h"

#include <isolux/core/random.h>

#include <algorithm>

// Small changes to valid files: whatever comes of them is a volume of the file's own size or an isolux::Error, soon.
namespace isolux {
namespace {

const std::vector<std::string> kWords = {"-1",
                                         "0",
                                         "99999999999999999999",
                                         "nan",
                                         "inf",
                                         "1e308",
                                         "\n",
                                         "\n\n",
                                         ":",
                                         "=",
                                         "%d",
                                         "../",
                                         "LIST",
                                         "(",
                                         ")",
                                         " ",
                                         "\xFF\xFF\xFF\xFF",
                                         std::string(4, '\0')};

std::string mutated(std::string bytes, std::size_t header, RandomStream& random) {
  const int changes = 1 + int(random.next_bits() % 3);
  for (int i = 0; i < changes; ++i) {
    const std::size_t at = random.next_bits() % std::min(header, bytes.size());
    const std::string& word = kWords[random.next_bits() % kWords.size()];
    switch (random.next_bits() % 5) {
      case 0:
        bytes[at] = char(random.next_bits());
        break;
      case 1:
        bytes[at] = char(bytes[at] ^ char(1u << random.next_bits() % 8));
        break;
      case 2:
        bytes.insert(at, word);
        break;
      case 3:
        bytes.replace(at, std::min(word.size(), bytes.size() - at), word);
        break;
      default:
        bytes.erase(at, 1 + random.next_bits() % 8);
        break;
    }
    if (bytes.empty()) return bytes;
  }
  return bytes;
}

// Bytes that may be changed: the header and not the voxels, whose values are anybody's.
void fuzz(const std::string& name, const std::string& bytes, std::size_t header, int cases,
          const ReadOptions& options = {}) {
  const test::TemporaryFolder folder;
  int refused = 0;
  for (int i = 0; i < cases; ++i) {
    RandomStream random(1, std::uint64_t(i));
    const std::string changed = mutated(bytes, header, random);
    const auto path = folder.write(name, changed);
    try {
      const Volume volume = read_volume(path, options);
      // Nothing is made of nothing: deflate at most multiplies by 1032, text and bytes give one value each at most.
      EXPECT_LE(volume.values.values().size(), changed.size() * 1032) << name << " case " << i;
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << name << " case " << i << error.what();
    }
  }
  EXPECT_GT(refused, 0) << "changes that spoil nothing test nothing";
}

const std::string kNrrd = "NRRD0005\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\n";
const std::string kFrame = "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nkey:=value\n";

TEST(Fuzz, NrrdHeaders) {
  const std::string raw = kNrrd + "encoding: raw\n" + kFrame + "\n" + test::bytes_of(test::ramp());
  fuzz("a.nrrd", raw, raw.size() - 24, 500 * test::stress());
  const std::string gzip = kNrrd + "encoding: gzip\n" + kFrame + "\n" + test::gzipped(test::bytes_of(test::ramp()));
  fuzz("a.nrrd", gzip, gzip.size(), 500 * test::stress());
  const std::string text = kNrrd + "encoding: ascii\n" + kFrame + "\n0 1 2 3 4 5 6 7 8 9 10 11\n";
  fuzz("a.nrrd", text, text.size(), 250 * test::stress());
}

TEST(Fuzz, LightFiles) {
  const test::TemporaryFolder folder;
  const std::string light = kNrrd + "encoding: raw\n" + kFrame + "\n" + test::bytes_of(test::ramp());
  for (int i = 0; i < 250 * test::stress(); ++i) {
    RandomStream random(2, std::uint64_t(i));
    const auto path = folder.write("a.nrrd", mutated(light, light.size() - 24, random));
    (void)test::error_of([&] { (void)read_light(path); });
  }
}

TEST(Fuzz, MrcHeaders) { fuzz("a.mrc", test::mrc_sample(), 228, 500 * test::stress()); }

TEST(Fuzz, NpyHeaders) {
  const std::string header = test::npy_header("<i2", "(2, 2, 3)");
  fuzz("a.npy", header + test::bytes_of(test::ramp()), header.size(), 500 * test::stress());
}

TEST(Fuzz, NiftiHeaders) {
  fuzz("a.nii", test::nifti_sample(), 352, 500 * test::stress());
  fuzz("a.nii.gz", test::gzipped(test::nifti_sample()), 80, 500 * test::stress());
}

TEST(Fuzz, LegacyVtkHeaders) {
  const std::string binary = test::vtk_header("BINARY");
  fuzz("a.vtk", binary + test::bytes_of(test::ramp()), binary.size(), 500 * test::stress());
  const std::string text = test::vtk_header("ASCII") + "0 1 2 3 4 5 6 7 8 9 10 11";
  fuzz("a.vtk", text, text.size(), 250 * test::stress());
  for (const bool as_text : {false, true}) {
    const std::string arrays = test::vtk_arrays_sample(as_text);
    fuzz("a.vtk", arrays, arrays.size() - 24, 500 * test::stress());
  }
}

TEST(Fuzz, VtkXmlFiles) {
  if (!test::has_reader("vti")) GTEST_SKIP() << "no pugixml in this build";
  std::string pieces = test::vti_sample({.extent = "0 1 0 1 0 1", .data = "0 1 3 4 6 7 9 10"});
  pieces.insert(pieces.find("</ImageData>"),
                R"(<Piece Extent="2 2 0 1 0 1"><PointData><DataArray type="Int16" Name="ramp" format="ascii">2 5 8 11)"
                "</DataArray></PointData></Piece>");
  for (const std::string& file : {test::vti_sample(), test::vti_zlib_sample(), test::vti_raw_sample(),
                                  test::kVtkAppendedBase64ZlibWideBigEndian, pieces})
    fuzz("a.vti", file, file.size(), 300 * test::stress());
}

TEST(Fuzz, FormatsBehindItk) {
  if (!test::has_reader("itk")) GTEST_SKIP() << "no ITK in this build";
  const int cases = 60 * test::stress();
  const std::string data = test::bytes_of(test::ramp());
  const ReadOptions spaced{.raw = {}, .spacing = Vec3(1), .allow_external_data = false};
  fuzz("a.mha", test::meta_header("LOCAL") + data, test::meta_header("LOCAL").size(), cases);
  fuzz("a.tif", test::tiff_sample(0), 122, cases, spaced);
  const std::string dicom = test::dicom_sample({});
  fuzz("a.dcm", dicom, dicom.size() - 12, cases);
}

}  // namespace
}  // namespace isolux
