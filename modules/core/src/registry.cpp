#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/registry.h>

#include <algorithm>
#include <set>

namespace isolux::detail {
namespace {

[[noreturn]] void refuse(std::string_view stage, std::string_view name, const std::vector<std::string>& there_are) {
  const std::string near = nearest_word(name, there_are);
  const std::string what = name.empty() ? "has a default" : fmt::format("is called '{}'", name);
  if (there_are.empty()) throw InvalidInput(fmt::format("no {} {}; there are none at all", stage, what));
  throw InvalidInput(fmt::format("no {} {}{}; there are {}", stage, what,
                                 near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                 fmt::join(there_are, ", ")));
}

constexpr std::string_view kPlainNames = "names are of letters, digits, _ and -";

bool is_plain(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

std::size_t find_backend(std::string_view stage, std::string_view name, std::span<const BackendInfo> infos) {
  std::vector<std::string> available;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const BackendInfo& info = infos[i];
    const bool wanted = name.empty() ? info.is_default : info.name == name;
    if (wanted && info.unavailable.empty()) return i;
    if (wanted) throw InvalidInput(fmt::format("{} '{}' is not in this build: {}", stage, info.name, info.unavailable));
    if (info.unavailable.empty()) available.push_back(info.name);
  }
  refuse(stage, name, available);
}

std::size_t find_listed(std::string_view stage, std::string_view name, std::span<const BackendInfo> infos) {
  std::vector<std::string> listed;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].name == name) return i;
    listed.push_back(infos[i].name);
  }
  refuse(stage, name, listed);
}

void require_new_backend(std::string_view stage, const BackendInfo& info, std::span<const BackendInfo> infos) {
  if (info.name.empty()) throw InvalidInput(fmt::format("a {} needs a name; '' is the default's", stage));
  if (!is_plain(info.name)) throw InvalidInput(fmt::format("a {} called '{}': {}", stage, info.name, kPlainNames));
  for (const auto& other : infos) {
    if (other.name == info.name) throw InvalidInput(fmt::format("there already is a {} called '{}'", stage, info.name));
  }
  std::set<std::string_view> options;
  for (const auto& option : info.options) {
    if (!is_plain(option.name))
      throw InvalidInput(fmt::format("{} {}: an option called '{}': {}", stage, info.name, option.name, kPlainNames));
    if (!options.insert(option.name).second)
      throw InvalidInput(fmt::format("{} {}: two options called '{}'", stage, info.name, option.name));
  }
}

}  // namespace isolux::detail
