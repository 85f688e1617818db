// The program itself under Xvfb, a display in memory; skipped where there is none.
#include <gtest/gtest.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/render/image.h>
#include <isolux/render/render.h>
#include <isolux/volume_io/light_file.h>
#include <isolux/volume_io/read.h>
#include <stb_image.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace isolux::viewer {
namespace {

namespace fs = std::filesystem;

const std::string kDisplay = "timeout 120 xvfb-run -a -e /dev/null -s '-screen 0 640x480x24'";

/// Black, a texel a cell.
LightFile light_of(const Volume& volume) {
  LightFile light;
  light.grid = IlluminationGrid(cell_lattice(volume.lattice()), 1);
  light.metadata["isolux.volume_sha256"] = volume_sha256(volume);
  return light;
}

class IsoluxView : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("isolux-view-test-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] static bool has_xvfb() {
    return std::system("command -v xvfb-run >/dev/null && command -v xauth >/dev/null") == 0;
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Exit status; what it says on stderr is in said().
  int run(const std::string& before, const std::string& arguments) const {
    const std::string command =
        before + " '" + ISOLUX_VIEW + "' " + arguments + " >" + path("out") + " 2>" + path("err");
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// The program's own status, written down by a shell that runs it by `how`: xvfb-run has troubles of its own when it
  /// ends.
  int run_with_display(const std::string& arguments, const std::string& how = R"("$0" "$@")") const {
    fs::remove(path("status"));
    const int around = run(kDisplay + " sh -c '" + how + "; echo $? >" + path("status") + "'", arguments);
    int status = around;
    std::ifstream(path("status")) >> status;
    return status;
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string said() const { return content("err"); }

  struct Picture {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> rgb;
  };
  [[nodiscard]] Picture picture(const std::string& name) const {
    Picture result;
    unsigned char* pixels = stbi_load(path(name).c_str(), &result.width, &result.height, nullptr, 3);
    if (pixels == nullptr) return result;
    result.rgb.assign(pixels, pixels + std::size_t(result.width) * std::size_t(result.height) * 3);
    stbi_image_free(pixels);
    return result;
  }

  fs::path folder_;
};

TEST_F(IsoluxView, SaysInOneLineThatThereIsNoDisplay) {
  EXPECT_EQ(run("env -u DISPLAY -u WAYLAND_DISPLAY", "gen:sphere:8"), 1);
  const std::string words = said();
  EXPECT_EQ(words.rfind("isolux: error: view: no display", 0), 0u) << words;
  EXPECT_EQ(std::count(words.begin(), words.end(), '\n'), 1) << words;
}

TEST_F(IsoluxView, RefusesAWrongCommandLineBeforeItLooksForADisplay) {
  for (const char* arguments :
       {"--no-such-option", "--size 10", "--size 100000x10", "--view 1", "--mode global", "--frames 0", "--iso nan",
        "--iso 2sigmas", "--iso 1,2", "--exposure inf", "--backend none", "--set k", "--spacing 1,1,1",
        "--screenshot ''", "--screenshot a.jpg", "''"}) {
    EXPECT_EQ(run("env -u DISPLAY", arguments), 2) << arguments;
    EXPECT_EQ(said().rfind("isolux: error: view: ", 0), 0u) << said();
  }
}

TEST_F(IsoluxView, FindsOutFirstThatAPictureHasNoPlace) {
  EXPECT_EQ(run("env -u DISPLAY", "gen:sphere:8 --screenshot " + path("none/a.png")), 1);
  EXPECT_NE(said().find("there is no folder"), std::string::npos) << said();
}

TEST_F(IsoluxView, WritesItsReport) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  ASSERT_EQ(run_with_display("gen:sphere:8 --iso -.3 --frames 1 --size 64x64 --report " + path("r.json")), 0) << said();
  const std::string report = content("r.json");
  for (const char* key : {"\"seconds\"", "\"read\"", "\"total\"", "\"peak_memory_bytes\"", "\"isovalue\": -0.3,"})
    EXPECT_NE(report.find(key), std::string::npos) << report;
}

TEST_F(IsoluxView, EndsCleanlyWhenInterrupted) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  for (const char* signal : {"INT", "TERM"}) {
    // In the background timeout would send the signal twice, to the program and to its group; the second ends it at
    // once.
    const std::string interrupted =
        std::string("timeout --foreground --preserve-status -s ") + signal + R"( 2 "$0" "$@")";
    EXPECT_EQ(run_with_display("gen:sphere:8 --size 64x64", interrupted), 130);
    EXPECT_EQ(said().substr(0, said().find('\n')), "isolux: error: view: interrupted");
  }
}

TEST_F(IsoluxView, DrawsLocalAndGlobalLightAndLeaves) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  const Volume volume = read_volume("gen:sphere:24");
  LightFile light = light_of(volume);
  for (std::size_t i = 0; i < light.grid.values.size(); ++i) light.grid.values[i] = (i / 23) % 23 < 12 ? 0.1f : 0.9f;
  write_light(light, path("light.nrrd"), volume.space);
  for (const char* mode : {"local", "global", "both"}) {
    const std::string picture_path = path(std::string(mode) + ".png");
    ASSERT_EQ(run_with_display("gen:sphere:24 --iso -0.4 --size 320x200 --frames 3 --light " + path("light.nrrd") +
                               " --mode " + mode + " --screenshot " + picture_path),
              0)
        << said();
    EXPECT_EQ(said(), "");
  }
  const Picture local = picture("local.png");
  const Picture global = picture("global.png");
  ASSERT_EQ(local.width, 320);
  ASSERT_EQ(local.height, 200);
  EXPECT_GT(std::set<unsigned char>(local.rgb.begin(), local.rgb.end()).size(), 30u) << "a shaded ball has many greys";
  std::size_t differing = 0;
  for (std::size_t i = 0; i < local.rgb.size(); ++i)
    if (std::abs(int(local.rgb[i]) - int(global.rgb[i])) > 10) ++differing;
  EXPECT_GT(differing, local.rgb.size() / 20);
  const Picture both = picture("both.png");
  ASSERT_EQ(both.rgb.size(), local.rgb.size());
  EXPECT_NE(both.rgb, local.rgb);
  EXPECT_NE(both.rgb, global.rgb);
}

