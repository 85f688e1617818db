#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/raytrace_flat/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace isolux {

struct LinkSettings {
  int rays = 64;  ///< a site
  OuterSide outer = OuterSide::kLower;
};

struct SolveSettings {
  int bounces = kAllBounces;
  GradientKind gradient = GradientKind::kCentralDifferences;  ///< of light sources' shadow rays
  double tolerance = 2e-3;  ///< all bounces: stop when what is left to come is less, rms over the rms of e
  int most_sweeps = 400;    ///< all bounces: stop anyhow (pockets of albedo 1 that shine)
};

struct Solution {
  SampleSet samples;       ///< e at the sites
  int sweeps = 0;          ///< reflections followed
  double change = 0.0;     ///< what was left to come after the last sweep; added by extrapolation
  TraceCounters counters;  ///< shadow rays
};

/// Hemisphere rays of a set of sites, traced once and kept by where they end: light that is reflected any number of
/// times is then found by iterating over the kept ends, e(x) = direct(x) + rho(h) * mean of e(y) over the ends y, with
/// e(y) read from a grid of the last iterate (radiosity's gathering; here a final gather at every texel). Albedo,
/// emission and the environment change without another ray; light sources cost shadow rays. The grid's error enters as
/// a bias. Memory: 6 bytes a ray. Immutable, callable from many threads.
class LightLinks {
 public:
  /// What a sweep reads from: e of the samples on a grid that covers the volume's box, every texel filled; for sites at
  /// texel centres the direct resampler, else any. It must not depend on threads.
  using ToGrid = std::function<IlluminationGrid(const SampleSet& samples)>;

  /// Traces the links. \pre as gather(); the volume must outlive the links. \throw Cancelled, InvalidInput
  LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run);

  [[nodiscard]] const Sites& sites() const { return sites_; }
  [[nodiscard]] const TraceCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t bytes() const { return ends_.size() * sizeof(End); }

  /// e without reflections: environment, light sources, emission of what the rays hit. One channel if is_grey(scene),
  /// else three. Traces shadow rays where the scene has light sources. Variances are those of the rays.
  [[nodiscard]] Solution direct(const Scene& scene, const SolveSettings& settings, const Run& run) const;

  /// e with settings.bounces reflections. \pre scene.outer is that of the links. Cost: a sweep reads each hit's e.
  [[nodiscard]] Solution solve(const Scene& scene, const SolveSettings& settings, const ToGrid& to_grid,
                               const Run& run) const;

 private:
  /// Where a ray ends: the place in the box in parts of 65534, x = kOutside for rays that leave it.
  struct End {
    std::uint16_t x;
    std::uint16_t y;
    std::uint16_t z;
  };
  static constexpr std::uint16_t kOutside = 65535;
  class Reader;
  struct WithoutProbes {};

  LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run, WithoutProbes);
  [[nodiscard]] End end_of(const Vec3f& origin, const Vec3& way) const;
  [[nodiscard]] std::span<const End> ends(std::size_t site) const {
    return {ends_.data() + site * std::size_t(settings_.rays), std::size_t(settings_.rays)};
  }
  /// What each ray of a site brings, reflected light read from `e` (none if null).
  void ray_values(std::size_t site, const Scene& scene, const Reader* e, std::vector<Vec3>& values) const;
  /// e of the sites: light that comes straight from lamps, and what the rays bring.
  void add_up(const Scene& scene, const SampleSet& lamps, const Reader* e, SampleSet& samples, const Run& run) const;
  [[nodiscard]] SampleSet lamp_light(const Scene& scene, const SolveSettings& settings, TraceCounters& counters,
                                     const Run& run) const;
  /// One sweep without the rays' variances: next = straight + albedo * mean of e at the hits. Returns the change.
  double sweep(const Scene& scene, const SampleSet& straight, const Reader& e, SampleSet& samples,
               const Run& run) const;

  const Volume& volume_;
  Sites sites_;
  LinkSettings settings_;
  std::uint64_t seed_;
  TraceCounters counters_;
  std::vector<End> ends_;  ///< settings_.rays a site
  std::vector<std::size_t> probes_;
  std::unique_ptr<const LightLinks> again_;  ///< of the probes, with other random numbers: see the variances of e
};

}  // namespace isolux
