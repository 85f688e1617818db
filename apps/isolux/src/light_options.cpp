#include "light_options.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/volume_io/read.h>

#include <string>
#include <vector>

#include "isovalue_option.h"

namespace isolux {

void LightOptions::add_to(CLI::App& command, Session& session) {
  const auto files = [this] { return given() ? volume_files(path_) : std::vector<std::string>(); };
  session.reads({.name = "--light", .paths = files});
  command.add_option("--light", path_, "the light that `isolux bake` wrote for this volume")->type_name("LIGHT.nrrd");
  command.add_flag("--force", force_, "use the light of another volume all the same");
}

void LightOptions::warn_of_no_effect(const Session& session) const {
  if (force_ && !given()) session.warn("--force has no effect without --light");
}

void warn_outside_light(const LightFile& light, std::span<const float> isovalues, const Session& session,
                        const std::string& what) {
  const LightDetail& detail = light.grid.detail;
  std::vector<float> outside;
  for (const float isovalue : isovalues)
    if (!detail.covers(double(isovalue))) outside.push_back(isovalue);
  if (outside.empty()) return;
  session.warn(fmt::format("{} outside the range {} to {} that the light is of: {}", isovalues_lie(outside),
                           detail.isovalues->low, detail.isovalues->high, what));
}

void SideOption::add_to(CLI::App& command, const std::string& help) {
  command.add_option("--side", name_, help)->check(CLI::IsMember({"outer", "inner"}));
}

std::optional<LevelSetSide> SideOption::given() const {
  if (name_.empty()) return std::nullopt;
  return name_ == "inner" ? LevelSetSide::kInner : LevelSetSide::kOuter;
}

std::string name_of(OuterSide outer) { return outer == OuterSide::kHigher ? "higher" : "lower"; }

void OuterOption::add_to(CLI::App& command, const std::string& help) {
  command.add_option("--outer", name_, help)->check(CLI::IsMember({"lower", "higher"}));
}

OuterSide OuterOption::or_else(OuterSide by_default) const {
  if (name_.empty()) return by_default;
  return name_ == name_of(OuterSide::kHigher) ? OuterSide::kHigher : OuterSide::kLower;
}

LightFile LightOptions::read(const Volume& volume, Session& session) const {
  return session.timed("read", [&] {
    LightFile light = read_light(path_);
    if (!force_) require_light_of(light, volume, path_);
    return light;
  });
}

}  // namespace isolux
