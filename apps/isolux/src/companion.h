#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// The path of a program that is installed beside this one, or built in a folder beside it; "" if there is none.
[[nodiscard]] std::string find_companion(const std::string& name);

/// Replaces this process by the companion. \throw IoError if it is not there or does not start.
[[noreturn]] void run_companion(const std::string& name, const std::vector<std::string>& arguments);

/// What `name argument` prints, if it is there, succeeds and prints JSON.
[[nodiscard]] std::optional<nlohmann::json> companion_json(const std::string& name, const std::string& argument);

}  // namespace isolux
