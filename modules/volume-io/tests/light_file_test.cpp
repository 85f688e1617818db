#include "support.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>
#include <limits>

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

/// Numbers that tell side, kind, texel and channel: i and i + .25 outside, i + .5 and i + .75 inside; along the
/// normal's axes thousands more.
LightFile example_of_both(int channels, bool sloped, bool turned = false) {
  LightFile light = example(channels);
  for (std::size_t i = 0; i < light.grid.values.size(); ++i) light.grid.values[i] = float(i);
  light.inner = light.grid;
  for (float& v : light.inner->values) v += 0.5f;
  for (IlluminationGrid* side : {&light.grid, &*light.inner})
    for (std::size_t a = 0; turned && a < 3; ++a)
      for (const float v : side->values) side->detail.normal_slopes[a].push_back(v + 1000.0f * float(a + 1));
  if (!sloped) return light;
  for (IlluminationGrid* side : {&light.grid, &*light.inner}) {
    for (const float v : side->values) side->detail.slopes.push_back(v + 0.25f);
    const float inside = side == &light.grid ? 0.0f : 1.0f;
    side->detail.near_field = {{.step = 1.0f - 2.0f * inside, .mean = 0.125f + inside, .weight = Vec3f(0.1f)}};
    side->detail.ceiling = 1.5f + inside;
  }
  return light;
}

// Whoever knows near-field terms of reduced texels alone must not find these, and then has plain light.
TEST(LightFile, KeepsTheNearFieldOfTexelsOwnLightUnderItsOwnName) {
  const test::TemporaryFolder folder;
  LightFile light = example_of_both(1, false);
  for (IlluminationGrid* side : {&light.grid, &*light.inner}) {
    side->detail.near_field = {{.step = side == &light.grid ? 1.0f : -1.0f, .mean = 0.9f, .weight = Vec3f(0.1f)}};
    side->detail.texel_light = TexelLight::kOwn;
    side->detail.ceiling = 0.75f;
  }
  write_light(light, folder.file("l.nrrd"), "left-posterior-superior");
  LightFile back = read_light(folder.file("l.nrrd"));
  EXPECT_EQ(back.metadata.count("isolux.near_field"), 0U);
  EXPECT_EQ(back.metadata.count("isolux.inner.near_field"), 0U);
  EXPECT_EQ(back.metadata.at("isolux.own_near_field"), "1 0.9 0.1 0.1 0.1");
  for (const IlluminationGrid* side : {&back.grid, &*back.inner}) {
    ASSERT_EQ(side->detail.near_field.size(), 1U);
    EXPECT_EQ(side->detail.near_field[0].step, side == &back.grid ? 1.0f : -1.0f);
    EXPECT_EQ(side->detail.texel_light, TexelLight::kOwn);
    EXPECT_EQ(side->detail.ceiling, 0.75f);
  }
  // Written again as another kind, it is of that kind alone.
  back.grid.detail.texel_light = TexelLight::kReduced;
  back.inner->detail.near_field.clear();
  write_light(back, folder.file("l.nrrd"), "left-posterior-superior");
  const LightFile again = read_light(folder.file("l.nrrd"));
  EXPECT_EQ(again.grid.detail.texel_light, TexelLight::kReduced);
  EXPECT_EQ(again.metadata.count("isolux.own_near_field"), 0U);
  EXPECT_TRUE(again.inner->detail.near_field.empty());
}

