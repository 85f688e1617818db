#include "json_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace isolux {

JsonObject::JsonObject(const nlohmann::json& json, std::string place) : json_(json), place_(std::move(place)) {
  if (!json_.is_object())
    throw InvalidInput(fmt::format("{}: '{}' where an object {{...}} is wanted", place_, json_.dump()));
}

void JsonObject::require_keys(std::initializer_list<const char*> known) const {
  const std::vector<std::string> names(known.begin(), known.end());
  for (const auto& [key, value] : json_.items()) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    const std::string near = nearest_word(key, names);
    throw InvalidInput(fmt::format("{}: unknown key '{}'{}; known are {}", place_, key,
                                   near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                   fmt::join(names, ", ")));
  }
}

const nlohmann::json& JsonObject::at(const char* key) const {
  const auto it = json_.find(key);
  if (it == json_.end()) throw InvalidInput(fmt::format("{}: the key '{}' is missing", place_, key));
  return *it;
}

std::string JsonObject::text(const char* key) const {
  const nlohmann::json& value = at(key);
  if (!value.is_string()) throw InvalidInput(fmt::format("{}: '{}' where a text is wanted", place(key), value.dump()));
  return value.get<std::string>();
}

Vec3f JsonObject::vector(const char* key) const {
  const auto numbers = json_numbers(at(key), 3, place(key));
  return {numbers[0], numbers[1], numbers[2]};
}

Vec3 JsonObject::position(const char* key) const {
  const auto numbers = json_doubles(at(key), 3, place(key));
  return {numbers[0], numbers[1], numbers[2]};
}

Vec3f JsonObject::colour(const char* key) const {
  const Vec3f c = vector(key);
  if (c.x < 0.0f || c.y < 0.0f || c.z < 0.0f) {
    throw InvalidInput(fmt::format("{}: {}; numbers of at least 0 are wanted", place(key), at(key).dump()));
  }
  return c;
}

Vec3f JsonObject::direction(const char* key) const {
  const Vec3f d = vector(key);
  if (d == Vec3f(0.0f)) throw InvalidInput(fmt::format("{}: {} is no direction", place(key), at(key).dump()));
  return d;
}

float JsonObject::positive(const char* key) const {
  const nlohmann::json& value = at(key);
  const float number = value.is_number() ? value.get<float>() : -1.0f;
  if (!(number > 0.0f) || !std::isfinite(number)) {
    throw InvalidInput(fmt::format("{}: '{}' where a number above 0, at most {:.2g}, is wanted", place(key),
                                   value.dump(), double(std::numeric_limits<float>::max())));
  }
  return number;
}

nlohmann::json parse_json(const std::string& text, const std::string& name) {
  using nlohmann::json;
  constexpr int kDeepest = 64;  // a scene has 4; the library writes each level out on the stack, for messages too
  std::vector<std::set<std::string>> objects;
  const auto look = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > kDeepest)
      throw InvalidInput(
          fmt::format("{}: objects and arrays within each other: at most {} are allowed", name, kDeepest));
    if (event == json::parse_event_t::object_start) objects.emplace_back();
    if (event == json::parse_event_t::object_end) objects.pop_back();
    if (event == json::parse_event_t::key && !objects.back().insert(parsed.get<std::string>()).second)
      throw InvalidInput(fmt::format("{}: the key {} is given twice", name, parsed.dump()));
    return true;
  };
  try {
    return json::parse(text, look);
  } catch (const json::parse_error& error) {
    throw InvalidInput(fmt::format("{}: not JSON at byte {}", name, error.byte));
  } catch (const json::out_of_range&) {
    throw InvalidInput(fmt::format("{}: a number is too large: at most {:.2g} is allowed", name,
                                   double(std::numeric_limits<float>::max())));
  }
}

std::vector<double> json_doubles(const nlohmann::json& json, std::size_t count, const std::string& place) {
  const auto refuse = [&] {
    return InvalidInput(fmt::format("{}: '{}' where an array of {} numbers within +-{:.2g} is wanted", place,
                                    json.dump(), count, double(std::numeric_limits<float>::max())));
  };
  if (!json.is_array() || json.size() != count) throw refuse();
  std::vector<double> numbers;
  for (const auto& element : json) {
    if (!element.is_number() || !std::isfinite(element.get<float>())) throw refuse();
    numbers.push_back(element.get<double>());
  }
  return numbers;
}

std::vector<float> json_numbers(const nlohmann::json& json, std::size_t count, const std::string& place) {
  const auto numbers = json_doubles(json, count, place);
  return {numbers.begin(), numbers.end()};
}

}  // namespace isolux
