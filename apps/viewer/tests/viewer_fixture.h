// The viewer without its window, on a framebuffer of kSize pixels each way.
#pragma once

#include <gtest/gtest.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/render/image.h>
#include <isolux/volume_io/read.h>

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/viewer.h"
#include "egl_context.h"
#include "gl_target.h"

namespace isolux::viewer {

inline constexpr const char* kBall = "gen:sphere:24";

/// A light of kBall in a dim scene of its own, which says that it is of these isovalues.
inline std::shared_ptr<const LightFile> dim_light(std::optional<ValueRange> isovalues) {
  const Volume volume = read_volume(kBall);
  Scene scene;
  scene.environment = UniformEnvironment{.radiance = Vec3f(0.25f)};
  BakeSettings settings;
  settings.texels = Index3(8);
  LightFile light = make_light_file(bake(volume, scene, settings, builtin_stages(), {}), volume, scene, {});
  light.grid.detail.isovalues = isovalues;
  return std::make_shared<const LightFile>(std::move(light));
}

class ViewerTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!context_) GTEST_SKIP() << context_.why();
    target_.emplace();
  }

  /// At rest, looking from -y.
  void look(const std::function<void(ViewerSettings&)>& set, std::shared_ptr<const LightFile> light = nullptr,
            const std::string& volume = kBall) {
    ViewerSettings settings;
    set(settings);
    settings.azimuth_deg = 0.0;
    settings.elevation_deg = 0.0;
    if (!settings.isovalue && volume == kBall) settings.isovalue = -0.4;
    Document document = make_document(read_stored_volume(volume));
    if (light) document.light = known_light(std::move(light));
    viewer_ = std::make_unique<Viewer>(std::move(document), settings, stages_, [] {});
    rest();
  }
  void rest() {
    do {
      static_cast<void>(viewer_->update());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (!viewer_->settled());
  }
  void act(Action action) {
    viewer_->act(action);
    rest();
  }
  using Colour = std::array<int, 3>;
  Colour pixel(int x, int y) {
    viewer_->draw_surface({kSize, kSize, 1.0});
    target_->read();
    const auto& found = target_->colours[std::size_t(y) * kSize + std::size_t(x)];
    return {found[0], found[1], found[2]};
  }
  Colour middle() { return pixel(kSize / 2, kSize / 2); }
  Colour corner() { return pixel(1, 1); }
  std::vector<std::string> texts() { return viewer_->texts(); }
  std::string left_name() { return viewer_->name_of(make_panes(Layout::kGlobal, kSize, kSize)[0]); }

  const test::EglContext context_;
  Stages stages_ = builtin_stages();
  std::optional<Target> target_;
  std::unique_ptr<Viewer> viewer_;
};

inline void expect_shown(const std::array<int, 3>& found, const Vec3f& radiance) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(found[std::size_t(c)], srgb_code(radiance[c]), 1) << "channel " << c << ", one code for rounding";
}

}  // namespace isolux::viewer
