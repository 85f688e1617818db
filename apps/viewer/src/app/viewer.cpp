#include "app/viewer.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "camera/framing.h"
#include "model/saved_file.h"

namespace isolux::viewer {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Viewer::Viewer(Document document, const ViewerSettings& settings, const Stages& stages, std::function<void()> wake)
    : settings_(settings),
      stages_(stages),
      wake_(std::move(wake)),
      exposure_stops_(settings.exposure_stops),
      help_(settings.help),
      wants_exact_(settings.exact_light) {
  const std::optional<double> isovalue = settings.isovalue;
  start(std::move(document));
  if (isovalue) {
    slider_->set_value(*isovalue);
    if (*isovalue < slider_->low() || *isovalue > slider_->high()) {
      say(fmt::format("isovalue {} is outside the values, {} to {}: the nearest is shown", *isovalue,
                      float(slider_->low()), float(slider_->high())));
    }
  }
  if (settings.layout) layout_ = *settings.layout;
  request_surface();
}

void Viewer::open(Document document) {
  start(std::move(document));
  request_surface();
}

void Viewer::start(Document document) {
  // Before anything else changes: OpenGL may refuse.
  auto renderer = std::make_unique<SurfaceRenderer>(document.volume);
  worker_.reset();
  bake_.reset();
  exact_.reset();
  document_ = std::move(document);
  shown_ = {};
  dismiss();
  exact_failure_.clear();
  replaced_.reset();
  is_draft_ = false;
  const std::shared_ptr<const ViewedVolume> volume = document_.volume;
  const Lattice& lattice = volume->lattice();
  renderer_ = std::move(renderer);
  layout_ = document_.light || wants_exact_ ? Layout::kGlobal : Layout::kLocal;
  screenshot_ = false;
  lighted_.scene = settings_.scene.value_or(Scene{});
  lighted_.outer = outer_side(document_, lighted_.scene, settings_.outer);
  const ValueRange range = document_.histogram.range;
  slider_ = std::make_unique<Slider>(range.low, range.high, otsu_threshold(document_.histogram));
  trackball_ = std::make_unique<Trackball>(orbit_camera(lattice, settings_.azimuth_deg, settings_.elevation_deg, 1.0),
                                           box_middle(lattice), box_radius(lattice));
  if (document_.light) {
    take_light(*document_.light);
    const std::optional<ValueRange> lit = document_.light->file->grid.detail.isovalues;
    if (!has_light_of(document_, float(slider_->value())))
      slider_->set_value(0.5 * (double(lit->low) + double(lit->high)));
  }
  const auto maker = std::make_shared<SurfaceMaker>(volume, stages_.extractors, settings_.extractor);
  worker_ = std::make_unique<SurfaceWorker>(
      [maker, run = settings_.run](const ExtractSettings& wanted, IndexedMesh memory, std::stop_token stop) {
        Run stoppable = run;
        stoppable.stop = std::move(stop);
        stoppable.progress = {};
        return maker->make(wanted, std::move(memory), stoppable);
      },
      wake_);
}

void Viewer::request_surface() {
  exact_.reset();
  worker_->request({.isovalue = float(slider_->value()), .outer = lighted_.outer, .normals = NormalKind::kGradient});
}

void Viewer::act(Action action) {
  const double before = slider_->value();
  dismiss();
  switch (action) {
    case Action::kToggleLight:
      toggle_light();
      break;
    case Action::kSideBySide:
      show_side_by_side();
      break;
    case Action::kResetView:
      trackball_->reset();
      break;
    case Action::kWireframe:
      style_ = style_ == SurfaceStyle::kShaded ? SurfaceStyle::kTriangles : SurfaceStyle::kShaded;
      break;
    case Action::kBrighter:
      expose(1.0 / 3.0);
      break;
    case Action::kDarker:
      expose(-1.0 / 3.0);
      break;
    case Action::kIsovalueDown:
      slider_->step(-1.0 / 500.0);
      break;
    case Action::kIsovalueUp:
      slider_->step(1.0 / 500.0);
      break;
    case Action::kIsovalueFarDown:
      slider_->step(-1.0 / 20.0);
      break;
    case Action::kIsovalueFarUp:
      slider_->step(1.0 / 20.0);
      break;
    case Action::kBake:
      start_bake();
      break;
    case Action::kExactLight:
      toggle_exact_light();
      break;
    case Action::kScreenshot:
      screenshot_ = true;
      if (!worker_->idle()) say("the picture is saved when its surface is there");
      break;
    case Action::kExport:
      export_shown();
      break;
    case Action::kHelp:
      help_ = !help_;
      break;
    case Action::kQuit:
      quit_ = true;
      break;
  }
  if (slider_->value() != before) request_surface();
}

void Viewer::expose(double stops) {
  exposure_stops_ += stops;
  // Thirds that add up to none are shown without a sign of their rounding.
  const double rounded = std::round(exposure_stops_ * 100.0) / 100.0 + 0.0;
  say(fmt::format("exposure of global light: {:+.2f} stops", rounded));
}

void Viewer::press(MouseButton button) {
  dismiss();
  if (button == MouseButton::kLeft && slider_->press(mouse_.x, mouse_.y)) {
    drag_ = Drag::kSlider;
    request_surface();
    return;
  }
  drag_pane_ = pane_at(make_panes(layout_, size_.width, size_.height), mouse_.x);
  drag_ = button == MouseButton::kLeft ? Drag::kRotate : button == MouseButton::kMiddle ? Drag::kPan : Drag::kZoom;
}

bool Viewer::move(double x, double y) {
  const glm::dvec2 from = std::exchange(mouse_, {x, y});
  if (drag_ == Drag::kNone) return false;
  if (drag_ == Drag::kSlider) {
    slider_->drag(x);
    request_surface();
    return true;
  }
  const auto panes = make_panes(layout_, size_.width, size_.height);
  const Box& box = panes[std::min(drag_pane_, panes.size() - 1)].box;
  const glm::dvec2 a = picture_place(box, from.x, from.y);
  const glm::dvec2 b = picture_place(box, x, y);
  if (drag_ == Drag::kRotate) trackball_->rotate(a, b);
  if (drag_ == Drag::kPan) {
    const double shorter_a_height = std::min(1.0, box.width / std::max(box.height, 1.0));
    trackball_->pan(shorter_a_height * a, shorter_a_height * b);
  }
  // The height of the window is a factor of about 8.
  if (drag_ == Drag::kZoom) trackball_->zoom(10.0 * (b.y - a.y));
  return true;
}

void Viewer::release() {
  drag_ = Drag::kNone;
  slider_->release();
}

void Viewer::scroll(double steps) {
  dismiss();
  trackball_->zoom(steps);
}

void Viewer::say(const std::string& text) {
  message_ = text;
  message_end_ = Clock::now() +
                 std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(settings_.message_seconds));
}

