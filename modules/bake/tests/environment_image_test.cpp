// Environment pictures against what their formats' definitions say. The files are written here, byte by byte.
#include <ImfRgbaFile.h>
#include <gtest/gtest.h>
#include <isolux/bake/scene_file.h>
#include <isolux/core/error.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace isolux {
namespace {

/// A file that is gone with the test.
class Picture {
 public:
  Picture(const std::string& extension, const std::string& content)
      : path_(::testing::TempDir() + "isolux_picture_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + extension) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  ~Picture() { std::filesystem::remove(path_); }

  [[nodiscard]] ImageEnvironment read() const { return read_environment_image(path_); }
  /// The message that refuses it, or nothing.
  [[nodiscard]] std::string refusal() const {
    try {
      (void)read();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

 private:
  std::string path_;
};

struct PixelBox {
  std::int32_t left, top, right, bottom;  ///< all inclusive
};

/// An uncompressed OpenEXR file of floats, which holds y in green and x in red unless its channels have other names.
/// This machine is little endian.
std::string exr(const PixelBox& data, const PixelBox& display, const std::string& more_attributes = {},
                float brightness = 1.0f, const std::array<const char*, 3>& names = {"B", "G", "R"}) {
  const auto raw = [](const auto& value) { return std::string(reinterpret_cast<const char*>(&value), sizeof(value)); };
  const auto name = [](const char* text) { return std::string(text) + '\0'; };
  const auto attribute = [&](const char* what, const char* type, const std::string& value) {
    return name(what) + name(type) + raw(std::int32_t(value.size())) + value;
  };
  std::string channels;
  for (const char* channel : names)
    channels +=
        name(channel) + raw(std::int32_t(2)) + std::string(4, '\0') + raw(std::int32_t(1)) + raw(std::int32_t(1));
  std::string file =
      raw(std::int32_t(20000630)) + raw(std::int32_t(2)) + more_attributes +
      attribute("channels", "chlist", channels + '\0') + attribute("compression", "compression", std::string(1, '\0')) +
      attribute("dataWindow", "box2i", raw(data)) + attribute("displayWindow", "box2i", raw(display)) +
      attribute("lineOrder", "lineOrder", std::string(1, '\0')) + attribute("pixelAspectRatio", "float", raw(1.0f)) +
      attribute("screenWindowCenter", "v2f", raw(std::int64_t(0))) +
      attribute("screenWindowWidth", "float", raw(1.0f)) + '\0';
  const int width = data.right - data.left + 1;
  const int height = data.bottom - data.top + 1;
  const std::size_t row = std::size_t(width) * 12;
  for (int y = 0; y < height; ++y)
    file += raw(std::uint64_t(file.size() + std::size_t(height - y) * 8 + std::size_t(y) * (row + 8)));
  for (int y = data.top; y <= data.bottom; ++y) {
    file += raw(std::int32_t(y)) + raw(std::int32_t(row));
    for (int x = 0; x < width; ++x) file += raw(brightness * 0.5f);
    for (int x = 0; x < width; ++x) file += raw(brightness * float(100 + y));
    for (int x = data.left; x <= data.right; ++x) file += raw(brightness * float(100 + x));
  }
  return file;
}

void expect_display_window(const PixelBox& data, const PixelBox& display) {
  const ImageEnvironment image = Picture(".exr", exr(data, display)).read();
  ASSERT_EQ(image.width, display.right - display.left + 1);
  ASSERT_EQ(image.height, display.bottom - display.top + 1);
  auto pixel = image.pixels.begin();
  for (int y = display.top; y <= display.bottom; ++y) {
    for (int x = display.left; x <= display.right; ++x) {
      const bool held = x >= data.left && x <= data.right && y >= data.top && y <= data.bottom;
      EXPECT_EQ(*pixel++, held ? Vec3f(float(100 + x), float(100 + y), 0.5f) : Vec3f(0.0f)) << x << ' ' << y;
    }
  }
}

TEST(ExrEnvironment, IsTheDisplayWindowBlackWithoutData) {
  expect_display_window({0, 0, 11, 5}, {0, 0, 11, 5});
  expect_display_window({-3, 5, 8, 10}, {-3, 5, 8, 10});
  expect_display_window({0, 0, 11, 5}, {0, 0, 11, 11});
  expect_display_window({-2, 4, 3, 6}, {-5, 1, 6, 8});
}

TEST(ExrEnvironment, MayBeBrighterThanHalfFloatsTell) {
  const ImageEnvironment image = Picture(".exr", exr({0, 0, 3, 1}, {0, 0, 3, 1}, {}, 1e6f)).read();
  EXPECT_EQ(image.pixels[5], Vec3f(101e6f, 101e6f, 0.5e6f));
}

TEST(ExrEnvironment, MayBeGreyOrLackChannels) {
  const auto of = [](const std::array<const char*, 3>& names) {
    return Picture(".exr", exr({0, 0, 3, 1}, {0, 0, 3, 1}, {}, 1.0f, names));
  };
  EXPECT_EQ(of({"A", "Y", "Z"}).read().pixels[6], Vec3f(101.0f));
  EXPECT_EQ(of({"A", "G", "Z"}).read().pixels[6], Vec3f(0.0f, 101.0f, 0.0f));
  EXPECT_NE(of({"A", "Z", "left.R"}).refusal().find("R, G, B or Y"), std::string::npos);
}

TEST(ExrEnvironment, MayBeLuminanceAndChroma) {
  const std::string path = ::testing::TempDir() + "isolux_chroma.exr";
  {
    const std::vector<Imf::Rgba> pixels(8 * 4, Imf::Rgba(0.75f, 0.5f, 0.25f));
    Imf::RgbaOutputFile file(path.c_str(), 8, 4, Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, 8);
    file.writePixels(4);
  }
  const ImageEnvironment image = read_environment_image(path);
  std::filesystem::remove(path);
  ASSERT_EQ(image.pixels.size(), 32u);
  for (const Vec3f& p : image.pixels) {
    EXPECT_NEAR(p.x, 0.75f, 2e-3f);
    EXPECT_NEAR(p.y, 0.5f, 2e-3f);
    EXPECT_NEAR(p.z, 0.25f, 2e-3f);
  }
}

TEST(ExrEnvironment, LeavesOutDataBeyondTheDisplayWindow) {
  expect_display_window({-4, -3, 15, 9}, {0, 0, 11, 5});
  expect_display_window({-4, 3, 5, 9}, {0, 0, 11, 5});  // over one corner
}

TEST(ExrEnvironment, IsRefusedWhereNothingIsLeftOfIt) {
  EXPECT_NE(Picture(".exr", exr({20, 0, 25, 3}, {0, 0, 11, 5})).refusal().find("nothing is left"), std::string::npos);
}

TEST(ExrEnvironment, AsksForNoMoreMemoryThanTheFileIsWorth) {
  EXPECT_NE(Picture(".exr", exr({0, 0, 1, 1}, {0, 0, 29999, 29999})).refusal().find("empty but for 2x2"),
            std::string::npos);
  EXPECT_NE(Picture(".exr", exr({0, 0, 1, 1}, {-1'000'000'000, 0, 1'000'000'000, 2})).refusal().find("2^30 pixels"),
            std::string::npos);
}

TEST(ExrEnvironment, IsNoCubeMap) {
  using namespace std::string_literals;
  const auto map = [](char kind) { return "envmap\0envmap\0\1\0\0\0"s + kind; };
  EXPECT_EQ(Picture(".exr", exr({0, 0, 3, 1}, {0, 0, 3, 1}, map('\0'))).read().width, 4);
  EXPECT_NE(Picture(".exr", exr({0, 0, 3, 23}, {0, 0, 3, 23}, map('\1'))).refusal().find("cube map"),
            std::string::npos);
}

/// A Radiance picture of 2 x 1 pixels, (1, 2, 4) and (.5, .5, .5), with more lines in its header.
std::string radiance(const std::string& lines, const std::string& format = "FORMAT=32-bit_rle_rgbe\n",
                     const std::string& order = "-Y 1 +X 2\n") {
  return "#?RADIANCE\n" + lines + format + "\n" + order + "\x20\x40\x80\x83\x40\x40\x40\x80";
}

TEST(RadianceEnvironment, DividesItsExposuresOut) {
  const auto first_pixel = [](const std::string& lines) {
    return Picture(".hdr", radiance(lines)).read().pixels.at(0);
  };
  EXPECT_EQ(first_pixel(""), Vec3f(1, 2, 4));
  EXPECT_EQ(first_pixel("EXPOSURE=2\n"), Vec3f(0.5, 1, 2));
  EXPECT_EQ(first_pixel("EXPOSURE=  +2.0e+00 \nSOFTWARE=x\nEXPOSURE=.25\n"), Vec3f(2, 4, 8));
  EXPECT_EQ(first_pixel("COLORCORR=1 2 4\n"), Vec3f(1, 1, 1));
  EXPECT_EQ(first_pixel("COLORCORR= .5\t1 2\nEXPOSURE=2\n"), Vec3f(1, 1, 1));
  // Of a picture that went into this one, and of somebody's notes.
  EXPECT_EQ(first_pixel("a.hdr:\n\tEXPOSURE=8\n# EXPOSURE=8\nMYEXPOSURE=8\nexposure=8\n"), Vec3f(1, 2, 4));
}

TEST(RadianceEnvironment, RefusesExposuresThatAreNone) {
  for (const char* line : {"EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=inf", "EXPOSURE=nan", "EXPOSURE=", "EXPOSURE=two",
                           "EXPOSURE=1 2", "EXPOSURE=1e999", "EXPOSURE=1,5", "EXPOSURE=+", "COLORCORR=1",
                           "COLORCORR=1 0 1", "COLORCORR=1 1 1 1", "COLORCORR=1 1 -1", "COLORCORR=1 1 x"})
    EXPECT_NE(Picture(".hdr", radiance(std::string(line) + "\n")).refusal().find(line), std::string::npos) << line;
  EXPECT_NE(Picture(".hdr", radiance("EXPOSURE=1e300\nEXPOSURE=1e300\n")).refusal().find("multiplied"),
            std::string::npos);
  // As bright as no float is.
  EXPECT_NE(Picture(".hdr", radiance("EXPOSURE=1e-300\n")).refusal().find("radiance is finite"), std::string::npos);
}

TEST(RadianceEnvironment, RefusesWhatIsReadWrongOtherwise) {
  const auto says = [](const std::string& content, const char* words) {
    EXPECT_NE(Picture(".hdr", content).refusal().find(words), std::string::npos)
        << Picture(".hdr", content).refusal() << " does not say " << words;
  };
  says(radiance("", "FORMAT=32-bit_rle_xyze\n"), "32-bit_rle_xyze");
  says(radiance("", "FORMAT=32-bit_rle_xyze\nFORMAT=32-bit_rle_rgbe\n"), "32-bit_rle_xyze");
  for (const char* order : {"+Y 1 +X 2", "-Y 1 -X 2", "+X 2 -Y 1", "-X 2 +Y 1"})
    says(radiance("", "FORMAT=32-bit_rle_rgbe\n", std::string(order) + "\n"), order);
  says(radiance(std::string(2'000'000, 'x') + "\nEXPOSURE=2\n"), "does not end");
  // A line that is no text stays on one line of the message.
  EXPECT_EQ(Picture(".hdr", radiance("EXPOSURE=\r\x1b[1m\n")).refusal().find_first_of("\r\x1b"), std::string::npos);
}

TEST(RadianceEnvironment, ThatBreaksOffIsRefused) {
  const std::string whole = radiance("EXPOSURE=2\n");
  for (std::size_t size = 11; size < whole.size(); ++size)
    EXPECT_FALSE(Picture(".hdr", whole.substr(0, size)).refusal().empty()) << size;
}

TEST(OtherEnvironment, WithoutPixelsIsRefusedByItsName) {
  const Picture picture(".pgm", "P5 2 0 255\nab");
  EXPECT_NE(picture.refusal().find(".pgm: an image of 2x0 pixels"), std::string::npos) << picture.refusal();
}

// The library read them beyond their end, and the others' bytes the wrong way round.
TEST(OtherEnvironment, OfWidePnmIsRefused) {
  for (const std::string magic : {"P5", "P6"}) {
    EXPECT_NE(Picture(".pnm", magic + " 2 1 256\n" + std::string(12, 'a')).refusal().find("16 bits"),
              std::string::npos);
    EXPECT_EQ(Picture(".pnm", magic + " 2 1 255\n" + std::string(6, 'a')).read().pixels.size(), 2u) << magic;
  }
}

TEST(OtherEnvironment, AsksForNoMoreMemoryThanTheFileIsWorth) {
  const Picture picture(".pgm", "P5 16000 16000 255\nabcd");
  EXPECT_NE(picture.refusal().find("23 bytes for 16000x16000 pixels"), std::string::npos) << picture.refusal();
}

TEST(SceneFile, KeepsAllDigitsOfLampPlaces) {
  const Scene scene = parse_scene(
      R"({"lights":[{"type":"sphere","center":[100000000.25,-16777217,0.1],"radius":2,"radiance":[1,1,1]},
                    {"type":"rectangle","center":[0.3,33554433,1e7],"u":[1,0,0],"v":[0,1,0],"radiance":[1,1,1]}]})",
      ".", "test");
  EXPECT_EQ(std::get<SphereLight>(scene.lights[0]).center, Vec3(100000000.25, -16777217.0, 0.1));
  EXPECT_EQ(std::get<RectangleLight>(scene.lights[1]).center, Vec3(0.3, 33554433.0, 1e7));
  const Scene again = parse_scene(scene_to_json(scene), ".", "test");
  EXPECT_EQ(std::get<SphereLight>(again.lights[0]).center, std::get<SphereLight>(scene.lights[0]).center);
  EXPECT_EQ(std::get<RectangleLight>(again.lights[1]).center, std::get<RectangleLight>(scene.lights[1]).center);
  EXPECT_THROW((void)parse_scene(R"({"lights":[{"type":"sphere","center":[1e39,0,0],"radius":2,"radiance":[1,1,1]}]})",
                                 ".", "test"),
               InvalidInput);
}

}  // namespace
}  // namespace isolux
