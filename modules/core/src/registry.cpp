#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/core/registry.h>

namespace isolux::detail {

std::size_t find_backend(std::string_view stage, std::string_view name, std::span<const BackendInfo> infos) {
  std::vector<std::string> available;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const BackendInfo& info = infos[i];
    const bool wanted = name.empty() ? info.is_default : info.name == name;
    if (wanted && info.unavailable.empty()) return i;
    if (wanted) throw InvalidInput(fmt::format("{} '{}' is not in this build: {}", stage, info.name, info.unavailable));
    if (info.unavailable.empty()) available.push_back(info.name);
  }
  const std::string near = nearest_word(name, available);
  throw InvalidInput(fmt::format("no {} is called '{}'{}; there are {}", stage, name,
                                 near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                 fmt::join(available, ", ")));
}

void require_new_backend(std::string_view stage, std::string_view name, std::span<const BackendInfo> infos) {
  for (const auto& info : infos) {
    if (info.name == name) throw InvalidInput(fmt::format("there already is a {} called '{}'", stage, name));
  }
}

}  // namespace isolux::detail
