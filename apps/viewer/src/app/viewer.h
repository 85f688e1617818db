#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer_settings.h"
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
  /// Shows a text for some seconds, or until the next key or mouse button.
  void say(const std::string& text);
  void dismiss() { message_.clear(); }
  /// Saves something of the shown surface under a free name, see save_under_free_name(), and says so, or why not.
  void save(const std::string& extension, const std::function<void(const std::string& path)>& write,
            const std::string& remark = {});

  /// Takes what the background threads finished. True if the picture changed.
  bool update();
  /// Nothing more will change by itself, but for messages.
  [[nodiscard]] bool settled() const;
  /// Until the message goes, seconds, if there is one.
  [[nodiscard]] std::optional<double> message_seconds_left() const;
  /// Why what is shown is not what was asked for: a surface or exact light that could not be made; "" otherwise.
  [[nodiscard]] std::string failure() const;
  /// Draws everything into the current framebuffer.
  void draw(const WindowSize& size);
  /// Draws the surface alone, without slider and text, into a framebuffer that is the picture from pixel `first` on.
  void draw_surface(const WindowSize& size, const glm::ivec2& first = glm::ivec2(0));

  [[nodiscard]] std::string title() const;
  /// What is said over the picture, one text a label: progress, message, advice, warnings.
  [[nodiscard]] std::vector<std::string> texts() const;
  [[nodiscard]] Layout layout() const { return layout_; }
  /// What a pane is called.
  [[nodiscard]] std::string name_of(const Pane& pane) const;
  [[nodiscard]] bool quit() const { return quit_; }
  /// The one that was asked for last.
  [[nodiscard]] float isovalue() const { return float(slider_->value()); }
  /// Whether a picture was asked for; once, and not before its surface is there.
  [[nodiscard]] bool take_screenshot_request();

 private:
  enum class Drag { kNone, kSlider, kRotate, kPan, kZoom };

  /// The surface that the renderer has.
  struct Shown {
    Surface surface;
    bool exact = false;             ///< its light was traced
    std::vector<Vec3f> radiance{};  ///< and found to be this at the vertices
  };

  void start(Document document);
  void request_surface();
  void take_light(KnownLight light);
  /// Global light was asked for: shown from now on, or from when it is there, until local light is asked for.
  void show_global();
  void forget_exact_light();
  void replace_light(KnownLight draft);
  void bring_light_back();
  void toggle_light();
  void show_side_by_side();
  void start_bake();
  void expose(double stops);
  void toggle_exact_light();
  void start_exact_light();
  bool update_surface();
  bool update_bake();
  bool update_exact_light();
  [[nodiscard]] std::optional<Scene> draft_scene() const;
  void export_shown();
  [[nodiscard]] VertexLight light_to_save() const;
  void draw_pane(const Pane& pane, int height, const glm::ivec2& first);
  void draw_slider(const WindowSize& size);
  void draw_texts(const WindowSize& size);
  void draw_help(const WindowSize& size);
  [[nodiscard]] std::string advice() const;
  /// Whether there is global light of the shown isovalue.
  [[nodiscard]] bool lit_here() const;
  [[nodiscard]] Lighting lighting_of(const Pane& pane) const;
  [[nodiscard]] std::vector<std::string> warnings() const;

  ViewerSettings settings_;
  const Stages& stages_;
  std::function<void()> wake_;

  Document document_;
  Shown shown_;
  Lighted lighted_;
  std::optional<KnownLight> replaced_;  ///< the light given, while a draft is shown
  bool is_draft_ = false;               ///< the document's light
  Layout layout_ = Layout::kLocal;
  SurfaceStyle style_ = SurfaceStyle::kShaded;
  double exposure_stops_ = 0.0;
  bool help_ = false;
  bool wants_exact_ = false;
  bool quit_ = false;
  bool screenshot_ = false;
  std::string message_;
  std::chrono::steady_clock::time_point message_end_;
  std::string exact_failure_;
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
  std::unique_ptr<BackgroundTask<KnownLight>> bake_;
  std::unique_ptr<BackgroundTask<PointLight>> exact_;
};

}  // namespace isolux::viewer
