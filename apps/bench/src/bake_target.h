#pragma once

#include <isolux/bake/bake.h>

#include <optional>
#include <string>
#include <vector>

#include "stats.h"
#include "suite.h"
#include "truths.h"

namespace isolux::bench {

/// A volume to be lit, and e at points of many of its level sets.
struct Target {
  std::string id;
  std::string title;
  Volume volume;
  Scene scene{};
  int bounces = 0;
  std::optional<ValueRange> isovalues{};
  std::vector<Vec3f> points{};   ///< world
  std::vector<double> e{};       ///< at the points
  double reference_error = 0.0;  ///< standard error of e itself, rms; 0 for closed forms
  float isovalue = 0.0f;         ///< of the one surface that peers light
};

/// A closed form sampled at n^3.
[[nodiscard]] Target analytic_target(const Truth& truth, int n, std::size_t count, const SuiteContext& context);

/// A volume without closed form against the scalar tracer: many rays of another seed, as many as `seconds` allow.
[[nodiscard]] Target traced_target(const std::string& id, Volume volume, float isovalue, int bounces, std::size_t count,
                                   double seconds, const SuiteContext& context);

/// A bake's light at the target's points, read the best way known (LightReader, as `isolux probe` does): rms of its
/// error with the 95 % interval, that of the points drawn.
[[nodiscard]] Estimate error_of(const IlluminationGrid& light, const Target& target, const SuiteContext& context);

struct Measured {
  double seconds = 0.0;  ///< from the volume in memory to its texture
  Estimate error;
};

/// A bake with these settings, its light judged at the target's points.
[[nodiscard]] Measured baked(const Target& target, BakeSettings settings, const SuiteContext& context);

/// Challis 2010: random sites, Shepard's interpolation over the k = 11 nearest in Chebyshev distance with p = .5 by
/// comparing all with all, texels at the grid points.
[[nodiscard]] BakeSettings thesis_settings(std::size_t samples);

/// Wyman, Parker, Shirley & Hansen 2006, "Interactive display of isosurfaces with global illumination": some
/// isosurfaces are extracted and lit at their vertices, and the light is spread over the volume from there.
[[nodiscard]] Measured coupled(const Target& target, int surfaces, int rays, const SuiteContext& context);

/// One isosurface alone, as whoever lights surfaces one by one does it: extraction, Embree's tree, rays at every vertex
/// (no bounces), compared with the level set's own light at some vertices.
struct OneSurface {
  std::size_t vertices = 0;
  Measured measured;
};
/// Empty where Embree is not in this build or the surface is. \pre target.bounces == 0 and uniform light of radiance 1
[[nodiscard]] std::optional<OneSurface> one_surface(const Target& target, int rays, const SuiteContext& context);

}  // namespace isolux::bench
