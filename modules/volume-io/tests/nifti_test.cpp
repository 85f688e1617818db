#include "itk_fixture.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

namespace isolux {
namespace {
using ::testing::HasSubstr;

class Nifti : public test::RampFile {};

TEST_F(Nifti, IsReadInLps) {
  for (const bool big : {false, true}) {
    for (const bool gzip : {false, true}) {
      const std::string bytes = test::nifti_sample(big);
      const Volume volume =
          read_volume(folder_.write(gzip ? "a.nii.gz" : "a.nii", gzip ? test::gzipped(bytes) : bytes));
      expect_ramp(volume);
      EXPECT_EQ(volume.stored_type, ScalarType::kInt16);
      EXPECT_EQ(volume.space, "left-posterior-superior");
      const IndexToWorld& frame = volume.lattice().frame;
      // The sform is RAS: x and y change sign.
      EXPECT_EQ(frame.world(Vec3(0)), Vec3(10, -20, 30));
      EXPECT_EQ(frame.world(Vec3(2, 1, 1)), Vec3(9, -22, 34));
    }
  }
}

TEST_F(Nifti, IsReadUnderAnyName) {
  const std::string bytes = test::nifti_sample();
  for (const std::string name : {"scan", "scan.bin", "scan.nii.gz", "scan.mha"})
    expect_ramp(read_volume(folder_.write(name, bytes)));
  for (const std::string name : {"packed", "packed.nii"})
    expect_ramp(read_volume(folder_.write(name, test::gzipped(bytes))));
}

// Libraries look for a.nii before they look for a.nii.gz.
TEST_F(Nifti, IsReadFromItsOwnFileAlone) {
  std::string other = test::nifti_sample();
  other.replace(352, 24, 24, '\7');
  for (const std::string& beside : {other, std::string("hello")}) {
    (void)folder_.write("a.nii", beside);
    (void)folder_.write("a.hdr", beside);
    expect_ramp(read_volume(folder_.write("a.nii.gz", test::gzipped(test::nifti_sample()))));
  }
}

// nifti2.h: the same fields, wider and elsewhere.
std::string nifti2_sample() {
  std::string bytes(544, '\0');
  test::put<std::int32_t>(bytes, 0, 540);
  bytes.replace(4, 8, std::string("n+2\0\r\n\x1A\n", 8));
  test::put<std::int16_t>(bytes, 12, 4);
  test::put<std::int16_t>(bytes, 14, 16);
  const std::array<std::int64_t, 8> dim = {3, 3, 2, 2, 1, 1, 1, 1};
  const std::array<double, 4> pixdim = {1, 0.1, 2, 4};
  for (std::size_t i = 0; i < 8; ++i) test::put(bytes, 16 + 8 * i, dim.at(i));
  for (std::size_t i = 0; i < 4; ++i) test::put(bytes, 104 + 8 * i, pixdim.at(i));
  test::put<std::int64_t>(bytes, 168, 544);
  test::put<std::int32_t>(bytes, 348, 1);
  const std::array<double, 12> sform = {0.1, 0, 0, -10, 0, 2, 0, 20, 0, 0, 4, 30.3};
  for (std::size_t i = 0; i < 12; ++i) test::put(bytes, 400 + 8 * i, sform.at(i));
  return bytes + test::bytes_of(test::ramp());
}

TEST_F(Nifti, IsReadInItsSecondVersionWithAllDigits) {
  for (const bool gzip : {false, true}) {
    const std::string bytes = nifti2_sample();
    const Volume volume = read_volume(folder_.write(gzip ? "a.nii.gz" : "a.nii", gzip ? test::gzipped(bytes) : bytes));
    expect_ramp(volume);
    EXPECT_EQ(volume.lattice().frame.axes[0], Vec3(-0.1, 0, 0));
    EXPECT_EQ(volume.lattice().frame.origin, Vec3(10, -20, 30.3));
  }
}

TEST_F(Nifti, IsScaled) {
  std::string bytes = test::nifti_sample();
  test::put<float>(bytes, 112, 0.5f);
  test::put<float>(bytes, 116, 100.0f);
  const Volume volume = read_volume(folder_.write("a.nii", bytes));
  EXPECT_EQ(volume.values(2, 1, 1), 105.5f);
}

std::string scaled(float slope, float intercept) {
  std::string bytes = test::nifti_sample();
  test::put(bytes, 112, slope);
  test::put(bytes, 116, intercept);
  return bytes;
}

TEST_F(Nifti, HasNoScalingWhereTheSlopeIsZeroOrNoNumber) {
  for (const float slope : {0.0f, std::nanf(""), HUGE_VALF}) {
    for (const float intercept : {5.0f, std::nanf("")}) {
      expect_ramp(read_volume(folder_.write("a.nii", scaled(slope, intercept))));
      EXPECT_EQ(read_volume(folder_.file("a.nii")).stored_type, ScalarType::kInt16);
    }
  }
}

TEST_F(Nifti, NeedsNoSpacingAlongAnAxisOfOneSample) {
  for (const std::int16_t axes : {2, 3}) {
    std::string bytes = test::nifti_sample();
    test::put<std::int16_t>(bytes, 40, axes);
    test::put<std::int16_t>(bytes, 46, axes == 3 ? 1 : 7);
    test::put<float>(bytes, 88, 0.0f);
    test::put<std::int16_t>(bytes, 254, 0);
    const Volume volume = read_volume(folder_.write("a.nii", bytes));
    EXPECT_EQ(volume.lattice().size, Index3(3, 2, 1));
    EXPECT_EQ(volume.lattice().frame.spacing(), Vec3(0.5, 2, 1));
  }
}

TEST_F(Nifti, IsRefusedAsAPair) {
  std::string bytes = test::nifti_sample();
  bytes.replace(344, 4, std::string("ni1\0", 4));
  EXPECT_THAT(refused("a.hdr", bytes), HasSubstr("the header of a NIfTI pair"));
  bytes = nifti2_sample();
  bytes.replace(4, 4, std::string("ni2\0", 4));
  EXPECT_THAT(refused("a.hdr", bytes), HasSubstr("the header of a NIfTI pair"));
}

TEST_F(Nifti, IsScaledHoweverSmallTheSlope) {
  EXPECT_EQ(read_volume(folder_.write("a.nii", scaled(1e-17f, 0.0f))).values(2, 1, 1), float(11 * double(1e-17f)));
  EXPECT_EQ(read_volume(folder_.write("a.nii", scaled(1.0f, 5.0f))).values(2, 1, 1), 16.0f);
}

TEST_F(Nifti, KeepsTheLastBitsOfLargeNumbersThatAnOffsetBringsDown) {
  for (const bool big : {false, true}) {
    std::string bytes = test::nifti_sample(big).substr(0, 352);
    test::put<std::int16_t>(bytes, 70, 8, big);
    test::put<std::int16_t>(bytes, 72, 32, big);
    test::put<float>(bytes, 112, 1.0f, big);
    test::put<float>(bytes, 116, -0x1p30f, big);
    std::vector<std::int32_t> values;
    for (int i = 0; i < 12; ++i) values.push_back((1 << 30) + i);
    expect_ramp(read_volume(folder_.write("a.nii", bytes + test::bytes_of(values, big))));
  }
}

TEST_F(Nifti, IsRefusedWhereItsScalingLeavesTheFloats) {
  EXPECT_THAT(refused("a.nii", scaled(1e38f, 0.0f)), HasSubstr("4, value 4 of the data, is 4e+38"));
}

TEST_F(Nifti, GivesItsOriginInMillimetresToo) {
  const auto frame = [&](char units) {
    std::string bytes = test::nifti_sample();
    bytes[123] = units;
    return read_volume(folder_.write("a.nii", bytes)).lattice().frame;
  };
  EXPECT_EQ(frame(1 + 8).origin, Vec3(10000, -20000, 30000)) << "metres, and seconds";
  EXPECT_EQ(frame(1).axes[2], Vec3(0, 0, 4000));
  EXPECT_EQ(frame(3).origin, Vec3(10, -20, 30) * 1e-3) << "micrometres";
  EXPECT_EQ(frame(3).axes[1], Vec3(0, -2, 0) * 1e-3);
  EXPECT_EQ(frame(0).origin, Vec3(10, -20, 30)) << "unknown";
  std::string bytes = test::nifti_sample();
  bytes[123] = 5;
  EXPECT_THAT(refused("a.nii", bytes), HasSubstr("xyzt_units 5"));
}

// The sample with an sform and a qform of these codes; the qform is half a turn about z and begins elsewhere.
std::string with_codes(std::int16_t sform, std::int16_t qform) {
  std::string bytes = test::nifti_sample();
  test::put(bytes, 254, sform);
  test::put(bytes, 252, qform);
  const std::array<float, 6> values = {0, 0, 1, 7, 8, 9};
  for (std::size_t i = 0; i < 6; ++i) test::put<float>(bytes, 256 + 4 * i, values.at(i));
  return bytes;
}

TEST_F(Nifti, LiesWhereItkAndSlicerSee) {
  const auto frame = [&](std::int16_t sform, std::int16_t qform) {
    return read_volume(folder_.write("a.nii", with_codes(sform, qform))).lattice().frame;
  };
  for (const auto& codes : std::vector<std::array<std::int16_t, 2>>{{1, 0}, {1, 1}, {1, 4}, {2, 0}, {4, 0}})
    EXPECT_EQ(frame(codes[0], codes[1]).origin, Vec3(10, -20, 30)) << "sform " << codes[0] << " " << codes[1];
  for (const auto& codes : std::vector<std::array<std::int16_t, 2>>{{0, 1}, {2, 1}, {4, 2}, {0, 4}}) {
    const IndexToWorld qform = frame(codes[0], codes[1]);
    EXPECT_EQ(qform.origin, Vec3(-7, -8, 9)) << "qform " << codes[0] << " " << codes[1];
    EXPECT_EQ(qform.axes, Mat3(0.5, 0, 0, 0, 2, 0, 0, 0, 4)) << "half a turn, then RAS to LPS";
  }
  EXPECT_EQ(frame(0, 0).axes, Mat3(0.5, 0, 0, 0, 2, 0, 0, 0, 4)) << "without either the axes are the world's";
  EXPECT_EQ(frame(0, 0).origin, Vec3(0));
}

TEST_F(Nifti, SaysWhereItsFormsContradictEachOther) {
  const auto remarks = [&](const std::string& bytes) { return read_volume(folder_.write("a.nii", bytes)).remarks; };
  EXPECT_THAT(remarks(with_codes(1, 4)), ::testing::ElementsAre(::testing::AllOf(
                                             HasSubstr("a.nii: its sform (code 1) and its qform (code 4) place"),
                                             HasSubstr("the sform is used"))));
  EXPECT_THAT(remarks(with_codes(2, 1)), ::testing::ElementsAre(HasSubstr("the qform is used")));
  EXPECT_TRUE(remarks(with_codes(0, 1)).empty());
  EXPECT_TRUE(remarks(with_codes(2, 0)).empty());
  // The same place, but for a part of the smallest edge, .5.
  for (const auto& [off, count] : {std::pair(0.0f, 0u), {0.004f, 0u}, {0.006f, 1u}}) {
    std::string bytes = with_codes(1, 1);
    const std::array<float, 6> values = {0, 0, 0, -10.0f + off, 20, 30};
    for (std::size_t i = 0; i < 6; ++i) test::put<float>(bytes, 256 + 4 * i, values.at(i));
    EXPECT_EQ(remarks(bytes).size(), count) << off;
  }
  std::string spoiled = with_codes(2, 1);
  test::put<float>(spoiled, 280, std::nanf(""));
  EXPECT_THAT(remarks(spoiled), ::testing::ElementsAre(
                                    HasSubstr("its sform (code 2) gives corners no finite places: the qform is used")));
  spoiled = with_codes(1, 4);
  test::put<float>(spoiled, 256, std::nanf(""));
  EXPECT_THAT(remarks(spoiled), ::testing::ElementsAre(HasSubstr("its qform (code 4) gives corners no finite places")));
}

TEST_F(Nifti, TurnsByItsQuaternionAndMirrorsByItsQfac) {
  std::string bytes = with_codes(0, 1);
  test::put<float>(bytes, 76, -1.0f);
  // A third of a turn about (1, 1, 1): x to y, y to z, z to x.
  for (std::size_t i = 0; i < 3; ++i) test::put<float>(bytes, 256 + 4 * i, 0.5f);
  EXPECT_EQ(read_volume(folder_.write("a.nii", bytes)).lattice().frame.axes, Mat3(0, -0.5, 0, 0, 0, 2, 4, 0, 0));
  test::put<float>(bytes, 256, 1.5f);
  EXPECT_THAT(refused("a.nii", bytes), HasSubstr("the qform's quaternion 1.5 0.5 0.5"));
}

TEST_F(Nifti, KeepsTheShearOfItsSform) {
  std::string bytes = test::nifti_sample();
  test::put<float>(bytes, 284, 0.5f);
  EXPECT_EQ(read_volume(folder_.write("a.nii", bytes)).lattice().frame.axes[1], Vec3(-0.5, -2, 0));
}

// ITK's search for a rotation that is near such a matrix has no end.
TEST_F(Nifti, IsRefusedWhereTheSformIsSpoiled) {
  std::string bytes = test::nifti_sample();
  test::put<std::uint32_t>(bytes, 304, 0xFF000000u);
  EXPECT_THAT(refused("a.nii", bytes), HasSubstr("the sform's axis 2 is"));
  bytes = test::nifti_sample();
  test::put<float>(bytes, 280, 0.0f);
  EXPECT_THAT(refused("a.nii", bytes), HasSubstr("the sform's axis 0 is 0 long, pixdim says 0.5"));
}

TEST_F(Nifti, IsRefusedWhereItsCheckSumIsWrong) {
  std::string packed = test::gzipped(test::nifti_sample());
  packed[packed.size() - 8] ^= 1;
  EXPECT_THAT(refused("a.nii.gz", packed), HasSubstr("damaged"));
}

TEST_F(Nifti, IsRefusedWhereItIsHostile) {
  const auto with = [&](std::size_t offset, auto value) {
    std::string bytes = test::nifti_sample();
    test::put(bytes, offset, value);
    const std::string packed = test::gzipped(bytes);
    std::string message = refused("a.nii", bytes);
    EXPECT_FALSE(refused("b.nii.gz", packed).empty());
    return message;
  };
  const float nan = std::nanf("");
  EXPECT_THAT(refused("a.nii", test::nifti_sample().substr(0, 370)), HasSubstr("24 bytes of data expected, 18 found"));
  EXPECT_THAT(refused("a.nii.gz", test::gzipped(test::nifti_sample().substr(0, 370))),
              HasSubstr("24 bytes expected, 18 found"));
  const std::string packed = test::gzipped(test::nifti_sample());
  EXPECT_THAT(refused("a.nii.gz", packed.substr(0, packed.size() - 20)), HasSubstr("24 bytes expected, "));
  EXPECT_THAT(refused("a.nii", "nothing of the kind"), HasSubstr("no NIfTI file"));
  EXPECT_THAT(with(40, std::int16_t(9)), HasSubstr("allowed is 1 to 7"));
  EXPECT_THAT(with(42, std::int16_t(-3)), HasSubstr("allowed is 1 to"));
  EXPECT_THAT(with(42, std::int16_t(32767)), HasSubstr("bytes of data expected"));
  EXPECT_THAT(with(70, std::int16_t(128)), HasSubstr("datatype 128"));
  EXPECT_THAT(with(72, std::int16_t(8)), HasSubstr("bitpix is 8"));
  EXPECT_THAT(with(80, 0.0f), HasSubstr("other than 0"));
  EXPECT_THAT(with(80, nan), HasSubstr("finite numbers"));
  EXPECT_THAT(with(108, nan), HasSubstr("vox_offset is nan"));
  EXPECT_THAT(with(108, 1e30f), HasSubstr("vox_offset"));
  EXPECT_THAT(with(108, 353.0f), HasSubstr("24 bytes of data expected, 23 found"));
  EXPECT_THAT(with(116, nan), HasSubstr("intensity scaling"));
  EXPECT_THAT(with(280, nan), HasSubstr("the sform"));
}

TEST_F(Nifti, IsRefusedAsATimeSeries) {
  std::string bytes = test::nifti_sample();
  test::put<std::int16_t>(bytes, 40, 4);
  test::put<std::int16_t>(bytes, 46, 1);
  test::put<std::int16_t>(bytes, 48, 2);
  EXPECT_THAT(refused("a.nii", bytes),
              HasSubstr("a.nii: 2 volumes along the axes behind the third: --set-reader nifti.frame=K"));
  for (const std::int16_t size : {0, -5}) {
    test::put<std::int16_t>(bytes, 48, size);
    EXPECT_THAT(refused("a.nii", bytes), HasSubstr(fmt::format("sizes 3 2 1 {}", size)));
  }
}

}  // namespace
}  // namespace isolux
