#include "registry_json.h"

#include <cmath>

namespace isolux {

nlohmann::json option_to_json(const OptionInfo& option) {
  nlohmann::json json{{"name", option.name},
                      {"type", option.type},
                      {"default", option.default_value},
                      {"allowed", option.allowed()},
                      {"help", option.help}};
  if (!option.unit.empty()) json["unit"] = option.unit;
  if (!option.choices.empty()) json["choices"] = option.choices;
  if (option.type == "int" || option.type == "number") {
    if (std::isfinite(option.min)) json["min"] = option.min;
    if (std::isfinite(option.max)) json["max"] = option.max;
  }
  return json;
}

}  // namespace isolux