TEST(LightFile, RoundTripsBothSides) {
  const test::TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    for (const int kind : {0, 1, 2, 3}) {
      const LightFile light = example_of_both(channels, (kind & 1) != 0, (kind & 2) != 0);
      write_light(light, folder.file("l.nrrd"), "left-posterior-superior");
      const LightFile back = read_light(folder.file("l.nrrd"));
      ASSERT_TRUE(back.inner.has_value());
      EXPECT_EQ(back.metadata.at("isolux.sides"), "both");
      const auto expect_equal = [&](const IlluminationGrid& read, const IlluminationGrid& written) {
        EXPECT_EQ(read.channels, channels);
        EXPECT_EQ(read.values, written.values);
        EXPECT_EQ(read.detail.slopes, written.detail.slopes);
        EXPECT_EQ(read.detail.normal_slopes, written.detail.normal_slopes);
        EXPECT_EQ(read.detail.ceiling, written.detail.ceiling);
        ASSERT_EQ(read.detail.near_field.size(), written.detail.near_field.size());
        for (std::size_t t = 0; t < read.detail.near_field.size(); ++t) {
          EXPECT_EQ(read.detail.near_field[t].step, written.detail.near_field[t].step);
          EXPECT_EQ(read.detail.near_field[t].mean, written.detail.near_field[t].mean);
        }
        EXPECT_EQ(read.lattice.frame.axes, written.lattice.frame.axes);
      };
      expect_equal(light_of_side(back, LevelSetSide::kOuter, "l.nrrd"), light.grid);
      expect_equal(light_of_side(back, LevelSetSide::kInner, "l.nrrd"), *light.inner);
    }
  }
}

TEST(LightFile, RoundTripsNormalSlopesOfOneSide) {
  const test::TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    for (const bool sloped : {false, true}) {
      LightFile light = example_of_both(channels, sloped, true);
      light.inner.reset();
      write_light(light, folder.file("l.nrrd"), "left-posterior-superior");
      EXPECT_THAT(test::read_file(folder.file("l.nrrd")),
                  HasSubstr("\nsizes: " + std::to_string(channels * (sloped ? 5 : 4)) + " 4 3 2\n"));
      const LightFile back = read_light(folder.file("l.nrrd"));
      EXPECT_FALSE(back.inner.has_value());
      EXPECT_EQ(back.grid.values, light.grid.values);
      EXPECT_EQ(back.grid.detail.slopes, light.grid.detail.slopes);
      EXPECT_EQ(back.grid.detail.normal_slopes, light.grid.detail.normal_slopes);
    }
  }
}

// The first texel of a file: outer values, outer slopes, inner values, inner slopes, so that what a program takes for
// the first channels is the outer side's light.
TEST(LightFile, HasTheInnerSideBehindTheOuter) {
  const test::TemporaryFolder folder;
  const auto first_texel = [&](int channels, bool sloped, const char* sizes, bool turned = false) {
    write_light(example_of_both(channels, sloped, turned), folder.file("l.nrrd"), "left-posterior-superior");
    const std::string text = test::read_file(folder.file("l.nrrd"));
    EXPECT_THAT(text, HasSubstr(sizes));
    EXPECT_THAT(text, HasSubstr("\nkinds: vector domain domain domain\n"));
    EXPECT_THAT(text, HasSubstr("\nisolux.sides:=both\n"));
    std::vector<float> numbers(std::size_t(channels) * (turned ? 10 : sloped ? 4 : 2));
    std::memcpy(numbers.data(), text.data() + text.find("\n\n") + 2, numbers.size() * sizeof(float));
    return numbers;
  };
  EXPECT_EQ(first_texel(1, false, "\nsizes: 2 4 3 2\n"), (std::vector<float>{0, 0.5f}));
  EXPECT_EQ(first_texel(1, true, "\nsizes: 4 4 3 2\n"), (std::vector<float>{0, 0.25f, 0.5f, 0.75f}));
  EXPECT_EQ(first_texel(3, false, "\nsizes: 6 4 3 2\n"), (std::vector<float>{0, 1, 2, 0.5f, 1.5f, 2.5f}));
  EXPECT_EQ(first_texel(3, true, "\nsizes: 12 4 3 2\n"),
            (std::vector<float>{0, 1, 2, 0.25f, 1.25f, 2.25f, 0.5f, 1.5f, 2.5f, 0.75f, 1.75f, 2.75f}));
  EXPECT_EQ(first_texel(1, true, "\nsizes: 10 4 3 2\n", true),
            (std::vector<float>{0, 0.25f, 1000, 2000, 3000, 0.5f, 0.75f, 1000.5f, 2000.5f, 3000.5f}));
}

