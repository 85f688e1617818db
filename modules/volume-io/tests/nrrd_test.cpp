#include "nrrd_write.h"
#include "support.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <zlib.h>

#include <limits>
#include <type_traits>

namespace isolux {
namespace {
using test::bytes_of;
using testing::HasSubstr;

std::string header(const std::string& fields) { return "NRRD0004\n" + fields + "\n"; }

const std::string kSmall = "dimension: 3\nsizes: 2 1 2\n";

// Values at both ends of a type, or of what is kept, and what a float holds of them.
template <class T>
void expect_type_is_read(const test::TemporaryFolder& folder, const std::vector<std::string>& names) {
  using Limits = std::numeric_limits<std::conditional_t<std::is_same_v<T, double>, float, T>>;
  const std::vector<T> values = {T(Limits::lowest()), T(0), T(1), T(Limits::is_integer ? Limits::max() : T(0.1))};
  for (const auto& name : names) {
    for (const bool big : {false, true}) {
      const std::string fields =
          fmt::format("type: {}\n{}endian: {}\nencoding: raw\n", name, kSmall, big ? "big" : "little");
      const auto path = folder.write("a.nrrd", header(fields).append(bytes_of(values, big)));
      const Volume volume = read_volume(path);
      ASSERT_EQ(volume.values.values().size(), 4u) << name;
      for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(volume.values.values()[i], float(values[i])) << name << " " << big;
    }
  }
}

TEST(Nrrd, ReadsEveryTypeUnderEachNameInBothEndians) {
  const test::TemporaryFolder folder;
  expect_type_is_read<std::int8_t>(folder, {"signed char", "int8", "int8_t"});
  expect_type_is_read<std::uint8_t>(folder, {"uchar", "unsigned char", "uint8", "uint8_t"});
  expect_type_is_read<std::int16_t>(folder,
                                    {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
  expect_type_is_read<std::uint16_t>(folder, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
  expect_type_is_read<std::int32_t>(folder, {"int", "signed int", "int32", "int32_t"});
  expect_type_is_read<std::uint32_t>(folder, {"uint", "unsigned int", "uint32", "uint32_t"});
  expect_type_is_read<std::int64_t>(folder, {"longlong", "long long", "long long int", "signed long long",
                                             "signed long long int", "int64", "int64_t"});
  expect_type_is_read<std::uint64_t>(
      folder, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
  expect_type_is_read<float>(folder, {"float"});
  expect_type_is_read<double>(folder, {"double"});
}

// Infinities are values like others; a number that only becomes one is an error.
TEST(Nrrd, RefusesDoublesThatNoFloatHolds) {
  const test::TemporaryFolder folder;
  const std::string fields = "type: double\n" + kSmall + "endian: little\nencoding: raw\n";
  const auto written = [&](double last) {
    return folder.write("a.nrrd", header(fields).append(bytes_of<double>({1.0, 2.0, 3.0, last})));
  };
  EXPECT_THAT(test::reading_error(written(-1e300)), testing::AllOf(HasSubstr("a.nrrd: -1e+300, value 3 of the data"),
                                                                   HasSubstr("beyond what float32 holds")));
  EXPECT_EQ(read_volume(written(std::numeric_limits<double>::infinity())).values.values()[3],
            std::numeric_limits<float>::infinity());
  EXPECT_EQ(read_volume(written(1e-300)).values.values()[3], 0.0f);
  const auto text = folder.write("b.nrrd", header("type: double\n" + kSmall + "encoding: text\n").append("1 2 1e39 3"));
  EXPECT_THAT(test::reading_error(text), HasSubstr("b.nrrd: '1e39', value 2 of the data, is beyond"));
}

Volume example(ScalarType type) {
  const IndexToWorld frame{.origin = Vec3(1.0 / 3.0, -2.5, 1e6),
                           .axes = Mat3(0.0, 0.7, 0.1, -0.3, 0.0, 0.2, 0.0, 0.1, 3.0)};
  Volume volume{.values = Grid<float>({.size = Index3(5, 4, 3), .frame = frame}),
                .name = "example",
                .stored_type = type,
                .space = "left-posterior-superior"};
  for (std::size_t i = 0; i < 60; ++i) volume.values.values()[i] = float(i * 2);
  return volume;
}

TEST(Nrrd, RoundTripsEveryTypeAttachedDetachedRawAndGzip) {
  const test::TemporaryFolder folder;
  for (int type = 0; type < 10; ++type) {
    for (const std::string ending : {".nrrd", ".nhdr"}) {
      for (const bool compress : {false, true}) {
        const auto name = (compress ? "packed" : "plain") + ending;
        const Volume volume = example(ScalarType(type));
        write_volume(volume, folder.file(name), {.compress = compress});
        const Volume back = read_volume(folder.file(name));
        EXPECT_EQ(test::values_of(back), test::values_of(volume));
        EXPECT_EQ(back.stored_type, volume.stored_type);
        EXPECT_EQ(back.space, volume.space);
        // Shortest decimal text reads back as the same double, so the hash of frame and values agrees.
        EXPECT_EQ(volume_sha256(back), volume_sha256(volume)) << name << type << compress;
      }
    }
  }
  // Two of .nrrd and .nhdr each, .raw and .raw.gz: no temporary is left.
  EXPECT_EQ(folder.entries(), 6u);
}

TEST(Nrrd, WritesTheSameBytesEachTime) {
  const test::TemporaryFolder folder;
  write_volume(example(ScalarType::kInt16), folder.file("a.nrrd"), {.compress = true});
  write_volume(example(ScalarType::kInt16), folder.file("b.nrrd"), {.compress = true});
  EXPECT_EQ(test::read_file(folder.file("a.nrrd")), test::read_file(folder.file("b.nrrd")));
}

TEST(Nrrd, RefusesToStoreWhatTheTypeCannotHold) {
  const test::TemporaryFolder folder;
  Volume volume = example(ScalarType::kUint8);
  for (const float bad : {256.0f, -1.0f, 0.5f, std::numeric_limits<float>::quiet_NaN()}) {
    volume.values.values()[7] = bad;
    EXPECT_THAT(test::error_of([&] { write_volume(volume, folder.file("a.nrrd")); }), HasSubstr("voxel 7 is"));
    EXPECT_EQ(folder.entries(), 0u);
  }
}

TEST(Nrrd, ReadsTextAndSeveralGzipMembers) {
  const test::TemporaryFolder folder;
  const auto text = folder.write("a.nrrd", header("type: int\n" + kSmall + "encoding: ascii\n") + "1, -2\n3\t4\n");
  EXPECT_EQ(test::values_of(read_volume(text)), (std::vector<float>{1, -2, 3, 4}));

  std::string joined;
  for (const auto& part : {bytes_of<std::uint8_t>({1, 2}), bytes_of<std::uint8_t>({3, 4})}) {
    const auto path = folder.file("part.gz");
    gzFile gz = gzopen(path.c_str(), "wb");
    gzwrite(gz, part.data(), unsigned(part.size()));
    gzclose(gz);
    joined += test::read_file(path);
  }
  const auto gzip = folder.write("b.nrrd", header("type: uint8\n" + kSmall + "encoding: gz\n") + joined);
  EXPECT_EQ(test::values_of(read_volume(gzip)), (std::vector<float>{1, 2, 3, 4}));
}

TEST(Nrrd, SkipsLinesAndBytesOfAForeignDataFile) {
  const test::TemporaryFolder folder;
  (void)folder.write("data", "title\nmore\nXY" + bytes_of<std::uint8_t>({1, 2, 3, 4}) + "tail");
  const auto detached = [&](const std::string& skips) {
    return folder.write("a.nhdr", "NRRD0004\r\ntype: uint8\r\ndimension: 3\r\nsizes: 2 1 2\r\nencoding: raw\r\n" +
                                      skips + "data file: data\r\n");
  };
  EXPECT_EQ(test::values_of(read_volume(detached("line skip: 2\r\nbyte skip: 2\r\n"))),
            (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(test::values_of(read_volume(detached("byte skip: -1\r\n"))), (std::vector<float>{'t', 'a', 'i', 'l'}));
  EXPECT_THAT(test::reading_error(detached("line skip: 9\n")), HasSubstr("2 of 9 lines"));
  EXPECT_THAT(test::reading_error(detached("line skip: 2\nbyte skip: 8\n")),
              HasSubstr("4 bytes of data expected, 2 found"));
}

TEST(Nrrd, BringsAnatomicalSpacesToLps) {
  const test::TemporaryFolder folder;
  const auto frame = [&](const std::string& space) {
    return read_volume(folder.write("a.nrrd", header("type: uint8\n" + kSmall + "encoding: raw\nspace: " + space +
                                                     "\nspace directions: (1,0,0) (0, 2, 0) (0,0.5,3)\n"
                                                     "space origin: (10,20,30)\n") +
                                                  "abcd"));
  };
  const Volume ras = frame("right-anterior-superior");
  EXPECT_EQ(ras.space, "left-posterior-superior");
  EXPECT_EQ(ras.lattice().frame.origin, Vec3(-10, -20, 30));
  EXPECT_EQ(ras.lattice().frame.axes, Mat3(-1, 0, 0, 0, -2, 0, 0, -0.5, 3));
  const Volume las = frame("LAS");
  EXPECT_EQ(las.lattice().frame.origin, Vec3(10, -20, 30));
  const Volume plain = frame("3D-left-handed");
  EXPECT_EQ(plain.lattice().frame.origin, Vec3(10, 20, 30));
  EXPECT_EQ(plain.space, "3D-left-handed");
}

TEST(Nrrd, TakesSpacingsAndAxisMinimaWhereThereAreNoDirections) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& fields, const ReadOptions& options = {}) {
    return read_volume(
               folder.write("a.nrrd",
                            header("type: uint8\ndimension: 3\nsizes: 2 1 2\nencoding: raw\n" + fields) + "abcd"),
               options)
        .lattice()
        .frame;
  };
  EXPECT_EQ(read("spacings: 0.5 2 4\n").spacing(), Vec3(0.5, 2, 4));
  EXPECT_EQ(read("spacings: 0.5 2 4\n", {.raw = {}, .spacing = Vec3(1, 3, 5), .allow_external_data = false}).spacing(),
            Vec3(1, 3, 5));
  const IndexToWorld cells = read("axis mins: 0 0 0\naxis maxs: 8 1 1\ncenters: cell cell cell\n");
  EXPECT_EQ(cells.spacing(), Vec3(4, 1, 0.5));
  EXPECT_EQ(cells.origin, Vec3(2, 0.5, 0.25));
  const IndexToWorld nodes = read("axis mins: 0 0 0\naxis maxs: 8 1 1\ncenters: node node node\n");
  EXPECT_EQ(nodes.spacing(), Vec3(8, 1, 1));
  EXPECT_EQ(nodes.origin, Vec3(0));
}

TEST(Nrrd, DropsFurtherAxesOfOneSample) {
  const test::TemporaryFolder folder;
  const auto path =
      folder.write("a.nrrd", header("type: uint8\ndimension: 4\nsizes: 1 2 1 2\nencoding: raw\nspace: LPS\n"
                                    "space directions: none (1,0,0) (0,2,0) (0,0,3)\n") +
                                 "abcd");
  EXPECT_EQ(read_volume(path).lattice().size, Index3(2, 1, 2));
  EXPECT_EQ(read_volume(path).lattice().frame.spacing(), Vec3(1, 2, 3));
}

TEST(Nrrd, KeepsADataFileInTheHeadersFolder) {
  const test::TemporaryFolder folder;
  const test::TemporaryFolder other;
  const auto secret = other.write("secret", "abcd");
  std::filesystem::create_symlink(secret, folder.file("link"));
  std::filesystem::create_directory(folder.file("sub"));
  (void)folder.write("sub/inside", "efgh");
  const auto naming = [&](const std::string& data) {
    return folder.write("a.nhdr", header("type: uint8\n" + kSmall + "encoding: raw\ndata file: " + data));
  };
  const ReadOptions allowed{.raw = {}, .spacing = {}, .allow_external_data = true};
  for (const auto& outside : {secret, std::string("link"),
                              "../" + std::filesystem::path(secret).parent_path().filename().string() + "/secret"}) {
    EXPECT_THAT(test::reading_error(naming(outside)), HasSubstr("lies outside the header's folder")) << outside;
    EXPECT_EQ(test::values_of(read_volume(naming(outside), allowed)).front(), 'a');
  }
  EXPECT_EQ(test::values_of(read_volume(naming("sub/inside"))).front(), 'e');
  EXPECT_EQ(test::values_of(read_volume(naming("./sub/../sub/inside"))).front(), 'e');
  EXPECT_THAT(test::reading_error(naming("nowhere")), HasSubstr("no such file"));
  EXPECT_THAT(test::reading_error(naming("/dev/zero"), allowed), HasSubstr("not a regular file"));
}

TEST(Nrrd, RefusesHostileHeadersInWords) {
  struct Case {
    std::string bytes;
    std::string words;  ///< part of the message
  };
  const std::string raw = "encoding: raw\n";
  const std::string type = "type: uint8\n";
  const std::vector<Case> cases = {
      {"", "empty"},
      {"NRRD0000\n", "NRRD0001 to NRRD0006"},
      {"NRRD0007\n", "NRRD0001 to NRRD0006"},
      {"NRRD0004", "no 'dimension'"},
      {header(type + raw + "dimension: 3\n"), "no 'sizes'"},
      {header(type + raw + "dimension: 3\nsizes: 2 2\n"), "each of the 3 axes"},
      {header(type + raw + "dimension: 0\nsizes: 2 2\n"), "allowed is 1 to 16"},
      {header(type + raw + "dimension: 99999999999999999999\nsizes: 2\n"), "allowed is 1 to 16"},
      {header(type + raw + "dimension: 3\nsizes: 2 2 -2\n") + "abcdefgh", "allowed is 1 to 2147483647"},
      {header(type + raw + "dimension: 3\nsizes: 2 2 0\n") + "abcdefgh", "allowed is 1 to 2147483647"},
      {header(type + raw + "dimension: 3\nsizes: 2 2 x\n"), "whole numbers"},
      {header(type + raw + "dimension: 3\nsizes: 2147483647 2147483647 2147483647\n") + "a", "63 bits"},
      {header(type + raw + "dimension: 3\nsizes: 2147483647 2147483647 2\n") + "a", "bytes of data expected, 1 found"},
      {header(type + "encoding: gzip\ndimension: 3\nsizes: 2147483647 2147483647 1\n") + "a",
       "compressed bytes can hold"},
      {header(type + "encoding: ascii\ndimension: 3\nsizes: 2147483647 2147483647 1\n") + "1", "numbers expected in"},
      {header("type: block\n" + raw + kSmall), "allowed are (u)int8"},
      {header("type: complex\n" + raw + kSmall), "allowed are (u)int8"},
      {header("type: short\n" + raw + kSmall) + "abcdefgh", "no 'endian'"},
      {header("type: short\nendian: middle\n" + raw + kSmall), "little and big"},
      {header(type + "encoding: hex\n" + kSmall), "supported are raw, gzip and ascii"},
      {header(type + "encoding: bzip2\n" + kSmall), "supported are raw, gzip and ascii"},
      {header(type + raw + kSmall) + "abc", "4 bytes of data expected, 3 found"},
      {header(type + raw + kSmall) + "abcde", "4 bytes of data expected, 5 found"},
      {header(type + "encoding: ascii\n" + kSmall) + "1 2 3", "4 numbers expected, 3 found"},
      {header(type + "encoding: ascii\n" + kSmall) + "1 2 3 4 5", "more found"},
      {header(type + "encoding: ascii\n" + kSmall) + "1 2 x 4", "is not a number"},
      {header(type + "encoding: ascii\n" + kSmall) + std::string(1000, '1'), "hold no numbers"},
      {header(type + "encoding: gzip\n" + kSmall) + "abcd", "damaged"},
      {header(type + "encoding: gzip\nbyte skip: -1\n" + kSmall) + "abcd", "encoding raw only"},
      {header(type + raw + "byte skip: -2\n" + kSmall) + "abcd", "at least -1"},
      {header(type + raw + "byte skip: 9223372036854775807\n" + kSmall) + "abcd", "4 bytes of data expected, 0 found"},
      {header(type + raw + "line skip: -1\n" + kSmall) + "abcd", "at least 0"},
      {header(type + raw + kSmall + "sizes: 1 1 1\n"), "given twice"},
      {header(type + raw + kSmall + "flavour: sweet\n"), "no field 'flavour'"},
      {header(type + raw + kSmall + "rubbish\n"), "neither 'field: value'"},
      {header(type + raw + kSmall + "spacings: 1 0 1\n") + "abcd", "must be finite and not zero"},
      {header(type + raw + kSmall + "spacings: 1 inf 1\n") + "abcd", "must be finite and not zero"},
      {header(type + raw + kSmall + "spacings: 1 1\n") + "abcd", "each of the 3 axes"},
      {header(type + raw + kSmall + "space: LPS\nspace directions: (1,0,0) (0,0,0) (0,0,1)\n") + "abcd", "spacing 0"},
      {header(type + raw + kSmall + "space: LPS\nspace directions: (1,0,0) (1,0,0) (0,0,1)\n") + "abcd",
       "span no volume"},
      {header(type + raw + kSmall + "space: LPS\nspace directions: (1,0,0) (0,nan,0) (0,0,1)\n"), "finite numbers"},
      {header(type + raw + kSmall + "space: LPS\nspace directions: (1,0) (0,1) (0,0)\n"), "three finite numbers"},
      {header(type + raw + kSmall + "space: LPS\nspace directions: ((((( 1 2 3\n"), "each of the 3 axes"},
      {header(type + raw + kSmall + "space: LPS\nspace directions: none (0,1,0) (0,0,1)\n") + "abcd", "'none'"},
      {header(type + raw + kSmall + "space: 3D-sideways\n") + "abcd", "supported are left-posterior-superior"},
      {header(type + raw + kSmall + "space dimension: 4\n"), "supported is 3"},
      {header(type + raw + kSmall + "space: LPS\nspace origin: (0,0,inf)\n") + "abcd", "finite numbers"},
      {header(type + raw + "dimension: 4\nsizes: 3 2 2 2\nkinds: RGB-color domain domain domain\n"), "nrrd.frame=K"},
      {header(type + raw + "dimension: 2\nsizes: 3 2\n"), "a volume has 3"},
      {header(type + raw + "dimension: 1\nsizes: 3\n"), "a volume has 3"},
      {header(type + raw + kSmall + "data file: LIST\n"), "join them first"},
      {header(type + raw + kSmall + "data file: s%03d.raw 1 9 1\n"), "join them first"},
      {header(type + raw + kSmall + "data file: \n"), "a file's name is needed"},
      {header(type + raw + kSmall + "data file: /etc/passwd\n"), "outside the header's folder"},
  };
  const test::TemporaryFolder folder;
  for (const auto& hostile : cases) {
    const auto path = folder.write("a.nrrd", hostile.bytes);
    const std::string message = test::reading_error(path);
    EXPECT_THAT(message, HasSubstr(hostile.words)) << hostile.bytes;
    EXPECT_THAT(message, HasSubstr("a.nrrd")) << "a message names the file";
    EXPECT_EQ(message.find('\n'), std::string::npos) << "a message is one line: " << message;
  }
}

}  // namespace
}  // namespace isolux
