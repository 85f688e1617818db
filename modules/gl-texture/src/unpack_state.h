#pragma once

#include <epoxy/gl.h>

#include <array>
#include <cstddef>

namespace isolux {

/// Sets GL's pixel unpacking to tightly packed client memory and puts the application's settings back at the end.
class UnpackState {
 public:
  UnpackState() {
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &buffer_);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      glGetIntegerv(kNames[i], &values_[i]);
      glPixelStorei(kNames[i], kNames[i] == GL_UNPACK_ALIGNMENT ? 1 : 0);
    }
  }
  UnpackState(const UnpackState&) = delete;
  UnpackState& operator=(const UnpackState&) = delete;
  ~UnpackState() {
    for (std::size_t i = 0; i < kNames.size(); ++i) glPixelStorei(kNames[i], values_[i]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, GLuint(buffer_));
  }

 private:
  static constexpr std::array<GLenum, 8> kNames{GL_UNPACK_ALIGNMENT,   GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT,
                                                GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_IMAGES,
                                                GL_UNPACK_SWAP_BYTES,  GL_UNPACK_LSB_FIRST};
  std::array<GLint, kNames.size()> values_{};
  GLint buffer_ = 0;
};

}  // namespace isolux
