#include "ui/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

namespace isolux::viewer {
namespace {

constexpr std::array kBindings{
    KeyBinding{GLFW_KEY_L, false, Action::kToggleLight, "l", "local or global light"},
    KeyBinding{GLFW_KEY_S, false, Action::kSideBySide, "s", "both side by side"},
    KeyBinding{GLFW_KEY_B, false, Action::kBake, "b", "bake a draft of the light"},
    KeyBinding{GLFW_KEY_X, false, Action::kExactLight, "x", "exact light, traced at rest"},
    KeyBinding{GLFW_KEY_LEFT, false, Action::kIsovalueDown, "left right", "isovalue by 1/500 of the range"},
    KeyBinding{GLFW_KEY_RIGHT, false, Action::kIsovalueUp, "", ""},
    KeyBinding{GLFW_KEY_PAGE_DOWN, false, Action::kIsovalueFarDown, "page down up", "isovalue by 1/20 of the range"},
    KeyBinding{GLFW_KEY_PAGE_UP, false, Action::kIsovalueFarUp, "", ""},
    KeyBinding{GLFW_KEY_G, false, Action::kBrighter, "g", "brighter by a third of a stop"},
    KeyBinding{GLFW_KEY_G, true, Action::kDarker, "shift g", "darker"},
    KeyBinding{GLFW_KEY_W, false, Action::kWireframe, "w", "triangles"},
    KeyBinding{GLFW_KEY_SPACE, false, Action::kResetView, "space", "the first view again"},
    KeyBinding{GLFW_KEY_HOME, false, Action::kResetView, "", ""},
    KeyBinding{GLFW_KEY_P, false, Action::kScreenshot, "p", "save the picture as PNG"},
    KeyBinding{GLFW_KEY_E, false, Action::kExport, "e", "save the lit surface as PLY"},
    KeyBinding{GLFW_KEY_H, false, Action::kHelp, "h", "this help"},
    KeyBinding{GLFW_KEY_F1, false, Action::kHelp, "", ""},
    KeyBinding{GLFW_KEY_Q, false, Action::kQuit, "q esc", "quit"},
    KeyBinding{GLFW_KEY_ESCAPE, false, Action::kQuit, "", ""},
};

}  // namespace

std::span<const KeyBinding> key_bindings() { return kBindings; }

std::optional<Action> action_of(int key, int modifiers) {
  if ((modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return std::nullopt;
  const bool shift = (modifiers & GLFW_MOD_SHIFT) != 0;
  for (const KeyBinding& binding : kBindings) {
    if (binding.key == key && binding.shift == shift) return binding.action;
  }
  return std::nullopt;
}

std::optional<MouseButton> button_of(int button, int modifiers) {
  switch (button) {
    case GLFW_MOUSE_BUTTON_LEFT:
      return (modifiers & GLFW_MOD_SHIFT) != 0 ? MouseButton::kMiddle : MouseButton::kLeft;
    case GLFW_MOUSE_BUTTON_MIDDLE:
      return MouseButton::kMiddle;
    case GLFW_MOUSE_BUTTON_RIGHT:
      return MouseButton::kRight;
    default:
      return std::nullopt;
  }
}

}  // namespace isolux::viewer
