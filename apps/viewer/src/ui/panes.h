#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "ui/box.h"

namespace isolux::viewer {

enum class Lighting { kLocal, kGlobal };

/// What the window shows.
enum class Layout { kLocal, kGlobal, kSideBySide };

/// A part of the window with a picture of the surface.
struct Pane {
  Box box;
  Lighting lighting = Lighting::kLocal;
};

/// The panes of a window: one, or local light left and global light right.
[[nodiscard]] std::vector<Pane> make_panes(Layout layout, double width, double height);

/// Which pane holds the pixel; the nearest one outside the window.
[[nodiscard]] std::size_t pane_at(const std::vector<Pane>& panes, double x);

/// The place in the pane's picture: 0 in the middle, y upwards, -1 to 1 along its shorter side.
[[nodiscard]] glm::dvec2 picture_place(const Box& pane, double x, double y);

/// Where the slider's track lies. `scale`: window pixels a user-interface pixel.
[[nodiscard]] Box slider_track(double width, double height, double scale);

}  // namespace isolux::viewer
