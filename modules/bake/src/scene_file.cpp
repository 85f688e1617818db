#include <fmt/format.h>
#include <isolux/bake/scene_file.h>
#include <isolux/core/error.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>

#include "json_reader.h"

namespace isolux {
namespace {

using nlohmann::json;

[[noreturn]] void refuse_type(const JsonObject& object, const std::string& allowed) {
  throw InvalidInput(fmt::format("{}: type '{}'; allowed are {}", object.place(), object.text("type"), allowed));
}

Environment read_environment(const json& value, const std::string& folder, const std::string& place) {
  const JsonObject object(value, place);
  const std::string type = object.text("type");
  if (type == "uniform") {
    object.require_keys({"type", "radiance"});
    return UniformEnvironment{object.colour_or("radiance", Vec3f(1.0f))};
  }
  if (type == "sky") {
    object.require_keys({"type", "up", "zenith", "horizon", "ground"});
    const SkyEnvironment standard;
    return SkyEnvironment{.up = object.direction_or("up", standard.up),
                          .zenith = object.colour_or("zenith", standard.zenith),
                          .horizon = object.colour_or("horizon", standard.horizon),
                          .ground = object.colour_or("ground", standard.ground)};
  }
  if (type == "image") {
    object.require_keys({"type", "file", "up"});
    const std::string file = object.text("file");
    if (file.empty() || file.find('\0') != std::string::npos)
      throw InvalidInput(fmt::format("{}: {} is no file's name", object.place("file"), object.at("file").dump()));
    ImageEnvironment image = read_environment_image((std::filesystem::path(folder) / file).string());
    image.up = object.direction_or("up", image.up);
    return image;
  }
  refuse_type(object, "uniform, sky, image");
}

Light read_light(const json& value, const std::string& place) {
  const JsonObject object(value, place);
  const std::string type = object.text("type");
  if (type == "sun") {
    object.require_keys({"type", "direction", "irradiance", "angular_diameter_deg"});
    SunLight sun{.direction = object.direction("direction"), .irradiance = object.colour("irradiance")};
    if (object.has("angular_diameter_deg")) sun.angular_diameter_deg = object.positive("angular_diameter_deg");
    if (sun.angular_diameter_deg > kWidestSun) {
      throw InvalidInput(fmt::format("{}: {}; at most {} is allowed", object.place("angular_diameter_deg"),
                                     sun.angular_diameter_deg, kWidestSun));
    }
    return sun;
  }
  if (type == "rectangle") {
    object.require_keys({"type", "center", "u", "v", "radiance"});
    const RectangleLight rectangle{.center = object.position("center"),
                                   .u = object.direction("u"),
                                   .v = object.direction("v"),
                                   .radiance = object.colour("radiance")};
    if (glm::length(glm::cross(Vec3(rectangle.u), Vec3(rectangle.v))) <= 0.0)
      throw InvalidInput(fmt::format("{}: u and v are parallel; they must span an area", object.place()));
    return rectangle;
  }
  if (type == "sphere") {
    object.require_keys({"type", "center", "radius", "radiance"});
    return SphereLight{.center = object.position("center"),
                       .radius = object.positive("radius"),
                       .radiance = object.colour("radiance")};
  }
  refuse_type(object, "sun, rectangle, sphere");
}

IsovalueColour read_isovalue_colour(const JsonObject& scene, const char* key) {
  const json& value = scene.at(key);
  if (value.is_array()) return {{{0.0f, scene.colour(key)}}};
  if (!value.is_object())
    throw InvalidInput(fmt::format("{}: '{}' where [r,g,b] or {{\"by_isovalue\": [[h,r,g,b], ...]}} is wanted",
                                   scene.place(key), value.dump()));
  const JsonObject object(value, scene.place(key));
  object.require_keys({"by_isovalue"});
  const json& rows = object.at("by_isovalue");
  const std::string place = object.place("by_isovalue");
  if (!rows.is_array() || rows.empty())
    throw InvalidInput(place + ": an array [[h,r,g,b], ...] with at least one row is wanted");
  IsovalueColour colour;
  for (const json& row : rows) {
    const auto n = json_numbers(row, 4, place);
    if (n[1] < 0.0f || n[2] < 0.0f || n[3] < 0.0f) {
      throw InvalidInput(fmt::format("{}: {}; colours of at least 0 are wanted", place, row.dump()));
    }
    if (!colour.keys.empty() && !(colour.keys.back().isovalue < n[0])) {
      throw InvalidInput(
          fmt::format("{}: isovalue {} after {}; they must rise", place, n[0], colour.keys.back().isovalue));
    }
    colour.keys.push_back({n[0], {n[1], n[2], n[3]}});
  }
  return colour;
}

IsovalueColour read_albedo(const JsonObject& scene) {
  IsovalueColour albedo = read_isovalue_colour(scene, "albedo");
  for (const auto& key : albedo.keys) {
    if (key.colour.x > 1.0f || key.colour.y > 1.0f || key.colour.z > 1.0f) {
      throw InvalidInput(
          fmt::format("{}: {}; an albedo lies from 0 to 1", scene.place("albedo"), scene.at("albedo").dump()));
    }
  }
  return albedo;
}

json vector_to_json(const auto& v) { return json::array({v.x, v.y, v.z}); }

json environment_to_json(const Environment& environment) {
  if (const auto* uniform = std::get_if<UniformEnvironment>(&environment)) {
    return {{"type", "uniform"}, {"radiance", vector_to_json(uniform->radiance)}};
  }
  if (const auto* sky = std::get_if<SkyEnvironment>(&environment)) {
    return {{"type", "sky"},
            {"up", vector_to_json(sky->up)},
            {"zenith", vector_to_json(sky->zenith)},
            {"horizon", vector_to_json(sky->horizon)},
            {"ground", vector_to_json(sky->ground)}};
  }
  const auto& image = std::get<ImageEnvironment>(environment);
  return {{"type", "image"}, {"width", image.width}, {"height", image.height}, {"up", vector_to_json(image.up)}};
}

json light_to_json(const Light& light) {
  if (const auto* sun = std::get_if<SunLight>(&light)) {
    return {{"type", "sun"},
            {"direction", vector_to_json(sun->direction)},
            {"irradiance", vector_to_json(sun->irradiance)},
            {"angular_diameter_deg", sun->angular_diameter_deg}};
  }
  if (const auto* rectangle = std::get_if<RectangleLight>(&light)) {
    return {{"type", "rectangle"},
            {"center", vector_to_json(rectangle->center)},
            {"u", vector_to_json(rectangle->u)},
            {"v", vector_to_json(rectangle->v)},
            {"radiance", vector_to_json(rectangle->radiance)}};
  }
  const auto& sphere = std::get<SphereLight>(light);
  return {{"type", "sphere"},
          {"center", vector_to_json(sphere.center)},
          {"radius", sphere.radius},
          {"radiance", vector_to_json(sphere.radiance)}};
}

json colour_to_json(const IsovalueColour& colour) {
  if (colour.keys.size() == 1) return vector_to_json(colour.keys[0].colour);
  json rows = json::array();
  for (const auto& key : colour.keys) rows.push_back({key.isovalue, key.colour.x, key.colour.y, key.colour.z});
  return {{"by_isovalue", rows}};
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& folder, const std::string& name) {
  const json root = parse_json(text, name);
  const JsonObject object(root, name);
  object.require_keys({"environment", "lights", "albedo", "emission", "outer", "sides"});
  Scene scene;
  if (object.has("environment"))
    scene.environment = read_environment(object.at("environment"), folder, object.place("environment"));
  if (object.has("lights")) {
    const json& lights = object.at("lights");
    if (!lights.is_array()) throw InvalidInput(object.place("lights") + ": an array is wanted");
    for (std::size_t i = 0; i < lights.size(); ++i) {
      scene.lights.push_back(read_light(lights[i], fmt::format("{}[{}]", object.place("lights"), i)));
    }
  }
  if (object.has("albedo")) scene.albedo = read_albedo(object);
  if (object.has("emission")) scene.emission = read_isovalue_colour(object, "emission");
  if (object.has("outer")) {
    const std::string outer = object.text("outer");
    if (outer != "lower" && outer != "higher") {
      throw InvalidInput(fmt::format("{}: '{}'; allowed are lower, higher", object.place("outer"), outer));
    }
    scene.outer = outer == "lower" ? OuterSide::kLower : OuterSide::kHigher;
  }
  if (object.has("sides")) {
    const std::string sides = object.text("sides");
    if (sides != "outer" && sides != "both") {
      throw InvalidInput(fmt::format("{}: '{}'; allowed are outer, both", object.place("sides"), sides));
    }
    scene.sides = sides == "both" ? LitSides::kBoth : LitSides::kOuter;
  }
  return scene;
}

Scene read_scene(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(fmt::format("{}: cannot open the scene: {}", path, std::strerror(errno)));
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw IoError(fmt::format("{}: cannot read the scene: a directory", path));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (file.bad()) throw IoError(fmt::format("{}: cannot read the scene", path));
  if (text.empty()) throw InvalidInput(fmt::format("{}: the scene is empty; {{}} is the default one", path));
  return parse_scene(text, std::filesystem::path(path).parent_path().string(), path);
}

std::string scene_to_json(const Scene& scene) {
  json lights = json::array();
  for (const auto& light : scene.lights) lights.push_back(light_to_json(light));
  json root{{"environment", environment_to_json(scene.environment)},
            {"lights", lights},
            {"albedo", colour_to_json(scene.albedo)},
            {"emission", colour_to_json(scene.emission)},
            {"outer", scene.outer == OuterSide::kLower ? "lower" : "higher"}};
  if (scene.sides == LitSides::kBoth) root["sides"] = "both";
  return root.dump();
}

}  // namespace isolux
