#include "app/app.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/render/image.h>
#include <isolux/volume_io/atomic_file.h>
#include <isolux/volume_io/read.h>

#include <exception>
#include <stop_token>
#include <utility>

#include "app/window.h"
#include "gl/picture.h"

namespace isolux::viewer {
namespace {

class App final : public WindowListener {
 public:
  App(Document document, const AppSettings& settings, const Stages& stages)
      : settings_(settings),
        stages_(stages),
        window_(settings.width, settings.height, "isolux", *this),
        viewer_(std::move(document), settings.viewer, stages, Window::wake) {}

  [[nodiscard]] float run() {
    const std::stop_callback wake(settings_.viewer.run.stop, Window::wake);
    int drawn = 0;
    while (!window_.closing() && !viewer_.quit()) {
      throw_if_stopped(settings_.viewer.run);
      const bool settled = viewer_.settled();
      if (viewer_.update() || dirty_ || settings_.frames > 0) {
        draw();
        // Only pictures of the finished surface count.
        if (settled && settings_.frames > 0 && ++drawn >= settings_.frames) break;
      }
      // With a number of frames to draw, the next one needs no event.
      if (settings_.frames > 0 && viewer_.settled()) {
        window_.poll_events();
      } else {
        window_.wait_events(viewer_.message_seconds_left());
      }
    }
    if (!settings_.screenshot.empty()) save_screenshot();
    return viewer_.isovalue();
  }

  void on_key(int key, int modifiers) override {
    viewer_.dismiss();
    if (const auto action = action_of(key, modifiers)) viewer_.act(*action);
    dirty_ = true;
  }
  void on_press(MouseButton button) override {
    viewer_.press(button);
    dirty_ = true;
  }
  void on_move(double x, double y) override { dirty_ = viewer_.move(x, y) || dirty_; }
  void on_release() override { viewer_.release(); }
  void on_scroll(double steps) override {
    viewer_.scroll(steps);
    dirty_ = true;
  }
  void on_redraw() override { dirty_ = true; }
  void on_drop(const std::string& path) override {
    dirty_ = true;
    try {
      StoredVolume volume = read_stored_volume(path, {}, settings_.viewer.run, stages_.readers);
      require_usable(volume);
      viewer_.open(make_document(std::move(volume)));
    } catch (const std::exception& error) {
      viewer_.say(error.what());
    }
  }

 private:
  void draw() {
    dirty_ = false;
    viewer_.draw(window_.size());
    window_.set_title(viewer_.title());
    window_.swap();
    if (viewer_.take_screenshot_request()) {
      const WindowSize size = window_.size();
      viewer_.save("png", [&](const std::string& path) { write_png(picture(size.width, size.height), path); });
      dirty_ = true;
      Window::wake();
    }
  }

  /// The surface alone, also where the window is smaller or lies behind another.
  [[nodiscard]] Image picture(int width, int height) {
    return draw_picture(width, height, [&](const glm::ivec2& first) {
      viewer_.draw_surface({.width = width, .height = height}, first);
    });
  }

  /// \throw Error rather than that somebody takes what was not finished for what was asked for
  void save_screenshot() {
    const std::string& path = settings_.screenshot;
    if (!viewer_.settled())
      throw Error(fmt::format("{}: not written: the window was closed before its picture was finished", path));
    if (!viewer_.failure().empty()) throw Error(fmt::format("{}: not written: {}", path, viewer_.failure()));
    const Image image = picture(settings_.width, settings_.height);
    write_atomically_by_name(path, [&](const std::string& temporary) { write_png(image, temporary); });
  }

  const AppSettings& settings_;
  const Stages& stages_;
  Window window_;
  Viewer viewer_;
  bool dirty_ = true;
};

}  // namespace

float run_app(Document document, const AppSettings& settings, const Stages& stages) {
  return App(std::move(document), settings, stages).run();
}

}  // namespace isolux::viewer