TEST_F(IsoluxView, DrawsLocalLightWhereTheLightIsOfOtherIsovalues) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  const Volume volume = read_volume("gen:sphere:48");
  LightFile light = light_of(volume);
  std::fill(light.grid.values.begin(), light.grid.values.end(), 1.0f);
  light.grid.detail.isovalues = ValueRange{.low = -0.41f, .high = -0.39f};
  light.metadata["isolux.iso_range"] = "-0.41:-0.39";
  write_light(light, path("light.nrrd"), volume.space);
  const auto draw = [&](const std::string& name, const std::string& arguments) {
    EXPECT_EQ(run_with_display("gen:sphere:48 --size 200x200 --light " + path("light.nrrd") + " --screenshot " +
                               path(name) + " " + arguments),
              0)
        << said();
    return picture(name).rgb;
  };
  const auto inside = draw("inside.png", "");  // where it is lit, not at Otsu's threshold
  ASSERT_EQ(inside.size(), 200u * 200u * 3u);
  EXPECT_NEAR(inside[(100 * 200 + 100) * 3], 231, 1) << "albedo .8 of 1, as an sRGB code";
  EXPECT_EQ(draw("inside2.png", "--iso -0.4"), inside);
  const auto local = draw("local.png", "--iso -0.2 --mode local");
  EXPECT_EQ(said(), "");
  EXPECT_EQ(draw("outside.png", "--iso -0.2"), local);
  EXPECT_NE(said().find("isovalue -0.2 lies outside the range -0.41 to -0.39"), std::string::npos) << said();
}

TEST_F(IsoluxView, TracesExactLightAtTheVertices) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  // A white sky lights the outside of a ball everywhere alike; the headlight of local light would not.
  ASSERT_EQ(run_with_display("gen:sphere:24 --iso -0.4 --size 200x200 --exact-light --screenshot " + path("exact.png")),
            0)
      << said();
  const Picture exact = picture("exact.png");
  ASSERT_EQ(exact.rgb.size(), 200u * 200u * 3u);
  const int middle = exact.rgb[(100 * 200 + 100) * 3];
  // Albedo .8 of 1, as an sRGB code.
  EXPECT_NEAR(middle, 231, 2);
  for (int x = 60; x <= 140; ++x) EXPECT_NEAR(exact.rgb[std::size_t(100 * 200 + x) * 3], middle, 1) << x;
}

TEST_F(IsoluxView, ShowsTheSameFrameAsRender) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  const Volume volume = read_volume("gen:torus:24");
  for (const auto& [width, height] : {std::pair{300, 120}, std::pair{120, 300}}) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    ASSERT_EQ(
        run_with_display("gen:torus:24 --iso -0.15 --view 20,30 --size " + size + " --screenshot " + path("shown.png")),
        0)
        << said();
    const Picture shown = picture("shown.png");
    ASSERT_EQ(shown.width, width);
    const Image expected = render(volume, orbit_camera(volume.lattice(), 20.0, 30.0, double(width) / height),
                                  {.width = width, .height = height, .supersampling = 1, .isovalue = -0.15f},
                                  local_shader(Vec3f(0.8f)), {});
    int differing = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int code = shown.rgb[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3];
        if (std::abs(code - int(srgb_code(expected.at(x, y).x))) > 12) ++differing;
      }
    // The mesh's outline is not the field's: a pixel along it.
    EXPECT_LT(differing, (width + height) * 2);
  }
}