std::optional<double> Viewer::message_seconds_left() const {
  if (message_.empty()) return std::nullopt;
  return std::max(0.0, std::chrono::duration<double>(message_end_ - Clock::now()).count());
}

void Viewer::save(const std::string& extension, const std::function<void(const std::string& path)>& write,
                  const std::string& remark) {
  try {
    const std::string path = save_under_free_name(document_.volume->name(), slider_->value(), extension, write);
    say(fmt::format("wrote {}{}", path, remark));
  } catch (const std::exception& error) {
    say(fmt::format("not saved: {}", error.what()));
  }
}

bool Viewer::update() {
  const bool expired = message_seconds_left() == 0.0;
  if (expired) dismiss();
  const bool surface = update_surface() || expired;
  const bool bake = update_bake();
  return update_exact_light() || surface || bake;
}

bool Viewer::update_surface() {
  std::optional<Surface> surface = worker_->take();
  if (!surface) return false;
  try {
    renderer_->set_surface(surface->mesh, surface->settings.isovalue);
  } catch (const std::exception& error) {
    surface->mesh = {};
    surface->error = error.what();
  }
  worker_->recycle(std::move(shown_.surface.mesh));
  shown_ = {.surface = std::move(*surface)};
  return true;
}

std::string Viewer::failure() const { return shown_.surface.error.empty() ? exact_failure_ : shown_.surface.error; }

bool Viewer::take_screenshot_request() {
  if (!worker_->idle() || !std::exchange(screenshot_, false)) return false;
  if (shown_.surface.error.empty()) return true;
  say(fmt::format("not saved: {}", shown_.surface.error));
  return false;
}

}  // namespace isolux::viewer
