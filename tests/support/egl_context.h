#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <string>
#include <utility>

namespace isolux::test {

/// An OpenGL 4.5 core context (3.3 where that is all) without window or display, current while it lives: Mesa's
/// surfaceless platform, or with the environment variable ISOLUX_EGL_DEVICE=N the N-th EGL device, such as a GPU.
/// Programs that use it link EGL.
///
///   const EglContext context;
///   if (!context) GTEST_SKIP() << context.why();
class EglContext {
 public:
  EglContext() { start(); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  ~EglContext() {
    if (display_ == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }

  explicit operator bool() const { return why_.empty(); }
  /// Why there is no context.
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  void start() {
    display_ = open_display();
    if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) {
      display_ = EGL_NO_DISPLAY;
      why_ = "EGL offers no display here";
      return;
    }
    eglBindAPI(EGL_OPENGL_API);
    const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
      config = EGL_NO_CONFIG_KHR;
    }
    for (const auto& [major, minor] : {std::pair{4, 5}, std::pair{3, 3}}) {
      const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                          major,
                                          EGL_CONTEXT_MINOR_VERSION,
                                          minor,
                                          EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                          EGL_NONE};
      context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version.data());
      if (context_ != EGL_NO_CONTEXT) break;
    }
    if (context_ == EGL_NO_CONTEXT || eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      why_ = "EGL gives no surfaceless OpenGL 3.3 core context here";
    }
  }

  static EGLDisplay open_display() {
    const char* device = std::getenv("ISOLUX_EGL_DEVICE");
    if (device == nullptr) return eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    const int wanted = std::atoi(device);
    if (query == nullptr || query(EGLint(devices.size()), devices.data(), &count) != EGL_TRUE || wanted >= count) {
      return EGL_NO_DISPLAY;
    }
    return eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[std::size_t(wanted)], nullptr);
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  std::string why_;
};

}  // namespace isolux::test
