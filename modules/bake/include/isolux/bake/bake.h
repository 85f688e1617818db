#pragma once

#include <isolux/bake/stages.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// A stage's backend by name ("" for the default) and its options.
struct BackendChoice {
  std::string name;
  Settings settings;
};

/// Where the texels of the illumination grid sit.
enum class TexelLattice {
  kCells,  ///< spread evenly over the box; one a cell by default
  kVoxels  ///< at the grid points, as in Challis 2010
};

/// How reflected light is found.
enum class BounceMethod {
  kDefault,   ///< kIterated for the resamplers direct and fit unless a tracer is named or scattered
              ///< sites are drawn by need, else kPaths; where an error alone is asked kIteratedOrPaths for kIterated
  kIterated,  ///< rays are traced once and their hits kept; light is read there from the last iterate of the grid
              ///< (LightLinks; of scattered sites: their means around the texels): several times cheaper, with the
              ///< grid's own error as a small bias; does not use the tracer
  kPaths,     ///< the tracer follows every path to its end: unbiased
  kIteratedOrPaths  ///< kIterated, unless target_rmse is asked and reading reflections from texels alone is nearly as
                    ///< wrong (BakeResult::reading_error): kPaths then, if iteration took at most 20 million rays
                    ///< (paths take some twenty times as many); BakeResult::skipped tells
};

/// Which sites are traced.
enum class TexelSites {
  kAll,    ///< every one
  kNeeded  ///< at the texels: few, the others being predicted from them, until target_rmse is reached (docs/need.md);
           ///< not with a time, light sources, an image as environment, paths, other tracers than wide, other
           ///< resamplers than direct. Scattered: as many as otherwise, half of them where the others say that light
           ///< changes; not with an error or a time
};

struct BakeSettings {
  BackendChoice sampler;
  BackendChoice tracer;
  BackendChoice resampler;
  TraceSettings trace;
  BounceMethod bounce_method = BounceMethod::kDefault;
  TexelSites texel_sites = TexelSites::kAll;
  TexelLattice lattice = TexelLattice::kCells;
  std::optional<Index3> texels;  ///< of kCells only; default texels_a_cell
  double texels_a_cell = 0.0;    ///< on each axis, of kCells; 0: what suits the resampler
  std::size_t samples = 0;       ///< sites of scattering samplers; 0: sites_a_cell
  double sites_a_cell = 0.0;     ///< of the cells that can be lit; 0: what suits the resampler, one a texel mostly
  std::optional<ValueRange> isovalues;  ///< light only these level sets
  /// Rays until BakeResult::rmse_estimate is so small, or until so many seconds have passed since the bake began; 0 for
  /// none. They replace trace.rays. Iterated bounces, and no bounces under a uniform environment or a sky, without
  /// light sources, spend each ray where it takes away most error; others choose one number of rays for all sites from
  /// a small bake. With a time the result depends on the machine's speed; four rays of each site are traced, however
  /// long that takes (BakeResult::seconds_beyond_time).
  double target_rmse = 0.0;
  double target_seconds = 0.0;
  bool wants_error_grid = false;  ///< fill BakeResult::error
  /// What kept rays may take. Of more, reflections are iterated over as many of each site as fit and the others traced
  /// once, for the last reflection; fewer than four follow paths. No rounds of target_rmse go beyond
  /// (BakeResult::skipped).
  std::uint64_t most_link_bytes = std::uint64_t(4) << 30;
  /// Sites at texels whose light alone is wanted, by paths, are found and lit in so many parts of the isovalues, one
  /// after the other, so that they need not be held all at once; 0: as many as the sites are worth, some 64 at most.
  int isovalue_parts = 0;
};

/// What lighting one side took, where both were lit.
struct SideFigures {
  std::size_t sites = 0;
  std::uint64_t rays = 0;
  double rmse_estimate = 0.0;
};

