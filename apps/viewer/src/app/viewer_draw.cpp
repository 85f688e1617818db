// What the viewer shows: panes, slider, texts.
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/viewer.h"
#include "ui/text.h"

namespace isolux::viewer {
namespace {

constexpr Vec3f kBackground(0.485f);  // the sRGB code of the linear 0.2 of isolux render
constexpr Rgba8 kInk{20, 22, 26, 255};
constexpr Rgba8 kPaper{250, 250, 248, 215};
constexpr Rgba8 kTrack{20, 22, 26, 110};
constexpr Rgba8 kBars{20, 22, 26, 90};
constexpr Rgba8 kKnob{235, 120, 30, 255};

std::string short_name(const std::string& name) {
  const std::string file = std::filesystem::path(name).filename().string();
  return file.empty() ? name : file;
}

/// Text on a light ground, so that it reads over any surface. Returns the height it takes.
double label(Overlay& overlay, double x, double y, double size, const std::string& text) {
  const auto lines = double(1 + std::count(text.begin(), text.end(), '\n'));
  const double pad = 4.0 * size;
  const double height = (lines * kLineHeight - 2.0) * size + 2.0 * pad;
  overlay.rectangle({x, y, text_width(text) * size + 2.0 * pad, height}, kPaper);
  overlay.text(x + pad, y + pad, size, text, kInk);
  return height;
}

/// 1234567 as 1 234 567.
std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (int i = int(digits.size()) - 3; i > 0; i -= 3) digits.insert(std::size_t(i), " ");
  return digits;
}

std::string in_words(const LightMemory& memory) {
  if (memory.light == 0) return "";
  const std::string light = fmt::format(" - light of {:.1f} MB", 1e-6 * double(memory.light));
  return memory.light == memory.dense ? light
                                      : light + fmt::format(" in bricks, not {:.1f}", 1e-6 * double(memory.dense));
}

}  // namespace

std::string Viewer::title() const {
  return fmt::format("isolux - {} - isovalue {:.5g} - {} triangles in {:.0f} ms - drawn in {:.1f} ms{}",
                     short_name(document_.volume->name()), slider_->value(),
                     grouped(shown_.surface.mesh.triangles.size()), 1e3 * shown_.surface.seconds, 1e3 * draw_seconds_,
                     in_words(renderer_->light_memory()));
}

bool Viewer::lit_here() const {
  if (shown_.exact || !document_.light || !document_.light->grid.detail.isovalues) return true;
  const ValueRange lit = *document_.light->grid.detail.isovalues;
  const float isovalue = shown_.surface.settings.isovalue;
  return lit.low <= isovalue && isovalue <= lit.high;
}

std::string Viewer::advice() const {
  if (bake_) return "the light is being baked";
  return "no light yet: press b for a draft, or\nisolux bake VOLUME -o LIGHT.nrrd  and give --light LIGHT.nrrd";
}

void Viewer::draw_surface(const WindowSize& size) {
  glViewport(0, 0, size.width, size.height);
  glClearColor(kBackground.r, kBackground.g, kBackground.b, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  SurfaceView view;
  view.camera = trackball_->camera();
  view.style = style_;
  view.colour = surface_colour_of(document_, float(slider_->value()));
  for (const Pane& pane : make_panes(layout_, size.width, size.height)) {
    glViewport(int(pane.box.x), 0, std::max(int(pane.box.width), 1), size.height);
    view.lighting = lit_here() ? pane.lighting : Lighting::kLocal;
    view.exposure = float(std::exp2(exposure_stops_));
    view.aspect = pane.box.width / std::max(pane.box.height, 1.0);
    renderer_->draw(view);
  }
  glViewport(0, 0, size.width, size.height);
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

void Viewer::draw_texts(const WindowSize& size) {
  const double font = 1.5 * size.scale;
  const double margin = 10.0 * size.scale;
  const auto panes = make_panes(layout_, size.width, size.height);
  for (const Pane& pane : panes) {
    label(overlay_, pane.box.x + margin, margin, font,
          pane.lighting == Lighting::kLocal || !lit_here() ? "local light"
          : shown_.exact                                   ? "global light, exact"
                                                           : "global light");
    if (pane.box.x > 0.0) overlay_.rectangle({pane.box.x - size.scale, 0.0, 2.0 * size.scale, pane.box.height}, kInk);
  }
  double y = margin + 30.0 * size.scale;
  if (bake_) {
    const auto progress = bake_->progress();
    y +=
        4.0 * size.scale + label(overlay_, margin, y, font,
                                 fmt::format("baking a draft: {} {:.0f} %", progress.stage, 100.0 * progress.fraction));
  }
  if (exact_) {
    y += 4.0 * size.scale + label(overlay_, margin, y, font,
                                  fmt::format("tracing exact light: {:.0f} %", 100.0 * exact_->progress().fraction));
  }
  if (!message_.empty()) {
    label(overlay_, margin, y, font, message_);
  } else if (!document_.light && !bake_ && !exact_ && !shown_.exact) {
    label(overlay_, margin, y, font, advice());
  } else if (!lit_here()) {
    const ValueRange lit = *document_.light->grid.detail.isovalues;
    label(overlay_, margin, y, font, fmt::format("the light is of isovalues {:.5g} to {:.5g}", lit.low, lit.high));
  } else if (shown_.surface.mesh.triangles.empty() && worker_->idle()) {
    label(overlay_, margin, y, font, "no surface at this isovalue");
  }
  const std::string value = fmt::format("isovalue {:.5g}", slider_->value());
  const double width = (text_width(value) + 8.0) * font;
  const double x = std::clamp(slider_->position() - width / 2.0, 0.0, std::max(size.width - width, 0.0));
  label(overlay_, x, slider_->track().y - 64.0 * size.scale, font, value);
  if (!help_) {
    const std::string hint = "h: help";
    label(overlay_, size.width - margin - (text_width(hint) + 8.0) * font, margin, font, hint);
  }
}

void Viewer::draw_help(const WindowSize& size) {
  const double font = 1.5 * size.scale;
  std::string names = "drag\nmiddle or shift drag\nwheel or right drag\n";
  std::string helps = "turn\nmove\nnearer or farther\n";
  for (const KeyBinding& binding : key_bindings()) {
    if (binding.name.empty()) continue;
    names += fmt::format("{}\n", binding.name);
    helps += fmt::format("{}\n", binding.help);
  }
  names += "drop a file";
  helps += "look at another volume";
  const double left = text_width(names) * font;
  const double width = left + text_width(helps) * font + 60.0 * size.scale;
  const auto lines = double(1 + std::count(names.begin(), names.end(), '\n'));
  const double height = lines * kLineHeight * font + 40.0 * size.scale;
  const Box box{(size.width - width) / 2.0, (size.height - height) / 2.0, width, height};
  overlay_.rectangle(box, {250, 250, 248, 240});
  const double x = box.x + 20.0 * size.scale;
  const double y = box.y + 20.0 * size.scale;
  overlay_.text(x, y, font, names, kInk);
  overlay_.text(x + left + 20.0 * size.scale, y, font, helps, kInk);
}

}  // namespace isolux::viewer
