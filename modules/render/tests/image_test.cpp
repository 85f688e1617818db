// Pictures as files.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>

#include <filesystem>

namespace isolux {
namespace {

TEST(WritePng, TellsThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  EXPECT_THROW(write_png(Image(20, 10), "/dev/full"), IoError);
  EXPECT_THROW(write_png(Image(20, 10), "no/such/folder/a.png"), IoError);
}

TEST(WritePng, RefusesMorePixelsThanItCanCount) {
  EXPECT_NO_THROW(require_png_size(16384, 16384));
  EXPECT_THROW(require_png_size(20000, 20000), InvalidInput);
  EXPECT_THROW(require_png_size(2147483647, 2147483647), InvalidInput);
}

TEST(WritePng, RefusesCoverageOfOtherPixels) {
  Image image(20, 10);
  image.coverage.assign(199, 1.0f);
  EXPECT_THROW(write_png(image, "never-written.png"), InvalidInput);
  EXPECT_THROW(require_png_size(17000, 17000, 4), InvalidInput);
  EXPECT_NO_THROW(require_png_size(17000, 17000));
}

TEST(Images, OfNoSizeAreRefused) {
  EXPECT_THROW(Image(-1, 5), InvalidInput);
  EXPECT_THROW(Image(5, -1), InvalidInput);
  EXPECT_THROW(Image(2147483647, 2147483647), InvalidInput) << "more than addresses reach";
  EXPECT_TRUE(Image(0, 5).pixels.empty());
  EXPECT_THROW((void)side_by_side(Image(2, 1), Image(1, 2), 2147483647, Vec3f(1.0f)), InvalidInput);
}

TEST(Images, StandSideBySideWithTheirCoverage) {
  Image clear(2, 1, Vec3f(0.5f));
  clear.coverage = {0.0f, 1.0f};
  const Image both = side_by_side(clear, Image(1, 2, Vec3f(0.25f)), 1, Vec3f(1.0f));
  EXPECT_EQ(both.coverage, (std::vector<float>{0, 1, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(both.at(3, 1), Vec3f(0.25f));
  EXPECT_TRUE(side_by_side(Image(1, 1), Image(1, 1), 1, Vec3f(1.0f)).coverage.empty());
}

TEST(Srgb, CodesAndLinearValuesAreInverse) {
  for (int code = 0; code < 256; ++code) EXPECT_EQ(int(srgb_code(linear_value(std::uint8_t(code)))), code);
}

}  // namespace
}  // namespace isolux