/// Of a bake of both sides counts, seconds and the estimated error are those of both together.
struct BakeResult {
  IlluminationGrid light;                       ///< of the outer side
  std::optional<IlluminationGrid> error;        ///< estimated standard error of e at the texels, one channel
  std::optional<IlluminationGrid> inner_light;  ///< of the inner side, if Scene::sides asks for it
  std::optional<IlluminationGrid> inner_error;
  BakeSettings settings;           ///< with_defaults(), bounce_method being what was done
  std::vector<SideFigures> sides;  ///< the outer and the inner one; empty if one side was lit
  TraceCounters counters;
  std::size_t sites = 0;
  int sweeps = 0;                ///< of BounceMethod::kIterated
  std::size_t unlit_texels = 0;  ///< filled from their lit neighbours
  /// Root mean squared error of e at the texels: where they are the sites, noise and reading_error together; else, and
  /// with TexelSites::kNeeded, that of texels which are lit by paths besides; NaN if one ray a site says nothing of it.
  /// What reading between texels adds is not in it (TexelChoice::error is an estimate of that).
  double rmse_estimate = 0.0;
  double noise = 0.0;  ///< standard error of the sites' rays, rms; 0 with TexelSites::kNeeded
  /// What reading reflections from texels adds to that, or may add unseen (kIterated; rms): it is measured by paths at
  /// some sites, and at least half of what these may miss. No ray takes it away, more texels or kPaths do.
  double reading_error = 0.0;
  std::uint32_t least_rays = 0;  ///< a site
  std::uint32_t most_rays = 0;
  std::size_t link_bytes = 0;  ///< memory of kept rays
  /// What was known without tracing, by reason, of sites at texels: sites_flat (no gradient, hence no normal),
  /// sites_outside_iso_range, texels_predicted. And links_beyond_memory, rays that were not kept
  /// (BakeSettings::most_link_bytes); rounds_beyond_memory, 1 where target_rmse was not reached for that;
  /// reading_beyond_error, 1 where reflections were followed by paths to reach it (kIteratedOrPaths);
  /// error_beyond_rays, 1 where what more rays could take away is too little to reach it;
  /// sweeps_beyond_limit, 1 where iterated reflections had not settled when they ended; places_unjudged, of the places
  /// that an error is judged by, those in pockets whose light nobody knows, so that what is wrong there is not in
  /// rmse_estimate; paths_cut, paths that were cut off (TraceCounters::cut), so that the light misses what they would
  /// have met.
  std::map<std::string, std::uint64_t> skipped;
  double seconds_beyond_time = 0.0;       ///< beyond target_seconds, where it was exceeded by more than a quarter
  std::map<std::string, double> seconds;  ///< by stage: sites, trace, bounces (of kIterated), resample
};

/// `settings` with every backend and the bounce method named: sites at the texels and the direct resampler; for the
/// least-squares fit stratified sites, or with known isovalues sites on their level sets; where a number of samples or
/// another sampler is asked for, low-discrepancy sites and Shepard's interpolation over a cell grid; the default
/// tracer.
[[nodiscard]] BakeSettings with_backends(BakeSettings settings, const Stages& stages);
/// The same, and filled in what they want of a volume (docs/resampling.md): texels a cell, by settings.texels where
/// these are given, else for the fit .73 an axis, .97 for one isovalue and .8 for a range; sites a cell; and what the
/// fit tells of a texel.
[[nodiscard]] BakeSettings with_defaults(BakeSettings settings, const Lattice& volume, const Stages& stages);
/// Whether reflections are iterated, if reading them allows it.
[[nodiscard]] inline bool iterates(const BakeSettings& settings) {
  return settings.bounce_method == BounceMethod::kIterated || settings.bounce_method == BounceMethod::kIteratedOrPaths;
}

/// Lights all level sets of a volume at once, with_defaults(). The same bits for any number of threads. Where
/// scene.sides is kBoth, each side's light is bit by bit that of a bake of scene_of_side(); a time is shared,
/// sites are found once but where they come in parts. \throw InvalidInput if the volume is not usable, is constant, no
/// site is found, or a backend or option is unknown; Cancelled.
[[nodiscard]] BakeResult bake(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                              const Stages& stages, const Run& run);

/// The texel lattice that bake() uses for these settings. \throw InvalidInput
[[nodiscard]] Lattice texel_lattice(const Lattice& volume, const BakeSettings& settings);

}  // namespace isolux