TEST(LightFile, TellsSidesFromSlopesByItsKey) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& pair, const std::string& sizes, const std::string& data) {
    return read_light(folder.write(
        "l.nrrd", "NRRD0005\ntype: uint8\ndimension: 4\nsizes: " + sizes + "\nencoding: raw\n" + pair + "\n" + data));
  };
  const LightFile sloped = read("", "2 1 1 1", "\1\2");
  EXPECT_FALSE(sloped.inner.has_value());
  EXPECT_EQ(sloped.grid.detail.slopes, std::vector<float>{2});
  EXPECT_THAT(test::error_of([&] { (void)light_of_side(sloped, LevelSetSide::kInner, "l.nrrd"); }),
              HasSubstr("l.nrrd: it holds light of the outer side alone"));
  const LightFile both = read("isolux.sides:=both\n", "2 1 1 1", "\1\2");
  ASSERT_TRUE(both.inner.has_value());
  EXPECT_TRUE(both.grid.detail.slopes.empty());
  EXPECT_EQ(both.inner->values, std::vector<float>{2});
  EXPECT_THAT(test::error_of([&] { (void)read("isolux.sides:=both\n", "3 1 1 1", "abc"); }),
              HasSubstr("2, 4, 6 or 12 for both sides"));
  EXPECT_THAT(test::error_of([&] { (void)read("isolux.sides:=left\n", "2 1 1 1", "ab"); }),
              HasSubstr("allowed are outer, both"));
}

// Four or five channels are light only where the file says so: somebody's RGBA picture is none.
TEST(LightFile, TakesNormalSlopesOnlyByTheirKey) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& pairs, const std::string& size, const std::string& data) {
    return read_light(folder.write("l.nrrd", "NRRD0005\ntype: uint8\ndimension: 4\nsizes: " + size +
                                                 " 1 1 1\nencoding: raw\n" + pairs + "\n" + data));
  };
  const LightFile five = read("isolux.texel_numbers:=value slope normal\n", "5", "\1\2\3\4\5");
  EXPECT_EQ(five.grid.values, std::vector<float>{1});
  EXPECT_EQ(five.grid.detail.slopes, std::vector<float>{2});
  EXPECT_EQ(five.grid.detail.normal_slopes[2], std::vector<float>{5});
  const LightFile four = read("isolux.texel_numbers:=value normal\n", "4", "\1\2\3\4");
  EXPECT_TRUE(four.grid.detail.slopes.empty());
  EXPECT_EQ(four.grid.detail.normal_slopes[0], std::vector<float>{2});
  EXPECT_THAT(test::error_of([&] { (void)read("", "5", "abcde"); }), HasSubstr("2, 3 or 6"));
  EXPECT_THAT(test::error_of([&] { (void)read("isolux.texel_numbers:=value normal\n", "5", "abcde"); }),
              HasSubstr("4 or 12"));
  EXPECT_THAT(test::error_of([&] { (void)read("isolux.texel_numbers:=value hue\n", "5", "abcde"); }),
              HasSubstr("allowed are value slope normal, value normal"));
}

