#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/viewer.h"

struct GLFWwindow;

namespace isolux::viewer {

/// Who hears of a window's events. Mouse places are in framebuffer pixels.
class WindowListener {
 public:
  virtual ~WindowListener() = default;
  virtual void on_key(int key, int modifiers) = 0;
  /// The place is that of the last on_move().
  virtual void on_press(MouseButton button) = 0;
  virtual void on_move(double x, double y) = 0;
  virtual void on_release() = 0;
  virtual void on_scroll(double steps) = 0;
  virtual void on_drop(const std::string& path) = 0;
  virtual void on_redraw() = 0;
};

/// The library behind windows; one at a time. \throw GlError without a display
class WindowSystem {
 public:
  WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;
  ~WindowSystem();
};

/// A window with a current OpenGL 3.3 core context, whose events go to the listener.
class Window {
 public:
  /// Size in screen coordinates, at most that of the screens. \throw GlError
  Window(int width, int height, const std::string& title, WindowListener& listener);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  [[nodiscard]] WindowSize size() const;
  [[nodiscard]] bool closing() const;
  void set_title(const std::string& title);
  /// Shows what was drawn.
  void swap();
  /// Handles the events that are there.
  void poll_events();
  /// Sleeps until there are events, or wake(), or some time has passed.
  void wait_events(std::optional<double> most_seconds);
  /// Ends wait_events(); from any thread.
  static void wake();

 private:
  GLFWwindow* window_;
};

}  // namespace isolux::viewer
