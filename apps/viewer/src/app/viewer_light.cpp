// Where the viewer's light comes from: a file, a draft, exact light; and where it goes to, a saved surface.
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "app/viewer.h"

namespace isolux::viewer {
namespace {

/// One core is left to the window.
Run in_background(Run run) {
  run.threads = std::max(1, thread_count(run) - 1);
  return run;
}

}  // namespace

void Viewer::take_light(KnownLight light) {
  const LightFile& file = *light.file;
  // Both sides keep their own light where the user calls the other side the outer one.
  const IlluminationGrid* inner = file.inner ? grid_of(file, opposite(lighted_.outer)) : nullptr;
  renderer_->set_light(shown_grid(file, lighted_.outer), inner);
  forget_exact_light();
  document_.light = std::move(light);
}

void Viewer::show_global() {
  if (layout_ == Layout::kLocal) layout_ = Layout::kGlobal;
}

void Viewer::forget_exact_light() {
  exact_.reset();
  shown_.exact = false;
  shown_.radiance.clear();
}

void Viewer::toggle_light() {
  if (!document_.light && !shown_.exact) {
    say(advice());
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

std::optional<Scene> Viewer::draft_scene() const {
  std::optional<Scene> scene = lighted_.scene;
  if (document_.light && !settings_.scene) scene = document_.light->scene;
  if (scene) scene->outer = lighted_.outer;
  return scene;
}

void Viewer::start_bake() {
  if (bake_) return;
  if (replaced_) return bring_light_back();
  const std::optional<Scene> scene = draft_scene();
  if (!scene) return say("the light given does not tell its whole scene: a draft needs --scene SCENE.json");
  show_global();
  const DraftLimits limits{.texels_an_axis = largest_texture()};
  bake_ = std::make_unique<BackgroundTask<KnownLight>>(
      in_background(settings_.run),
      [volume = document_.volume, scene = *scene, limits, &stages = stages_](const Run& watched) {
        return KnownLight{
            .file = std::make_shared<const LightFile>(bake_draft(volume->floats(), scene, limits, stages, watched)),
            .scene = scene};
      },
      wake_);
}

bool Viewer::update_bake() {
  if (!bake_) return false;
  auto outcome = bake_->take();
  if (!outcome) return true;  // its progress is shown
  bake_.reset();
  if (outcome->result) {
    replace_light(std::move(*outcome->result));
  } else {
    say(fmt::format("no draft: {}", outcome->error));
  }
  return true;
}

void Viewer::replace_light(KnownLight draft) {
  std::optional<KnownLight> before = document_.light;
  try {
    take_light(std::move(draft));
  } catch (const std::exception& error) {
    return say(fmt::format("the draft cannot be shown: {}", error.what()));
  }
  if (before && !is_draft_) {
    replaced_ = std::move(before);
    say(fmt::format("a draft of the light, in the scene of {}, instead of the light given; b brings that back",
                    settings_.scene ? "--scene" : "that light"));
  } else {
    say("a draft of the light; isolux bake makes a better one");
  }
  is_draft_ = true;
}

void Viewer::bring_light_back() {
  try {
    take_light(*replaced_);
  } catch (const std::exception& error) {
    return say(fmt::format("the light given cannot be shown: {}", error.what()));
  }
  show_global();
  replaced_.reset();
  is_draft_ = false;
  say("the light given again");
}

void Viewer::toggle_exact_light() {
  wants_exact_ = !wants_exact_;
  exact_failure_.clear();
  forget_exact_light();
  if (wants_exact_) return show_global();
  renderer_->set_exact_light({});
  if (!document_.light && !bake_) layout_ = Layout::kLocal;
}

void Viewer::start_exact_light() {
  exact_ = std::make_unique<BackgroundTask<PointLight>>(
      in_background(settings_.run),
      [document = document_, lighted = lighted_, isovalue = shown_.surface.settings.isovalue,
       positions = shown_.surface.mesh.positions, &stages = stages_](const Run& watched) {
        return trace_surface(document, lighted, isovalue, positions, stages, watched);
      },
      wake_);
}

bool Viewer::update_exact_light() {
  const bool rests = worker_->idle() && drag_ == Drag::kNone && !bake_;
  if (wants_exact_ && !exact_ && !shown_.exact && rests && !shown_.surface.mesh.positions.empty()) start_exact_light();
  if (!exact_) return false;
  auto outcome = exact_->take();
  if (!outcome) return true;
  exact_.reset();
  try {
    if (!outcome->result) throw Error(outcome->error);
    renderer_->set_exact_light(outcome->result->radiance);
    shown_.radiance = std::move(outcome->result->radiance);
    shown_.exact = true;
  } catch (const std::exception& error) {
    wants_exact_ = false;
    exact_failure_ = error.what();
    say(fmt::format("no exact light: {}", exact_failure_));
  }
  return true;
}

bool Viewer::settled() const {
  return worker_->idle() && !bake_ && !exact_ &&
         (!wants_exact_ || shown_.exact || shown_.surface.mesh.positions.empty());
}

VertexLight Viewer::light_to_save() const {
  const auto isovalue = float(slider_->value());
  if (shown_.exact && shown_.surface.settings.isovalue == isovalue) {
    return {
        .source = VertexLight::Source::kExact, .positions = shown_.surface.mesh.positions, .radiance = shown_.radiance};
  }
  VertexLight light;
  if (has_light_of(document_, isovalue)) light.source = VertexLight::Source::kBaked;
  return light;
}

void Viewer::export_shown() {
  const VertexLight light = light_to_save();
  const ExtractSettings settings{
      .isovalue = float(slider_->value()), .outer = lighted_.outer, .normals = NormalKind::kGradient};
  std::string remark;
  if (light.source == VertexLight::Source::kNone) {
    remark = document_.light ? " without colours: the light is of other isovalues" : " without colours: no light";
  }
  save(
      "ply",
      [&](const std::string& path) {
        export_surface(document_, lighted_.scene, light, stages_, settings_.extractor, settings, settings_.run, path);
      },
      remark);
}

}  // namespace isolux::viewer
