#pragma once

#include <isolux/core/vec.h>

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace isolux {

/// A JSON object read strictly: every message names the place ("scene.json: lights[1].radius"), and keys that nobody
/// asked for are errors. Values are read through it once.
class JsonObject {
 public:
  /// \throw InvalidInput if `json` is not an object.
  JsonObject(const nlohmann::json& json, std::string place);

  /// \throw InvalidInput naming the first key that is not one of `known`, and the nearest that is.
  void require_keys(std::initializer_list<const char*> known) const;
  [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }
  /// \throw InvalidInput if the key is missing
  [[nodiscard]] const nlohmann::json& at(const char* key) const;
  [[nodiscard]] std::string text(const char* key) const;
  /// Three finite numbers. \throw InvalidInput
  [[nodiscard]] Vec3f vector(const char* key) const;
  /// The same with all of their digits: a place in the world.
  [[nodiscard]] Vec3 position(const char* key) const;
  [[nodiscard]] Vec3f vector_or(const char* key, const Vec3f& otherwise) const {
    return has(key) ? vector(key) : otherwise;
  }
  /// Three finite numbers of at least 0. \throw InvalidInput
  [[nodiscard]] Vec3f colour(const char* key) const;
  [[nodiscard]] Vec3f colour_or(const char* key, const Vec3f& otherwise) const {
    return has(key) ? colour(key) : otherwise;
  }
  /// A direction: three finite numbers, not all zero. \throw InvalidInput
  [[nodiscard]] Vec3f direction(const char* key) const;
  [[nodiscard]] Vec3f direction_or(const char* key, const Vec3f& otherwise) const {
    return has(key) ? direction(key) : otherwise;
  }
  /// A finite number above 0. \throw InvalidInput
  [[nodiscard]] float positive(const char* key) const;
  [[nodiscard]] std::string place(const char* key) const { return place_ + "." + key; }
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  const nlohmann::json& json_;
  std::string place_;
};

/// A text as JSON. \throw InvalidInput naming `name` for what is none, a number beyond doubles, a key given twice, of
/// which the library would take the last, or more than 64 objects and arrays within each other
[[nodiscard]] nlohmann::json parse_json(const std::string& text, const std::string& name);

/// The numbers of an array of `count`, each within a float's range. \throw InvalidInput naming `place`
[[nodiscard]] std::vector<double> json_doubles(const nlohmann::json& json, std::size_t count, const std::string& place);
/// The same, rounded to floats.
[[nodiscard]] std::vector<float> json_numbers(const nlohmann::json& json, std::size_t count, const std::string& place);

}  // namespace isolux
