#include "baked_light.h"

#include <isolux/bake/light_metadata.h>

#include <cmath>
#include <utility>

namespace isolux {

BakedLight::BakedLight(const Volume& volume, const LightFile& light, const RenderOptions& options, OuterSide outer,
                       Session& session)
    : light_(light),
      exposure_(float(std::exp2(options.exposure.value_or(0.0)))),
      one_side_(options.side.given().has_value()) {
  const auto of_side = [&](LevelSetSide side) {
    return session.timed("light", [&] {
      return std::make_shared<const LightReader>(volume, options.light.of_side(light, side), TexelStorage::kBricks,
                                                 session.run);
    });
  };
  if (one_side_) {
    const OuterSide shown = options.side.or_outer() == LevelSetSide::kInner ? opposite(outer) : outer;
    outer_ = inner_ = of_side(side_towards(light, shown));
  } else if (!light.inner) {
    outer_ = of_side(side_towards(light, outer));
  } else {
    outer_ = of_side(LevelSetSide::kOuter);
    inner_ = of_side(LevelSetSide::kInner);
    if (outer != light_outer(light)) std::swap(outer_, inner_);
  }
  if (!options.parts.cap) return;
  const Scene scene = scene_of_cap(light, options.trace, session);
  cap_ = session.timed("trace", [&] {
    return std::make_shared<const BoxLight>(volume.lattice(), scene, options.trace.settings(), BackendChoice{},
                                            session.stages, session.run);
  });
  session.report["rays"] = cap_->counters().rays;
}

Shader BakedLight::shader(float isovalue) const {
  const auto light_at = [isovalue](const std::shared_ptr<const LightReader>& reader) -> LightAt {
    return [reader, isovalue](const SurfacePoint& point) { return reader->at_index(point.index, double(isovalue)); };
  };
  const SurfaceColour colour = surface_colour(light_, isovalue);
  const Shader surface =
      inner_ ? global_shader(light_at(outer_), light_at(inner_), colour) : global_shader(light_at(outer_), colour);
  return [surface, cap = cap_, colour, one_side = one_side_, exposure = exposure_](const SurfacePoint& point) {
    // From within the box a cap has no light, but where what is called inside is all that is shown.
    const bool is_lit_cap = point.cap && (point.outside || one_side);
    return exposure * (is_lit_cap ? colour.shown(cap->at(*point.cap, point.index)) : surface(point));
  };
}

}  // namespace isolux
