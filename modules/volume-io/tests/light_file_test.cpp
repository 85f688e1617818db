#include "support.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using testing::HasSubstr;

LightFile example(int channels) {
  LightFile light;
  const IndexToWorld frame{.origin = Vec3(0.1, 0.2, 0.3), .axes = Mat3(1, 0.5, 0, 0, -2, 0, 0, 0, 3)};
  light.grid = IlluminationGrid({.size = Index3(4, 3, 2), .frame = frame}, channels);
  for (std::size_t i = 0; i < light.grid.values.size(); ++i) light.grid.values[i] = float(i) / 7.0f;
  light.metadata = {
      {"isolux.scene", "{\"a\": \"\\n\"}\nsecond line := : # \\"}, {"isolux.version", "1"}, {"empty", ""}};
  return light;
}

TEST(LightFile, RoundTripsGreyAndColour) {
  const test::TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    for (const bool compress : {false, true}) {
      const LightFile light = example(channels);
      write_light(light, folder.file("l.nrrd"), "left-posterior-superior", {.compress = compress});
      const LightFile back = read_light(folder.file("l.nrrd"));
      EXPECT_EQ(back.grid.channels, channels);
      EXPECT_EQ(back.grid.values, light.grid.values);
      EXPECT_EQ(back.grid.lattice.size, light.grid.lattice.size);
      EXPECT_EQ(back.grid.lattice.frame.axes, light.grid.lattice.frame.axes);
      EXPECT_EQ(back.grid.lattice.frame.origin, light.grid.lattice.frame.origin);
      EXPECT_EQ(back.metadata, light.metadata);
    }
  }
}

TEST(LightFile, HasTheLayoutThatOtherReadersNeed) {
  const test::TemporaryFolder folder;
  write_light(example(3), folder.file("l.nrrd"), "left-posterior-superior");
  const std::string text = test::read_file(folder.file("l.nrrd"));
  EXPECT_THAT(text, HasSubstr("\nsizes: 3 4 3 2\n"));
  EXPECT_THAT(text, HasSubstr("\nkinds: vector domain domain domain\n"));
  EXPECT_THAT(text, HasSubstr("\nencoding: raw\n"));
  // VTK 9.1 goes wrong the other way round.
  EXPECT_LT(text.find("\nsizes:"), text.find("\nspace:"));
}

TEST(LightFile, RefusesOtherLayoutsAndKeys) {
  const test::TemporaryFolder folder;
  const auto four =
      folder.write("l.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 4 1 1 1\nencoding: raw\n\nabcd");
  EXPECT_THAT(test::error_of([&] { (void)read_light(four); }), HasSubstr("a light file has 3 axes"));
  LightFile light = example(1);
  light.grid.values[3] = std::numeric_limits<float>::infinity();
  write_light(light, folder.file("i.nrrd"), "");
  EXPECT_THAT(test::error_of([&] { (void)read_light(folder.file("i.nrrd")); }), HasSubstr("values are finite"));
  for (const auto* key : {"", "#c", "a:b", "a\nb"}) {
    light.metadata = {{key, "x"}};
    EXPECT_THAT(test::error_of([&] { write_light(light, folder.file("k.nrrd"), ""); }), HasSubstr("cannot be a key"));
    EXPECT_FALSE(std::filesystem::exists(folder.file("k.nrrd")));
  }
}

// ITK's own NRRD reader is not among those that isolux links; teem's rules for it are those of the layout test above.
TEST(LightFile, IsAVolumeTooWhenGrey) {
  const test::TemporaryFolder folder;
  write_light(example(1), folder.file("l.nrrd"), "RAS");
  EXPECT_EQ(test::values_of(read_volume(folder.file("l.nrrd"))), example(1).grid.values);
}

}  // namespace
}  // namespace isolux
