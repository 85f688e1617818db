#pragma once

namespace isolux::viewer {

/// A rectangle in window pixels, y downwards.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] bool contains(double px, double py) const {
    return px >= x && px < x + width && py >= y && py < y + height;
  }
};

}  // namespace isolux::viewer
