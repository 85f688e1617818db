#pragma once

#include <isolux/bake/stages.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "camera/trackball.h"
#include "gl/overlay.h"
#include "gl/surface_renderer.h"
#include "model/background_task.h"
#include "model/document.h"
#include "model/surface_worker.h"
#include "ui/keys.h"
#include "ui/panes.h"
#include "ui/slider.h"

namespace isolux::viewer {

/// What the window starts with.
struct ViewerSettings {
  std::optional<double> isovalue;
  std::optional<Layout> layout;    ///< default: global where there is a light
  std::optional<OuterSide> outer;  ///< default: what the light says, else lower
  double azimuth_deg = 30.0;
  double elevation_deg = 20.0;
  double exposure_stops = 0.0;
  bool help = false;
  bool exact_light = false;  ///< key x, from the start
  BackendChoice extractor;
  Scene scene;  ///< of a draft of the light, and of exact light where there is no other
  Run run;
};

enum class MouseButton { kLeft, kMiddle, kRight };

/// A window's size and the mouse in it, pixels of its framebuffer.
struct WindowSize {
  int width = 1;
  int height = 1;
  double scale = 1.0;  ///< pixels a user-interface pixel
};

/// The viewer without its window: reacts to keys and mouse, works in the background, draws. Needs a current OpenGL 3.3
/// core context from its construction to its destruction; called from one thread.
class Viewer {
 public:
  /// `wake` is called from any thread when update() has something to do. \throw GlError, InvalidInput
  Viewer(Document document, const ViewerSettings& settings, const Stages& stages, std::function<void()> wake);

  /// Shows another volume from now on. \throw GlError, InvalidInput
  void open(Document document);

  void act(Action action);
  /// At the place of the last move(): asking for the mouse now would be too late where a picture takes long.
  void press(MouseButton button);
  /// True if the picture changed.
  [[nodiscard]] bool move(double x, double y);
  void release();
  void scroll(double steps);
  /// Shows a line of text for a while.
  void say(const std::string& line);

  /// Takes what the background threads finished. True if the picture changed.
  bool update();
  /// Nothing more will change by itself.
  [[nodiscard]] bool settled() const;
  /// Draws everything into the current framebuffer.
  void draw(const WindowSize& size);
  /// Draws the surface alone, without slider and text.
  void draw_surface(const WindowSize& size);

  [[nodiscard]] std::string title() const;
  [[nodiscard]] bool quit() const { return quit_; }
  /// The file that a picture was asked for, once.
  [[nodiscard]] std::optional<std::string> take_screenshot_request();

 private:
  enum class Drag { kNone, kSlider, kRotate, kPan, kZoom };

  /// The surface that the renderer has.
  struct Shown {
    Surface surface;
    bool exact = false;  ///< its light was traced
  };

  void start(Document document);
  void request_surface();
  void take_light(std::shared_ptr<const LightFile> light);
  void toggle_light();
  void show_side_by_side();
  void start_bake();
  void toggle_exact_light();
  void start_exact_light();
  bool update_surface();
  bool update_bake();
  bool update_exact_light();
  void export_shown();
  void draw_slider(const WindowSize& size);
  void draw_texts(const WindowSize& size);
  void draw_help(const WindowSize& size);
  [[nodiscard]] std::string advice() const;
  /// Whether the light is one of the shown isovalue, too.
  [[nodiscard]] bool lit_here() const;

  ViewerSettings settings_;
  const Stages& stages_;
  std::function<void()> wake_;

  Document document_;
  Shown shown_;
  OuterSide outer_ = OuterSide::kLower;
  Layout layout_ = Layout::kLocal;
  SurfaceStyle style_ = SurfaceStyle::kShaded;
  double exposure_stops_ = 0.0;
  bool help_ = false;
  bool wants_exact_ = false;
  bool quit_ = false;
  bool screenshot_ = false;
  std::string message_;
  double draw_seconds_ = 0.0;

  std::unique_ptr<Trackball> trackball_;
  std::unique_ptr<Slider> slider_;
  WindowSize size_;
  Drag drag_ = Drag::kNone;
  std::size_t drag_pane_ = 0;
  glm::dvec2 mouse_{0.0};

  std::unique_ptr<SurfaceRenderer> renderer_;
  Overlay overlay_;
  std::unique_ptr<SurfaceWorker> worker_;
  std::unique_ptr<BackgroundTask<LightFile>> bake_;
  std::unique_ptr<BackgroundTask<PointLight>> exact_;
};

}  // namespace isolux::viewer
