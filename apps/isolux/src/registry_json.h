#pragma once

#include <isolux/core/registry.h>

#include <nlohmann/json.hpp>

namespace isolux {

/// One option of a backend as `isolux backends --json` prints it.
[[nodiscard]] nlohmann::json option_to_json(const OptionInfo& option);

/// A stage with all its backends and their options.
template <class Stage>
[[nodiscard]] nlohmann::json stage_to_json(const Registry<Stage>& registry) {
  nlohmann::json backends = nlohmann::json::array();
  for (const BackendInfo& info : registry.backends()) {
    nlohmann::json backend{{"name", info.name},
                           {"help", info.help},
                           {"available", info.unavailable.empty()},
                           {"default", info.is_default}};
    if (!info.unavailable.empty()) backend["why_unavailable"] = info.unavailable;
    backend["options"] = nlohmann::json::array();
    for (const OptionInfo& option : info.options) backend["options"].push_back(option_to_json(option));
    backends.push_back(backend);
  }
  return {{"stage", Stage::kStage}, {"backends", backends}};
}

}  // namespace isolux
