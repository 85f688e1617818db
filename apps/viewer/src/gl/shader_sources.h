#pragma once

namespace isolux::viewer {

// The files of src/shaders, put into the program by CMake.
extern const char* const kSurfaceVertexShader;
extern const char* const kSurfaceFragmentShader;
extern const char* const kLightVertexShader;
extern const char* const kOverlayVertexShader;
extern const char* const kOverlayFragmentShader;

}  // namespace isolux::viewer
