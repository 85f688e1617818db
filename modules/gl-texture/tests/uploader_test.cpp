#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/core/random.h>
#include <isolux/gl_texture.h>

#include <algorithm>
#include <string>
#include <vector>

#include "egl_context.h"
#include "gl_sampler.h"
#include "texels_of.h"

namespace isolux {
namespace {

Lattice unit_spacing(Index3 size) { return {.size = size, .frame = {}}; }

struct Case {
  std::string backend;
  std::string format;  ///< "" of a backend that has no such option
  int channels;
};

/// Largest error of storing e in [0, 1] in a format: 2^-11 relative, none, or half a step of 1/255, which is also the
/// most that one may be wrong by of which no more is known.
double storage_error(const std::string& format) {
  if (format == "float16") return 0x1p-12;
  return format == "float32" ? 0.0 : 0.5 / 255.0 + 1e-6;
}

/// Largest error of what a shader reads from such texels: bytes may be rounded after each of the three interpolations.
double read_error(const std::string& format) {
  if (format == "float16" || format == "float32") return 2.0 * storage_error(format);
  return 4 * 0.5 / 255.0;
}

/// The words of the option `format`, or one "" for what a backend stores by itself.
std::vector<std::string> formats_of(const BackendInfo& info) {
  for (const OptionInfo& option : info.options)
    if (option.name == "format" && !option.choices.empty()) return option.choices;
  return {""};
}

std::vector<Case> cases() {
  std::vector<Case> result;
  const Registry<TextureUploader> registry = uploaders();
  for (const BackendInfo& info : registry.backends()) {
    if (!info.unavailable.empty()) continue;
    for (const std::string& format : formats_of(info))
      for (const int channels : {1, 3}) result.push_back({info.name, format, channels});
  }
  return result;
}

class Uploader : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!context_) GTEST_SKIP() << context_.why();
    Settings settings;
    if (!GetParam().format.empty()) settings = {{"format", GetParam().format}};
    uploader_ = uploaders().create(GetParam().backend, settings);
  }
  [[nodiscard]] int channels() const { return GetParam().channels; }
  [[nodiscard]] double storage() const { return storage_error(GetParam().format); }
  [[nodiscard]] double reading() const { return read_error(GetParam().format); }

  test::EglContext context_;
  std::unique_ptr<TextureUploader> uploader_;
};

TEST_P(Uploader, ReadsBackWhatWasUploaded) {
  // Odd sizes: rows of 3 and 15 bytes are what a wrong unpack alignment breaks.
  IlluminationGrid light(unit_spacing({5, 3, 7}), channels());
  RandomStream random(1, 2);
  for (float& e : light.values) e = random.uniform_float();
  const Texture3D texture = uploader_->upload(light, light.lattice);
  EXPECT_EQ(texture.channels(), channels());
  ASSERT_EQ(texture.size(), light.lattice.size);
  const std::vector<float> back = test::texels_of(texture);
  for (std::size_t i = 0; i < back.size(); ++i) ASSERT_NEAR(back[i], light.values[i], storage()) << i;
}

TEST_P(Uploader, ReproducesALinearRampAtAnyRatioOnBothLattices) {
  const Lattice volume = unit_spacing({9, 5, 17});
  const test::GlSampler sampler;
  for (const Lattice& texels : {voxel_lattice(volume), cell_lattice(volume), cell_lattice(volume, {5, 3, 21}),
                                cell_lattice(volume, {23, 8, 11})}) {
    // e = (x + y + z)/3 of the place in the box, another order of the axes for each channel's weights.
    const auto ramp = [](const Vec3& place, int c) {
      return (place.x * (1 + c % 3) + place.y * (1 + (c + 1) % 3) + place.z * (1 + (c + 2) % 3)) / 6.0;
    };
    IlluminationGrid light(texels, channels());
    const IndexToWorld to_volume = index_to_index(texels, volume);
    std::size_t at = 0;
    for (int k = 0; k < texels.size.z; ++k)
      for (int j = 0; j < texels.size.y; ++j)
        for (int i = 0; i < texels.size.x; ++i)
          for (int c = 0; c < channels(); ++c)
            light.values[at++] = float(ramp(to_volume.world({i, j, k}) / Vec3(volume.size - 1), c));
    const Texture3D texture = uploader_->upload(light, volume);
    std::vector<Vec3f> places;
    RandomStream random(3, 4);
    // Beyond the outermost texel centres the texture is constant: the ramp is asked between them.
    for (int i = 0; i < 200; ++i) {
      Vec3f place;
      for (int a = 0; a < 3; ++a) {
        const float margin = float(0.5 / texels.size[a]);
        place[a] = margin + (1.0f - 2.0f * margin) * random.uniform_float();
      }
      places.push_back(place);
    }
    const std::vector<Vec3f> read = sampler.read(texture, places);
    // Hardware filters with weights of 8 bits, rounded or cut off: 1/256 of a texel step on each axis, the largest step
    // being 3/6 over the number of cells between texels; and float rounding of the coordinate.
    double filter = 1e-6;
    for (int a = 0; a < 3; ++a) filter += 0.5 / (texels.size[a] - 1) / 256.0;
    for (std::size_t i = 0; i < places.size(); ++i)
      for (int c = 0; c < channels(); ++c) ASSERT_NEAR(read[i][c], ramp(Vec3(places[i]), c), filter + reading());
  }
}