// They would make infinities of light, and numbers that are none.
TEST(LightFile, RefusesNumbersThatNoLightHas) {
  const test::TemporaryFolder folder;
  for (const std::string side : {"isolux.", "isolux.inner."}) {
    const auto why = [&](const std::string& name, const std::string& value) {
      const std::string path =
          folder.write("l.nrrd", "NRRD0005\ntype: uint8\ndimension: 4\nsizes: 2 1 1 1\n" +
                                     ("encoding: raw\nisolux.sides:=both\n" + side) + name + ":=" + value + "\n\nab");
      const std::string message = test::error_of([&] { (void)read_light(path); });
      EXPECT_THAT(message, ::testing::AnyOf("", ::testing::StartsWith(path + ": " + side + name + " ")));
      return message;
    };
    for (const char* ceiling : {"-1", "-1e-30", "1e39", "-1e39", "inf", "nan"})
      EXPECT_THAT(why("light_ceiling", ceiling), HasSubstr(fmt::format("'{}': allowed ", ceiling)));
    for (const char* ceiling : {"0", "1e-40", "3.4e38"}) EXPECT_EQ(why("light_ceiling", ceiling), "");
    for (const std::string name : {"near_field", "own_near_field"}) {
      for (const char* step : {"0", "-0", "1e-320", "-1e-38", "1e-7", "2e6", "-3e38"})
        EXPECT_THAT(why(name, fmt::format("1 .5 .1 .1 .1; {} .5 .1 .1 .1", step)),
                    HasSubstr("allowed are 1e-06 to 1e+06 and their negatives"))
            << step;
      for (const char* five : {"1 nan .1 .1 .1", "1 .5 inf .1 .1", "1e39 .5 .1 .1 .1", "1 .5 1e39 .1 .1"})
        EXPECT_THAT(why(name, five), HasSubstr("terms of five numbers"));
      EXPECT_EQ(why(name, "-1.5 .5 .1 .1 .1; 2 -.5 .1 .1 .1"), "");
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

TEST(LightFile, RefusesRangesThatHoldNoIsovalue) {
  const test::TemporaryFolder folder;
  const std::string head = "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\nisolux.iso_range:=";
  for (const char* range : {"1e39:2e39", "-1e39:0", "1:0.5", "nan:1", "0:inf"})
    EXPECT_NE(test::error_of([&] { (void)read_light(folder.write("l.nrrd", head + range + "\n\na")); }), "") << range;
  EXPECT_EQ(read_light(folder.write("l.nrrd", head + "1:1\n\na")).grid.detail.isovalues->low, 1.0f);
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

TEST(LightFile, RefusesToWriteSlopesOfSomeTexels) {
  const test::TemporaryFolder folder;
  const auto refuses = [&](auto spoil) {
    LightFile light = example_of_both(1, true, true);
    spoil(light);
    EXPECT_THAT(test::error_of([&] { write_light(light, folder.file("l.nrrd"), ""); }), HasSubstr("slopes"));
    EXPECT_FALSE(std::filesystem::exists(folder.file("l.nrrd")));
  };
  refuses([](LightFile& light) { light.grid.detail.slopes.pop_back(); });
  refuses([](LightFile& light) { light.grid.detail.normal_slopes[2].clear(); });
  refuses([](LightFile& light) { light.inner->detail.normal_slopes[1].pop_back(); });
}

// ITK's own NRRD reader is not among those that isolux links; teem's rules for it are those of the layout test above.
TEST(LightFile, IsAVolumeTooWhenGrey) {
  const test::TemporaryFolder folder;
  write_light(example(1), folder.file("l.nrrd"), "RAS");
  EXPECT_EQ(test::values_of(read_volume(folder.file("l.nrrd"))), example(1).grid.values);
}

TEST(LightFile, KeepsTheRangeThatWasLit) {
  const test::TemporaryFolder folder;
  LightFile light = example(1);
  light.grid.detail.isovalues = ValueRange{.low = 0.1f, .high = 0.7f};
  write_light(light, folder.file("l.nrrd"), "left-posterior-superior");
  const LightFile back = read_light(folder.file("l.nrrd"));
  ASSERT_TRUE(back.grid.detail.isovalues);
  EXPECT_EQ(back.grid.detail.isovalues->low, 0.1f);
  EXPECT_EQ(back.grid.detail.isovalues->high, 0.7f);
  // An open end is as good as the largest number.
  light.grid.detail.isovalues->low = -std::numeric_limits<float>::infinity();
  write_light(light, folder.file("l.nrrd"), "left-posterior-superior");
  EXPECT_TRUE(read_light(folder.file("l.nrrd")).grid.detail.covers(-1e38));
}

}  // namespace
}  // namespace isolux
