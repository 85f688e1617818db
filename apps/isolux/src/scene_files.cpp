#include "scene_files.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

namespace isolux {

std::vector<std::string> scene_files(const std::string& scene) {
  if (scene.empty()) return {};
  std::vector<std::string> files{scene};
  std::error_code error;
  if (!std::filesystem::is_regular_file(scene, error)) return files;  // a pipe is read but once
  std::ifstream text(scene);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const nlohmann::json::json_pointer image("/environment/file");
  if (!json.contains(image) || !json.at(image).is_string()) return files;
  files.push_back((std::filesystem::path(scene).parent_path() / json.at(image).get<std::string>()).string());
  return files;
}

}  // namespace isolux
