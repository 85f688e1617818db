#include "app/viewer.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/framing.h"

namespace isolux::viewer {

Viewer::Viewer(Document document, const ViewerSettings& settings, const Stages& stages, std::function<void()> wake)
    : settings_(settings),
      stages_(stages),
      wake_(std::move(wake)),
      exposure_stops_(settings.exposure_stops),
      help_(settings.help),
      wants_exact_(settings.exact_light) {
  const std::optional<double> isovalue = settings.isovalue;
  start(std::move(document));
  if (isovalue) slider_->set_value(*isovalue);
  if (settings.layout) layout_ = *settings.layout;
  request_surface();
}

void Viewer::open(Document document) {
  start(std::move(document));
  request_surface();
}

void Viewer::start(Document document) {
  worker_.reset();
  bake_.reset();
  exact_.reset();
  document_ = std::move(document);
  shown_ = {};
  message_.clear();
  const std::shared_ptr<const ViewedVolume> volume = document_.volume;
  const Lattice& lattice = volume->lattice();
  renderer_ = std::make_unique<SurfaceRenderer>(volume);
  layout_ = Layout::kLocal;
  outer_ = settings_.outer.value_or(OuterSide::kLower);
  const ValueRange range = document_.histogram.range;
  slider_ = std::make_unique<Slider>(range.low, range.high, otsu_threshold(document_.histogram));
  trackball_ = std::make_unique<Trackball>(orbit_camera(lattice, settings_.azimuth_deg, settings_.elevation_deg, 1.0),
                                           box_middle(lattice), box_radius(lattice));
  if (document_.light) {
    take_light(document_.light);
    const std::optional<ValueRange> lit = document_.light->grid.detail.isovalues;
    const bool inside = !lit || (slider_->value() >= double(lit->low) && slider_->value() <= double(lit->high));
    if (!inside) slider_->set_value(0.5 * (double(lit->low) + double(lit->high)));
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

void Viewer::take_light(std::shared_ptr<const LightFile> light) {
  outer_ = settings_.outer.value_or(light_outer(*light));
  // Both sides keep their own light where the user calls the other side the outer one.
  const bool turned = light->inner && outer_ != light_outer(*light);
  renderer_->set_light(turned ? *light->inner : light->grid);
  if (light->inner) renderer_->set_inner_light(turned ? light->grid : *light->inner);
  shown_.exact = false;
  document_.light = std::move(light);
  if (layout_ == Layout::kLocal) layout_ = Layout::kGlobal;
}

void Viewer::request_surface() {
  exact_.reset();
  worker_->request({.isovalue = float(slider_->value()), .outer = outer_, .normals = NormalKind::kGradient});
}

void Viewer::act(Action action) {
  const double before = slider_->value();
  message_.clear();
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
      exposure_stops_ += 1.0 / 3.0;
      break;
    case Action::kDarker:
      exposure_stops_ -= 1.0 / 3.0;
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

void Viewer::toggle_light() {
  if (!document_.light && !shown_.exact) {
    say(advice());
    layout_ = Layout::kLocal;
  } else {
    layout_ = layout_ == Layout::kGlobal ? Layout::kLocal : Layout::kGlobal;
  }
}

void Viewer::show_side_by_side() {
  if (!document_.light && !shown_.exact) {
    say(advice());
  } else {
    layout_ = layout_ == Layout::kSideBySide ? Layout::kGlobal : Layout::kSideBySide;
  }
}

void Viewer::start_bake() {
  if (bake_) return;
  Run run = settings_.run;
  // One core is left to the window.
  run.threads = std::max(1, thread_count(run) - 1);
  bake_ = std::make_unique<BackgroundTask<LightFile>>(
      run,
      [volume = document_.volume, scene = settings_.scene, &stages = stages_](const Run& watched) {
        return bake_draft(volume->floats(), scene, stages, watched);
      },
      wake_);
}

void Viewer::toggle_exact_light() {
  wants_exact_ = !wants_exact_;
  exact_.reset();
  if (!wants_exact_) {
    shown_.exact = false;
    renderer_->set_exact_light({});
    if (!document_.light) layout_ = Layout::kLocal;
  }
}

void Viewer::start_exact_light() {
  Run run = settings_.run;
  run.threads = std::max(1, thread_count(run) - 1);
  exact_ = std::make_unique<BackgroundTask<PointLight>>(
      run,
      [document = document_, scene = settings_.scene, positions = shown_.surface.mesh.positions,
       &stages = stages_](const Run& watched) { return trace_surface(document, scene, positions, stages, watched); },
      wake_);
}

void Viewer::export_shown() {
  const std::string path = free_file_name(document_.volume->name(), slider_->value(), "ply");
  try {
    export_surface(document_, stages_, settings_.extractor,
                   {.isovalue = float(slider_->value()), .outer = outer_, .normals = NormalKind::kGradient},
                   settings_.run, path);
    say(fmt::format("wrote {}{}", path, document_.light ? "" : " (no light: without colours)"));
  } catch (const Error& error) {
    say(error.what());
  }
}

void Viewer::press(MouseButton button) {
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
  if (drag_ == Drag::kPan) trackball_->pan(a, b);
  // The height of the window is a factor of about 8.
  if (drag_ == Drag::kZoom) trackball_->zoom(10.0 * (b.y - a.y));
  return true;
}

void Viewer::release() {
  drag_ = Drag::kNone;
  slider_->release();
}

void Viewer::scroll(double steps) { trackball_->zoom(steps); }

void Viewer::say(const std::string& line) { message_ = line; }

bool Viewer::update() {
  const bool surface = update_surface();
  const bool bake = update_bake();
  return update_exact_light() || surface || bake;
}

bool Viewer::update_surface() {
  std::optional<Surface> surface = worker_->take();
  if (!surface) return false;
  renderer_->set_surface(surface->mesh, surface->settings.isovalue);
  if (!surface->error.empty()) say(surface->error);
  worker_->recycle(std::move(shown_.surface.mesh));
  shown_ = {.surface = std::move(*surface)};
  return true;
}

bool Viewer::update_bake() {
  if (!bake_) return false;
  auto outcome = bake_->take();
  if (!outcome) return true;  // its progress is shown
  bake_.reset();
  if (outcome->result) {
    take_light(std::make_shared<const LightFile>(std::move(*outcome->result)));
    request_surface();
    say("a draft of the light; isolux bake makes a better one");
  } else {
    say(outcome->error);
  }
  return true;
}

bool Viewer::update_exact_light() {
  const bool rests = worker_->idle() && drag_ == Drag::kNone && !bake_;
  if (wants_exact_ && !exact_ && !shown_.exact && rests && !shown_.surface.mesh.positions.empty()) start_exact_light();
  if (!exact_) return false;
  auto outcome = exact_->take();
  if (!outcome) return true;
  exact_.reset();
  if (outcome->result) {
    renderer_->set_exact_light(outcome->result->radiance);
    shown_.exact = true;
    if (layout_ == Layout::kLocal) layout_ = Layout::kGlobal;
  } else {
    wants_exact_ = false;
    say(outcome->error);
  }
  return true;
}

bool Viewer::settled() const {
  return worker_->idle() && !bake_ && !exact_ &&
         (!wants_exact_ || shown_.exact || shown_.surface.mesh.positions.empty());
}

std::optional<std::string> Viewer::take_screenshot_request() {
  if (!std::exchange(screenshot_, false)) return std::nullopt;
  return free_file_name(document_.volume->name(), slider_->value(), "png");
}

}  // namespace isolux::viewer
