#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace isolux::viewer {

/// What a key does.
enum class Action {
  kToggleLight,
  kSideBySide,
  kResetView,
  kWireframe,
  kBrighter,
  kDarker,
  kIsovalueDown,
  kIsovalueUp,
  kIsovalueFarDown,
  kIsovalueFarUp,
  kBake,
  kExactLight,
  kScreenshot,
  kExport,
  kHelp,
  kQuit
};

/// One line of the key table: also a line of the help overlay.
struct KeyBinding {
  int key;  ///< GLFW's key code
  bool shift;
  Action action;
  std::string_view name;  ///< for people; empty where another line speaks for it
  std::string_view help;
};

[[nodiscard]] std::span<const KeyBinding> key_bindings();

enum class MouseButton { kLeft, kMiddle, kRight };

/// What GLFW's mouse button means with these modifiers; nothing for buttons beyond the third.
[[nodiscard]] std::optional<MouseButton> button_of(int button, int modifiers);

/// What the key does, if anything.
[[nodiscard]] std::optional<Action> action_of(int key, int modifiers);

}  // namespace isolux::viewer
