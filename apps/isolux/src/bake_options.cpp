#include "bake_options.h"

#include <fmt/format.h>
#include <isolux/bake/scene_file.h>

#include "parse.h"
#include "scene_files.h"
#include "usage.h"

namespace isolux {
namespace {

/// Rays a site at each quality.
const std::vector<std::pair<std::string, int>> kQualities{{"draft", 16}, {"good", 64}, {"reference", 1024}};

}  // namespace

void TraceOptions::add_scene_to(CLI::App& command, Session& session, const std::string& help) {
  session.reads({.name = "--scene", .paths = [this] { return scene_files(scene_); }});
  command.add_option("--scene", scene_, help)->type_name("SCENE.json");
}

void TraceOptions::add_to(CLI::App& command, Session& session, const std::string& origins, const std::string& first) {
  const std::string what = "environment, lights, albedo and emission (default: ";
  add_scene_to(command, session, what + first + "uniform white sky, albedo 0.8)");
  command.add_option("--bounces", bounces_, "reflections: a number, or all (default: " + first + "all)")
      ->type_name("B|all");
  command.add_option("--quality", quality_, "draft, good (default) or reference: 16, 64 or 1024 rays " + origins)
      ->check(CLI::IsMember({"draft", "good", "reference"}));
  command.add_option("--rays", rays_, "rays " + origins + "; overrides --quality")
      ->transform(whole_number(1, 1 << 20))
      ->type_name("R");
  command.add_option("--tracer", tracer_, "tracer backend")->type_name("NAME");
}

Scene TraceOptions::scene() const { return scene_.empty() ? Scene{} : read_scene(scene_); }

TraceSettings TraceOptions::settings() const {
  TraceSettings settings;
  if (bounces_given()) settings.bounces = parse_bounces(bounces_);
  for (const auto& [name, rays] : kQualities) {
    if (name == quality_) settings.rays = rays;
  }
  if (rays_ > 0) settings.rays = rays_;
  return settings;
}

}  // namespace isolux
