#include "light_options.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/volume_io/read.h>

#include <string>
#include <vector>

namespace isolux {

void LightOptions::add_to(CLI::App& command, Session& session) {
  const auto files = [this] { return given() ? volume_files(path_) : std::vector<std::string>(); };
  session.reads({.name = "--light", .paths = files});
  command.add_option("--light", path_, "the light that `isolux bake` wrote for this volume")->type_name("LIGHT.nrrd");
  command.add_flag("--force", force_, "use the light of another volume all the same");
}

void warn_outside_light(const LightFile& light, float isovalue, const Session& session) {
  const LightDetail& detail = light.grid.detail;
  if (detail.covers(double(isovalue))) return;
  session.warn(
      fmt::format("isovalue {} lies outside the range {} to {} that the light is of: what is shown is not its light",
                  isovalue, detail.isovalues->low, detail.isovalues->high));
}

void SideOption::add_to(CLI::App& command, const std::string& help) {
  command.add_option("--side", name_, help)->check(CLI::IsMember({"outer", "inner"}));
}

std::optional<LevelSetSide> SideOption::given() const {
  if (name_.empty()) return std::nullopt;
  return name_ == "inner" ? LevelSetSide::kInner : LevelSetSide::kOuter;
}

LightFile LightOptions::read(const Volume& volume, Session& session) const {
  return session.timed("read", [&] {
    LightFile light = read_light(path_);
    if (!force_) require_light_of(light, volume, path_);
    return light;
  });
}

}  // namespace isolux
