#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/scene_file.h>
#include <isolux/bake/version.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "json_reader.h"

namespace isolux {
namespace {

constexpr const char* kQuantity = "irradiance/pi";

nlohmann::json choice_to_json(const BackendChoice& choice) {
  nlohmann::json json{{"name", choice.name}};
  for (const auto& [key, value] : choice.settings) json["set"][key] = value;
  return json;
}

/// What messages call a light's scene.
std::string scene_name(const LightFile& light) {
  return light.path.empty() ? "isolux.scene of the light" : light.path + ": isolux.scene";
}

/// The scene in the light's header; nothing if there is none, as in a light that somebody else made.
std::optional<Scene> scene_of(const LightFile& light) {
  const auto it = light.metadata.find("isolux.scene");
  if (it == light.metadata.end()) return std::nullopt;
  // An image environment is described, not repeated: what shading needs is the albedo and the outer side.
  const std::string name = scene_name(light);
  auto json = parse_json(it->second, name);
  if (!json.is_object()) throw InvalidInput(fmt::format("{}: not a JSON object", name));
  json.erase("environment");
  return parse_scene(json.dump(), "", name);
}

/// Whether the environment of a scene, which may be anything, is an image.
bool has_image(const nlohmann::json& scene) {
  const auto environment = scene.find("environment");
  if (environment == scene.end() || !environment->is_object()) return false;
  const auto type = environment->find("type");
  return type != environment->end() && *type == "image";
}

}  // namespace

std::string settings_to_json(const BakeSettings& settings, const Run& run) {
  nlohmann::json json{{"sampler", choice_to_json(settings.sampler)},
                      {"tracer", choice_to_json(settings.tracer)},
                      {"resampler", choice_to_json(settings.resampler)},
                      {"lattice", settings.lattice == TexelLattice::kCells ? "cells" : "voxels"},
                      {"seed", run.seed}};
  if (settings.texel_sites == TexelSites::kNeeded) json["sites"] = "need";
  if (settings.target_rmse > 0.0) json["rmse"] = settings.target_rmse;
  if (settings.target_seconds > 0.0) json["time"] = settings.target_seconds;
  if (!json.contains("rmse") && !json.contains("time")) json["rays"] = settings.trace.rays;
  if (settings.trace.bounces == kAllBounces) {
    json["bounces"] = "all";
  } else {
    json["bounces"] = settings.trace.bounces;
  }
  json["bounce_method"] = iterates(settings) ? "iterated" : "paths";
  json["gradient"] = settings.trace.gradient == GradientKind::kCell ? "cell" : "central_differences";
  if (settings.samples != 0) json["samples"] = settings.samples;
  if (settings.texels) json["texels"] = {settings.texels->x, settings.texels->y, settings.texels->z};
  if (settings.isovalues) json["iso_range"] = {settings.isovalues->low, settings.isovalues->high};
  return json.dump();
}

LightFile make_light_file(BakeResult result, const Volume& volume, const Scene& scene, const Run& run) {
  const ValueRange range = result.settings.isovalues.value_or(value_range(volume));
  LightFile light;
  light.metadata = {{"isolux.version", kVersion},
                    {"isolux.quantity", kQuantity},
                    {"isolux.scene", scene_to_json(scene)},
                    {"isolux.settings", settings_to_json(result.settings, run)},
                    {"isolux.volume_sha256", volume_sha256(volume)},
                    {"isolux.iso_range", fmt::format("{}:{}", range.low, range.high)}};
  if (!std::isnan(result.rmse_estimate))
    light.metadata["isolux.rmse_estimate"] = fmt::format("{:.6g}", result.rmse_estimate);
  light.grid = std::move(result.light);
  light.inner = std::move(result.inner_light);
  return light;
}

LightFile make_error_file(const BakeResult& result, const Volume& volume, const Scene& scene, const Run& run) {
  if (!result.error) throw InvalidInput("the bake was not asked for a grid of errors");
  LightFile file;
  file.metadata = {{"isolux.version", kVersion},
                   {"isolux.quantity", "standard error of irradiance/pi"},
                   {"isolux.scene", scene_to_json(scene)},
                   {"isolux.settings", settings_to_json(result.settings, run)},
                   {"isolux.volume_sha256", volume_sha256(volume)}};
  file.grid = *result.error;
  file.inner = result.inner_error;
  return file;
}

void require_light_of(const LightFile& light, const Volume& volume, const std::string& light_path) {
  const auto quantity = light.metadata.find("isolux.quantity");
  if (quantity != light.metadata.end() && quantity->second != kQuantity) {
    throw InvalidInput(fmt::format("{}: it holds '{}' and not the light, '{}'; --force uses it all the same",
                                   light_path, quantity->second, kQuantity));
  }
  const auto it = light.metadata.find("isolux.volume_sha256");
  if (it == light.metadata.end()) {
    throw InvalidInput(fmt::format(
        "{}: it does not say which volume it lights (no isolux.volume_sha256); --force uses it all the same",
        light_path));
  }
  const std::string here = volume_sha256(volume);
  if (it->second != here) {
    throw InvalidInput(
        fmt::format("{}: it lights another volume (sha256 {}...) than {} ({}...); --force uses it all the same",
                    light_path, it->second.substr(0, 12), volume.name, here.substr(0, 12)));
  }
}

std::optional<Scene> light_scene(const LightFile& light) {
  const auto it = light.metadata.find("isolux.scene");
  if (it == light.metadata.end()) return std::nullopt;
  const auto json = nlohmann::json::parse(it->second, nullptr, false);
  if (!json.is_object() || has_image(json)) return std::nullopt;
  return parse_scene(it->second, "", scene_name(light));
}

SurfaceColour surface_colour(const Scene& scene, float isovalue) {
  return {.albedo = scene.albedo.at(isovalue), .emission = scene.emission.at(isovalue)};
}

SurfaceColour surface_colour(const LightFile& light, float isovalue) {
  return surface_colour(scene_of(light).value_or(Scene{}), isovalue);
}

int light_bounces(const LightFile& light) {
  const auto it = light.metadata.find("isolux.settings");
  if (it == light.metadata.end()) return kAllBounces;
  const auto json = nlohmann::json::parse(it->second, nullptr, false);
  if (!json.is_object()) return kAllBounces;
  const auto bounces = json.find("bounces");
  if (bounces == json.end() || !bounces->is_number_unsigned()) return kAllBounces;
  constexpr auto kMost = std::uint64_t(std::numeric_limits<int>::max());
  return int(std::min(bounces->get<std::uint64_t>(), kMost));
}

OuterSide light_outer(const LightFile& light) { return scene_of(light).value_or(Scene{}).outer; }

LevelSetSide side_towards(const LightFile& light, OuterSide outer) {
  return outer == light_outer(light) ? LevelSetSide::kOuter : LevelSetSide::kInner;
}

}  // namespace isolux
