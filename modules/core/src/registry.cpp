#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/registry.h>

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

void require_new_backend(std::string_view stage, std::string_view name, std::span<const BackendInfo> infos) {
  if (name.empty()) throw InvalidInput(fmt::format("a {} needs a name; '' is the default's", stage));
  for (const auto& info : infos) {
    if (info.name == name) throw InvalidInput(fmt::format("there already is a {} called '{}'", stage, name));
  }
}

}  // namespace isolux::detail