TEST_P(Uploader, AgreesWithTheLookUpOnTheProcessor) {
  const Lattice volume = unit_spacing({6, 7, 8});
  IlluminationGrid light(cell_lattice(volume), channels());
  RandomStream random(5, 6);
  for (float& e : light.values) e = random.uniform_float();
  const Texture3D texture = uploader_->upload(light, volume);
  std::vector<Vec3f> places(300);
  for (Vec3f& place : places)
    for (int a = 0; a < 3; ++a) place[a] = random.uniform_float();
  const std::vector<Vec3f> read = test::GlSampler().read(texture, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3f expected = light.at_world(Vec3(places[i]) * Vec3(volume.size - 1));
    for (int c = 0; c < 3; ++c) {
      // Weights of 8 bits on three axes, rounded or cut off, between values that differ by at most 1.
      ASSERT_NEAR(read[i][c], expected[c], 3.0 / 256.0 + reading());
    }
  }
}

TEST_P(Uploader, KeepsLightOfAnyBrightness) {
  for (const float brightness : {1e-30f, 1e-8f, 1e5f, 1e30f}) {
    IlluminationGrid light(unit_spacing({2, 2, 2}), channels());
    std::fill(light.values.begin(), light.values.end(), brightness);
    std::fill_n(light.values.begin(), channels(), 0.0f);
    const Texture3D texture = uploader_->upload(light, light.lattice);
    const std::vector<Vec3f> read = test::GlSampler().read(texture, {Vec3f(1.0f), Vec3f(0.0f)});
    EXPECT_NEAR(read[0].x / brightness, 1.0, 0x1p-11) << "the precision of float16, " << brightness;
    EXPECT_EQ(read[1].x, 0.0f);
  }
}

TEST_P(Uploader, KeepsExactlyWhatFloatsOfTheFormatHoldExactly) {
  IlluminationGrid light(unit_spacing({16, 8, 4}), channels());
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] = float(i % 2048);
  const Texture3D texture = uploader_->upload(light, light.lattice);
  const std::vector<float> held = test::texels_of(texture);
  if (GetParam().format != "unorm8") {
    EXPECT_EQ(held, light.values);
    return;
  }
  const float half_a_step = 0.5f * *std::max_element(light.values.begin(), light.values.end()) / 255.0f;
  ASSERT_EQ(held.size(), light.values.size());
  for (std::size_t i = 0; i < held.size(); ++i) EXPECT_NEAR(held[i], light.values[i], 1.001f * half_a_step);
}

TEST_P(Uploader, LeavesTheStateOfOpenGlAsItWas) {
  GLuint mine = 0;
  glGenTextures(1, &mine);
  glBindTexture(GL_TEXTURE_3D, mine);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 77);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
  IlluminationGrid light(unit_spacing({3, 3, 3}), channels());
  const Texture3D texture = uploader_->upload(light, light.lattice);
  GLint bound = 0;
  GLint row_length = 0;
  GLint alignment = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_3D, &bound);
  glGetIntegerv(GL_UNPACK_ROW_LENGTH, &row_length);
  glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
  EXPECT_EQ(GLuint(bound), mine);
  EXPECT_EQ(row_length, 77);
  EXPECT_EQ(alignment, 8);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_P(Uploader, NamesTheDriversLimitWhereAnAxisIsTooLong) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  const IlluminationGrid light(unit_spacing({2, limit + 1, 1}), channels());
  try {
    static_cast<void>(uploader_->upload(light, unit_spacing({2, 2, 2})));
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(std::to_string(limit)));
  }
}

TEST_P(Uploader, RefusesAGridWithoutItsValues) {
  IlluminationGrid light(unit_spacing({2, 2, 2}), channels());
  light.values.pop_back();
  EXPECT_THROW(static_cast<void>(uploader_->upload(light, light.lattice)), InvalidInput);
}

TEST_P(Uploader, RefusesLightThatIsNotOverABoxOfTheVolume) {
  IlluminationGrid light(unit_spacing({2, 2, 2}), channels());
  light.lattice.frame.axes[0] = {0.8, 0.6, 0.0};
  light.lattice.frame.axes[1] = {-0.6, 0.8, 0.0};
  EXPECT_THROW(static_cast<void>(uploader_->upload(light, unit_spacing({2, 2, 2}))), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(EveryBackend, Uploader, testing::ValuesIn(cases()), [](const auto& tested) {
  const std::string format = tested.param.format.empty() ? "as_is" : tested.param.format;
  return tested.param.backend + "_" + format + "_" + std::to_string(tested.param.channels);
});

TEST(Texture3D, MovesItsNameAndDeletesItOnce) {
  const test::EglContext context;
  if (!context) GTEST_SKIP() << context.why();
  IlluminationGrid light(unit_spacing({2, 3, 4}), 3);
  std::fill(light.values.begin(), light.values.end(), 7.0f);
  Texture3D first = uploaders().create("whole", {{"format", "unorm8"}})->upload(light, light.lattice);
  const unsigned int name = first.name();
  const auto expect_first = [&](const Texture3D& texture) {
    EXPECT_EQ(texture.name(), name);
    EXPECT_EQ(texture.size(), Index3(2, 3, 4));
    EXPECT_EQ(texture.channels(), 3);
    EXPECT_EQ(texture.gain(), 7.0);
    EXPECT_EQ(texture.scale().z, 0.75);
    EXPECT_EQ(texture.bytes(), 72u);
  };
  Texture3D second(std::move(first));
  expect_first(second);
  Texture3D third;
  third = std::move(second);
  expect_first(third);
  EXPECT_EQ(glIsTexture(name), GL_TRUE);
  third = Texture3D();
  EXPECT_EQ(glIsTexture(name), GL_FALSE);
}

}  // namespace
}  // namespace isolux
