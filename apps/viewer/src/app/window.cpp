#include "app/window.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux::viewer {
namespace {

std::string last_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

WindowListener& listener(GLFWwindow* window) { return *static_cast<WindowListener*>(glfwGetWindowUserPointer(window)); }

/// From screen coordinates to framebuffer pixels: they differ on displays of high density.
double pixels_a_coordinate(GLFWwindow* window) {
  int width = 1;
  int pixels = 1;
  glfwGetWindowSize(window, &width, nullptr);
  glfwGetFramebufferSize(window, &pixels, nullptr);
  return width > 0 ? double(pixels) / width : 1.0;
}

/// GLFW names keys by where they are on an American keyboard; a letter means what is printed on it.
int key_as_printed(int key, int scancode) {
  const char* name = glfwGetKeyName(key, scancode);
  if (name == nullptr || name[0] == '\0' || name[1] != '\0') return key;
  const bool letter = name[0] >= 'a' && name[0] <= 'z';
  return letter ? GLFW_KEY_A + (name[0] - 'a') : key;
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  if (action != GLFW_RELEASE) listener(window).on_key(key_as_printed(key, scancode), modifiers);
}

void on_button(GLFWwindow* window, int button, int action, int modifiers) {
  const std::optional<MouseButton> meant = button_of(button, modifiers);
  if (!meant) return;
  if (action == GLFW_RELEASE) {
    listener(window).on_release();
  } else {
    listener(window).on_press(*meant);
  }
}

void on_move(GLFWwindow* window, double x, double y) {
  const double scale = pixels_a_coordinate(window);
  listener(window).on_move(x * scale, y * scale);
}

void on_scroll(GLFWwindow* window, double /*x*/, double y) { listener(window).on_scroll(y); }

void on_drop(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) listener(window).on_drop(paths[count - 1]);
}

void on_refresh(GLFWwindow* window) { listener(window).on_redraw(); }

void on_size(GLFWwindow* window, int /*width*/, int /*height*/) { listener(window).on_redraw(); }

/// How far the screens reach together; no limit where there are none.
struct Desktop {
  int width = std::numeric_limits<int>::max();
  int height = std::numeric_limits<int>::max();
};

Desktop desktop() {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  int low[2] = {std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  int high[2] = {std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
  for (int i = 0; i < count; ++i) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (mode == nullptr) return {};
    int place[2] = {0, 0};
    glfwGetMonitorPos(monitors[i], &place[0], &place[1]);
    const int size[2] = {mode->width, mode->height};
    for (int a = 0; a < 2; ++a) {
      low[a] = std::min(low[a], place[a]);
      high[a] = std::max(high[a], place[a] + size[a]);
    }
  }
  return count == 0 ? Desktop{} : Desktop{.width = high[0] - low[0], .height = high[1] - low[1]};
}

}  // namespace

WindowSystem::WindowSystem() {
  if (glfwInit() != GLFW_TRUE) {
    throw GlError(fmt::format("no display: {}; isolux render draws without one", last_error()));
  }
}

WindowSystem::~WindowSystem() { glfwTerminate(); }

Window::Window(int width, int height, const std::string& title, WindowListener& events) : window_(nullptr) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, 4);
  // What nobody sees would take memory all the same.
  const Desktop most = desktop();
  width = std::min(width, most.width);
  height = std::min(height, most.height);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    // Some remote displays have no multisampling.
    glfwWindowHint(GLFW_SAMPLES, 0);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  }
  if (window_ == nullptr) throw GlError(fmt::format("no window with OpenGL 3.3: {}", last_error()));
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, &events);
  glfwSetKeyCallback(window_, on_key);
  glfwSetMouseButtonCallback(window_, on_button);
  glfwSetCursorPosCallback(window_, on_move);
  glfwSetScrollCallback(window_, on_scroll);
  glfwSetDropCallback(window_, on_drop);
  glfwSetWindowRefreshCallback(window_, on_refresh);
  glfwSetFramebufferSizeCallback(window_, on_size);
}

Window::~Window() { glfwDestroyWindow(window_); }

WindowSize Window::size() const {
  WindowSize result;
  glfwGetFramebufferSize(window_, &result.width, &result.height);
  float scale = 1.0f;
  glfwGetWindowContentScale(window_, &scale, nullptr);
  result.scale = std::max(1.0, std::round(2.0 * double(scale)) / 2.0);
  return result;
}

bool Window::closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::swap() { glfwSwapBuffers(window_); }

void Window::poll_events() { glfwPollEvents(); }

void Window::wait_events(std::optional<double> most_seconds) {
  if (most_seconds) {
    glfwWaitEventsTimeout(*most_seconds);
  } else {
    glfwWaitEvents();
  }
}

void Window::wake() { glfwPostEmptyEvent(); }

}  // namespace isolux::viewer
