// What the viewer shows: panes and slider.
#include <epoxy/gl.h>
#include <isolux/core/error.h>
#include <isolux/core/stopwatch.h>
#include <isolux/render/image.h>

#include <algorithm>
#include <cmath>

#include "app/viewer.h"

namespace isolux::viewer {
namespace {

constexpr float kBackground = 0.2f;  // linear, as of isolux render
constexpr Rgba8 kTrack{20, 22, 26, 110};
constexpr Rgba8 kBars{20, 22, 26, 90};
constexpr Rgba8 kKnob{235, 120, 30, 255};

}  // namespace

bool Viewer::lit_here() const { return shown_.exact || has_light_of(document_, shown_.surface.settings.isovalue); }

Lighting Viewer::lighting_of(const Pane& pane) const { return lit_here() ? pane.lighting : Lighting::kLocal; }

void Viewer::draw_surface(const WindowSize& size, const glm::ivec2& first) {
  for (const Pane& pane : make_panes(layout_, size.width, size.height)) draw_pane(pane, size.height, first);
  glViewport(0, 0, size.width, size.height);
}

void Viewer::draw_pane(const Pane& pane, int height, const glm::ivec2& first) {
  SurfaceView view;
  view.style = style_;
  view.colour = surface_colour_of(document_, lighted_.scene, shown_.surface.settings.isovalue);
  view.lighting = lighting_of(pane);
  // As in isolux render it is of global light alone, not of the ground behind.
  view.exposure = view.lighting == Lighting::kGlobal ? float(std::exp2(exposure_stops_)) : 1.0f;
  view.aspect = std::max(pane.box.width, 1.0) / std::max(pane.box.height, 1.0);
  trackball_->reframe(
      orbit_camera(document_.volume->lattice(), settings_.azimuth_deg, settings_.elevation_deg, view.aspect));
  view.camera = trackball_->camera();
  const int left = int(pane.box.x) - first.x;
  const int width = std::max(int(pane.box.width), 1);
  const float ground = float(srgb_code(kBackground)) / 255.0f;
  glViewport(left, -first.y, width, height);
  glScissor(left, -first.y, width, height);
  glEnable(GL_SCISSOR_TEST);
  glClearColor(ground, ground, ground, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  try {
    renderer_->draw(view);
  } catch (const GlError& error) {
    // Global light wants memory for its vertices when it is first drawn; local light has all it needs.
    say(error.what());
    layout_ = Layout::kLocal;
    view.lighting = Lighting::kLocal;
    renderer_->draw(view);
  }
}

void Viewer::draw(const WindowSize& size) {
  size_ = size;
  const Stopwatch watch;
  draw_surface(size);
  // The time of the picture itself, without waiting for the display.
  glFinish();
  draw_seconds_ = watch.seconds();
  draw_slider(size);
  draw_texts(size);
  if (help_) draw_help(size);
  overlay_.draw(size.width, size.height);
}

void Viewer::draw_slider(const WindowSize& size) {
  const Box track = slider_track(size.width, size.height, size.scale);
  slider_->place(track);
  const auto& counts = document_.histogram.counts;
  const auto most = double(*std::max_element(counts.begin(), counts.end()));
  const double bar = track.width / Histogram::kSteps;
  for (int i = 0; i < Histogram::kSteps; ++i) {
    // Logarithmic: the background's peak would flatten all else.
    const double height =
        40.0 * size.scale * std::log1p(double(counts[std::size_t(i)])) / std::max(std::log1p(most), 1.0);
    overlay_.rectangle({track.x + i * bar, track.y - height, bar, height}, kBars);
  }
  overlay_.rectangle({track.x, track.y + 0.4 * track.height, track.width, 0.2 * track.height}, kTrack);
  const double knob = Slider::kKnobWidth * size.scale;
  overlay_.rectangle({slider_->position() - knob / 2.0, track.y, knob, track.height}, kKnob);
}

}  // namespace isolux::viewer
