#include "cap_options.h"

#include <fmt/format.h>
#include <isolux/bake/light_metadata.h>

#include "isovalue_option.h"
#include "usage.h"

namespace isolux {

void CapOptions::add_to(CLI::App& command) {
  command.add_flag("--cap", cap,
                   "close the surface where it meets the box; in light, the cap has that of the box's faces");
  command.add_option("--min-component", min_component, "leave out connected parts of fewer triangles")
      ->transform(whole_number(0, std::uint64_t(1) << 32))
      ->type_name("N");
}

ExtractSettings CapOptions::settings(float isovalue, OuterSide outer) const {
  return {.isovalue = isovalue,
          .outer = outer,
          .cap = cap ? CapKind::kBox : CapKind::kNone,
          .min_component = min_component};
}

std::vector<float> isovalues_of_surfaces(const VolumeView& volume, std::span<const ExtractSettings> surfaces,
                                         const Session& session) {
  const ValueRange range = value_range(volume);
  std::vector<float> inside;
  std::vector<float> outside;
  for (const ExtractSettings& surface : surfaces) {
    const float isovalue = surface.isovalue;
    const bool is_full = surface.outer == OuterSide::kLower ? range.low >= isovalue : range.high <= isovalue;
    const bool is_box = surface.cap == CapKind::kBox && is_full;
    (is_box || (isovalue >= range.low && isovalue <= range.high) ? inside : outside).push_back(isovalue);
  }
  if (!outside.empty())
    session.warn(fmt::format("{} outside the values of {} ({} to {}): there is no surface", isovalues_lie(outside),
                             volume.name(), range.low, range.high));
  return inside;
}

Scene scene_of_cap(const LightFile& baked, const TraceOptions& given, const Session& session) {
  if (const auto scene = light_scene(baked)) return *scene;
  if (given.scene_given()) return given.scene();
  session.warn(
      "--cap: the light does not tell its whole scene, so the cap is lit by a white sky; give it with --scene");
  return {};
}

}  // namespace isolux