TEST_F(IsoluxView, SaysThatItsIsovalueIsOutsideTheValues) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  EXPECT_EQ(run_with_display("gen:sphere:8 --iso 5 --frames 1 --size 64x64"), 0);
  EXPECT_EQ(said().rfind("isolux: warning: --iso 5 lies outside the values of gen:sphere:8", 0), 0u) << said();
}

TEST_F(IsoluxView, TakesAnIsovalueInStandardDeviations) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  const std::string volume = path("v_2x2x2_uint8.raw");
  std::ofstream(volume) << "\2\4\4\4\5\5\7\11";  // mean 5, standard deviation 2
  const auto shown = [&](const std::string& isovalue) {
    EXPECT_EQ(run_with_display(volume + " --iso=" + isovalue + " --size 64x64 --screenshot " + path("shown.png")), 0);
    return picture("shown.png").rgb;
  };
  EXPECT_EQ(shown("0.5sigma"), shown("6"));
  EXPECT_NE(shown("0.5sigma"), shown("4.5"));
  static_cast<void>(shown("3sigma"));
  EXPECT_EQ(said().rfind("isolux: warning: --iso 11 lies outside", 0), 0u) << said();
}

TEST_F(IsoluxView, WritesAPictureOfTheSizeAskedOnASmallerScreen) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  ASSERT_EQ(run_with_display("gen:sphere:24 --size 2100x600 --screenshot " + path("large.png")), 0) << said();
  EXPECT_EQ(picture("large.png").width, 2100);
  EXPECT_EQ(picture("large.png").height, 600);
}

TEST_F(IsoluxView, WritesNoPictureThatIsNotFinished) {
  if (!has_xvfb() || std::system("command -v xdotool >/dev/null") != 0)
    GTEST_SKIP() << "xvfb-run, xauth or xdotool is not installed";
  // Minutes of work for one thread, closed at once.
  const std::string closed =
      R"((xdotool search --sync --onlyvisible --name "^isolux - " windowfocus --sync key q) >/dev/null 2>&1 & )"
      R"("$0" "$@")";
  EXPECT_EQ(
      run_with_display(
          "gen:gyroid:192 --iso 0 --threads 1 --size 64x64 --exact-light --screenshot " + path("early.png"), closed),
      1);
  EXPECT_NE(said().find("early.png: not written: the window was closed"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(path("early.png")));
}

TEST_F(IsoluxView, WritesNoPictureWithoutTheExactLightAskedFor) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  const Volume volume = read_volume("gen:sphere:16");
  LightFile light = light_of(volume);
  light.metadata["isolux.scene"] = R"({"environment":{"type":"image"}})";
  write_light(light, path("light.nrrd"), volume.space);
  EXPECT_EQ(run_with_display("gen:sphere:16 --exact-light --size 64x64 --light " + path("light.nrrd") +
                             " --screenshot " + path("none.png")),
            1);
  EXPECT_NE(said().find("none.png: not written: the light does not tell its whole scene"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(path("none.png")));
}

TEST_F(IsoluxView, ShowsATestFieldWithoutAVolume) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  EXPECT_EQ(run_with_display("--size 200x150 --frames 1 --screenshot " + path("field.png")), 0) << said();
  EXPECT_EQ(picture("field.png").width, 200);
}

TEST_F(IsoluxView, RefusesAMissingVolumeAndTheLightOfAnother) {
  if (!has_xvfb()) GTEST_SKIP() << "xvfb-run or xauth is not installed";
  EXPECT_EQ(run_with_display(path("missing.nrrd") + " --frames 1"), 1);
  EXPECT_NE(said().find("missing.nrrd"), std::string::npos) << said();
  LightFile light = light_of(read_volume("gen:sphere:8"));
  light.metadata["isolux.volume_sha256"] = std::string(64, '0');
  write_light(light, path("light.nrrd"), "left-posterior-superior");
  EXPECT_EQ(run_with_display("gen:sphere:8 --frames 1 --light " + path("light.nrrd")), 1);
  EXPECT_EQ(run_with_display("gen:sphere:8 --frames 1 --force --light " + path("light.nrrd")), 0) << said();
  EXPECT_EQ(run_with_display("gen:sphere:8 --frames 1 --force --outer higher --light " + path("light.nrrd")), 1);
  EXPECT_NE(said().find("light.nrrd: it holds light of the outer side alone"), std::string::npos) << said();
}

}  // namespace
}  // namespace isolux::viewer
