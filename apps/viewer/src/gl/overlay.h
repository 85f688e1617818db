#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "gl/objects.h"
#include "ui/box.h"

namespace isolux::viewer {

using Rgba8 = std::array<std::uint8_t, 4>;

/// Rectangles and text over the picture: collected in window pixels (y downwards), drawn at once in the order given.
class Overlay {
 public:
  /// Needs a current OpenGL 3.3 core context. \throw GlError
  Overlay();

  void rectangle(const Box& box, const Rgba8& colour);
  /// Text with its top left corner at x, y; `size` pixels a font pixel.
  void text(double x, double y, double size, std::string_view text, const Rgba8& colour);
  /// Draws what was collected, blended and without depth test, into a window of this size; then forgets it.
  void draw(double window_width, double window_height);

 private:
  struct Corner {
    float x, y;
    Rgba8 colour;
  };
  std::vector<Corner> corners_;  ///< three a triangle
  ShaderProgram program_;
  VertexArray vertex_array_;
  Buffer buffer_{GL_ARRAY_BUFFER};
};

}  // namespace isolux::viewer
