#include "gl/overlay.h"

#include "gl/shader_sources.h"
#include "ui/text.h"

namespace isolux::viewer {

Overlay::Overlay() : program_({kOverlayVertexShader}, {kOverlayFragmentShader}) {
  vertex_array_.bind();
  buffer_.bind();
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
  // OpenGL wants the offset in the buffer as a pointer.
  const auto* colour_offset = reinterpret_cast<const void*>(offsetof(Corner, colour));  // NOLINT: see above
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Corner), colour_offset);
}

void Overlay::rectangle(const Box& box, const Rgba8& colour) {
  const auto corner = [&](int right, int down) {
    corners_.push_back({float(box.x + right * box.width), float(box.y + down * box.height), colour});
  };
  corner(0, 0);
  corner(1, 0);
  corner(1, 1);
  corner(0, 0);
  corner(1, 1);
  corner(0, 1);
}

void Overlay::text(double x, double y, double size, std::string_view text, const Rgba8& colour) {
  for (const Box& stroke : text_boxes(text))
    rectangle({x + size * stroke.x, y + size * stroke.y, size * stroke.width, size * stroke.height}, colour);
}

void Overlay::draw(double window_width, double window_height) {
  if (corners_.empty()) return;
  program_.use();
  glUniform2f(program_.uniform("window_size"), float(window_width), float(window_height));
  vertex_array_.bind();
  buffer_.fill(corners_.data(), corners_.size() * sizeof(Corner));
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(corners_.size()));
  glDisable(GL_BLEND);
  corners_.clear();
}

}  // namespace isolux::viewer
