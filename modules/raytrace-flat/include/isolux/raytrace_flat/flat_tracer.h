#pragma once

#include <isolux/core/registry.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/scene.h>
#include <isolux/raytrace_flat/trace_counters.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace isolux {

/// Bounces until nothing is left.
inline constexpr int kAllBounces = -1;

/// How the nets of neighbouring sites' rays belong together.
enum class RayNets : std::uint8_t {
  kIndependent,  ///< each site's is its own, and can go on (first_ray)
  kInterleaved   ///< those of sites close together are one net: less noise in means over neighbours, the same in each
};

struct TraceSettings {
  int rays = 64;              ///< a site: directions over the hemisphere
  int bounces = kAllBounces;  ///< reflections; 0: a hit is black unless it emits
  GradientKind gradient = GradientKind::kCentralDifferences;
  RayNets nets = RayNets::kIndependent;  ///< of the first rays; `scalar` keeps them independent
  std::optional<ValueRange> values{};    ///< of the volume, where known: saves `wide` a pass
  LampLight lamps = LampLight::kWithin;  ///< told apart, the whole is the same to the bit; `scalar` leaves it within
  /// Without reflections, of 16 rays and more of interleaved nets, of those under the sky and to suns. Other lamps get
  /// theirs of each site; `scalar` spreads evenly.
  RaySpread spread = RaySpread::kEven;
};

struct TraceResult {
  SampleSet samples;
  std::vector<std::uint32_t>
      rays{};  ///< of each site under the sky, where their numbers differ; empty: TraceSettings::rays
  /// Of each site, how many paths were cut off (TraceCounters::cut), as in pockets of albedos near 1 that nothing or
  /// hardly anything leads out of; empty: none, or the tracer (`scalar`) does not tell whose.
  std::vector<std::uint32_t> cut{};
  TraceCounters counters;
};

/// The raytrace-flat stage: e = irradiance/pi at sites, every ray confined to the level set of its site. Backends are
/// immutable and callable from many threads.
class FlatTracer {
 public:
  static constexpr std::string_view kStage = "tracer";
  virtual ~FlatTracer() = default;

  /// Lights the sites: one channel if is_grey(scene), else three. Random numbers are keyed by run.seed and the site's
  /// index: the same bits for any number of threads. \pre require_usable(volume); sites inside its box. \throw
  /// Cancelled; InvalidInput
  [[nodiscard]] virtual TraceResult trace(const Volume& volume, const Scene& scene, Sites sites,
                                          const TraceSettings& settings, const Run& run) const = 0;
};

/// scalar, ...
[[nodiscard]] Registry<FlatTracer> tracers();

}  // namespace isolux
