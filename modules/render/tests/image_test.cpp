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

}  // namespace
}  // namespace isolux
