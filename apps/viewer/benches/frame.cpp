// What does reading the light cost a frame? The same surface, camera and framebuffer (1920x1080, 4 samples, as the
// window has them) in local light and in each kind of global light, in turns; `of_local` is the ratio of the medians by
// OpenGL's timer, `of_local_wall` by the clock between two glFinish(), which counts what a software renderer does
// before its timer starts. Light is made up: its values do not matter to the time. ISOLUX_EGL_DEVICE=N measures a GPU.
#include <benchmark/benchmark.h>
#include <epoxy/gl.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/common.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "camera/framing.h"
#include "egl_context.h"
#include "gl/surface_renderer.h"
#include "model/surface.h"

namespace {

using namespace isolux;
using namespace isolux::viewer;

constexpr int kWidth = 1920;
constexpr int kHeight = 1080;

/// A framebuffer like that of the window, bound while it lives.
class Framebuffer {
 public:
  Framebuffer() {
    glGenFramebuffers(1, &name_);
    glGenRenderbuffers(2, buffers_);
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    attach(buffers_[0], GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(buffers_[1], GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
    glViewport(0, 0, kWidth, kHeight);
  }
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;
  ~Framebuffer() {
    glDeleteRenderbuffers(2, buffers_);
    glDeleteFramebuffers(1, &name_);
  }

 private:
  static void attach(GLuint buffer, GLenum format, GLenum place) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, format, kWidth, kHeight);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  }
  GLuint name_ = 0;
  GLuint buffers_[2]{};
};

struct Seconds {
  double gpu = 0.0;
  double wall = 0.0;
};

Seconds draw(SurfaceRenderer& renderer, const SurfaceView& view) {
  static const GLuint query = [] {
    GLuint name = 0;
    glGenQueries(1, &name);
    return name;
  }();
  glFinish();
  const Stopwatch watch;
  glBeginQuery(GL_TIME_ELAPSED, query);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  renderer.draw(view);
  glEndQuery(GL_TIME_ELAPSED);
  glFinish();
  const double wall = watch.seconds();
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
  return {.gpu = 1e-9 * double(nanoseconds), .wall = wall};
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A surface to draw; its renderer is made with the first frame and kept for the next scheme.
struct Subject {
  std::string volume;
  float isovalue = 0.0f;
  float half_range = 0.0f;  ///< of the isovalues that a sparse light knows
};

struct Loaded {
  std::shared_ptr<const ViewedVolume> volume;
  std::unique_ptr<SurfaceRenderer> renderer;
  std::size_t triangles = 0;
};

Loaded load(const Subject& subject) {
  Loaded loaded;
  loaded.volume = std::make_shared<const ViewedVolume>(read_volume(subject.volume));
  loaded.renderer = std::make_unique<SurfaceRenderer>(loaded.volume);
  const Surface surface = SurfaceMaker(loaded.volume, isolux::extractors(), {})
                              .make({.isovalue = subject.isovalue, .normals = NormalKind::kGradient}, {}, {});
  loaded.renderer->set_surface(surface.mesh, subject.isovalue);
  loaded.triangles = surface.mesh.triangles.size();
  return loaded;
}

struct Scheme {
  const char* name;
  int channels = 1;
  bool slopes = false;
  bool fitted = false;  ///< all that a fit says: slopes, normals and near field, of .73 texels a cell and axis
  bool near_field = false;
  bool bricks = false;
};

IlluminationGrid make_light(const Volume& volume, const Subject& subject, const Scheme& scheme) {
  const double a_cell = scheme.fitted ? 0.73 : 1.0;
  const Index3 texels(glm::round(a_cell * Vec3(volume.lattice().size - 1)));
  IlluminationGrid light(cell_lattice(volume.lattice(), texels), scheme.channels);
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] = 0.3f + 0.02f * float(i * 7 % 31);
  if (scheme.slopes || scheme.fitted) light.detail.slopes.assign(light.values.size(), 1e-3f);
  if (scheme.fitted) light.detail.normal_slopes.fill(std::vector<float>(light.values.size(), 0.1f));
  if (scheme.near_field || scheme.fitted) {
    light.detail.near_field = {{.step = 1.0f, .mean = 0.9f, .weight = Vec3f(0.2f)},
                               {.step = 2.0f, .mean = 0.8f, .weight = Vec3f(0.1f)}};
  }
  light.detail.ceiling = 1.0f;
  if (scheme.bricks) {
    light.detail.isovalues =
        ValueRange{.low = subject.isovalue - subject.half_range, .high = subject.isovalue + subject.half_range};
  }
  return light;
}

void frame(benchmark::State& state, Loaded& loaded, const Subject& subject, const Scheme& scheme, double zoom) {
  if (!loaded.volume) loaded = load(subject);
  SurfaceRenderer& renderer = *loaded.renderer;
  renderer.set_light(make_light(loaded.volume->floats(), subject, scheme));
  SurfaceView view;
  view.aspect = double(kWidth) / kHeight;
  view.camera = orbit_camera(loaded.volume->lattice(), 30.0, 20.0, 1.0);
  view.camera.half_height /= zoom;
  const Framebuffer framebuffer;
  const auto timed = [&](Lighting lighting) {
    view.lighting = lighting;
    return draw(renderer, view);
  };
  for (int i = 0; i < 3; ++i) static_cast<void>(timed(i == 0 ? Lighting::kLocal : Lighting::kGlobal));
  std::vector<double> local;
  std::vector<double> lit;
  std::vector<double> local_wall;
  std::vector<double> lit_wall;
  for (auto _ : state) {
    const Seconds without = timed(Lighting::kLocal);
    const Seconds with = timed(Lighting::kGlobal);
    local.push_back(without.gpu);
    local_wall.push_back(without.wall);
    lit.push_back(with.gpu);
    lit_wall.push_back(with.wall);
    state.SetIterationTime(std::max(with.gpu, 1e-9));
  }
  const double local_median = median(local);
  const double local_wall_median = median(local_wall);
  state.counters["triangles"] = double(loaded.triangles);
  state.counters["local_ms"] = 1e3 * local_median;
  state.counters["lit_ms"] = 1e3 * median(lit);
  state.counters["of_local"] = median(lit) / local_median;
  state.counters["of_local_wall"] = median(lit_wall) / local_wall_median;
  state.counters["light_MB"] = 1e-6 * double(renderer.light_memory().light);
  state.counters["dense_MB"] = 1e-6 * double(renderer.light_memory().dense);
  state.counters["volume_MB"] = 1e-6 * double(renderer.light_memory().volume);
}

constexpr Scheme kSchemes[] = {{.name = "plain"},
                               {.name = "plain_rgb", .channels = 3},
                               {.name = "plain_bricks", .bricks = true},
                               {.name = "slopes", .slopes = true},
                               {.name = "near_field", .near_field = true},
                               {.name = "fit", .fitted = true},
                               {.name = "fit_rgb", .channels = 3, .fitted = true},
                               {.name = "fit_bricks", .fitted = true, .bricks = true}};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const test::EglContext context;
  if (!context) {
    std::printf("%s\n", context.why().c_str());
    return 1;
  }
  benchmark::AddCustomContext("OpenGL", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  std::vector<Subject> subjects{{"gen:gyroid:256", 0.0f, 0.15f}};
  if (const char* folder = std::getenv("ISOLUX_DATA")) {
    subjects.push_back({std::string(folder) + "/engine.nrrd", 110.0f, 12.75f});
  }
  std::vector<Loaded> loaded(subjects.size());
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    for (const auto& [view, zoom] : {std::pair{"whole", 1.0}, std::pair{"close", 4.0}}) {
      for (const Scheme& scheme : kSchemes) {
        const std::string volume = subjects[s].volume.substr(subjects[s].volume.rfind('/') + 1);
        benchmark::RegisterBenchmark(
            (volume + "/" + view + "/" + scheme.name).c_str(),
            [&, s, zoom = zoom](benchmark::State& state) { frame(state, loaded[s], subjects[s], scheme, zoom); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  loaded.clear();
}
