#pragma once

#include <isolux/bake/find_sites.h>
#include <isolux/core/stopwatch.h>
#include <isolux/raytrace_flat/light_links.h>
#include <isolux/resample/texel_means.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace isolux {

class ReadingError;
class TexelPlaces;
struct TexelRounds;

/// A bake whose rays are kept: what bake() uses for BounceMethod::kIterated, and a way to light the same volume again
/// after albedo, emission or environment changed, without tracing it again. Not for use from several threads at once.
class KeptRays {
 public:
  /// Traces settings.trace.rays a site, or a first few where settings name an error or a time. Of the scene only the
  /// outer side counts, and whether its albedo is near 1: pockets are then told apart for all scenes to come
  /// (LinkSettings::parts_pockets). \pre the volume outlives this \throw as bake(); InvalidInput for scenes of both
  /// sides, and where settings.most_link_bytes do not hold four rays of each site
  KeptRays(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Stages& stages,
           const Run& run);
  /// The same from sites that are found. \pre with_defaults(settings)
  KeptRays(const Volume& volume, const Scene& scene, const BakeSettings& settings, FoundSites found,
           const Stages& stages, const Run& run);
  KeptRays(Volume&& volume, const Scene& scene, const BakeSettings& settings, const Stages& stages,
           const Run& run) = delete;
  KeptRays(Volume&& volume, const Scene& scene, const BakeSettings& settings, FoundSites found, const Stages& stages,
           const Run& run) = delete;
  KeptRays(const KeptRays&) = delete;
  KeptRays& operator=(const KeptRays&) = delete;
  ~KeptRays();

  /// The light of a scene. Rays are traced only for light sources, and where settings.target_rmse or
  /// settings.target_seconds (counted from when sites were found) want more of them than there are. A second call
  /// starts from the first one's light. BakeResult::counters are those of all rays so far. \throw as bake();
  /// InvalidInput if the scene's outer side is another one
  [[nodiscard]] BakeResult light(const Scene& scene, const Run& run);
  /// The same, where no other light is wanted: what is kept is let go before the texels are made. Some sites are
  /// traced by paths besides, so that the error is known with what reading reflections from texels adds to it
  /// (BakeResult::reading_error); light() leaves that at 0.
  [[nodiscard]] BakeResult last_light(const Scene& scene, const Run& run) &&;

  /// 0 once they are gone.
  [[nodiscard]] std::uint64_t rays() const { return links_ != nullptr ? links_->counters().rays : 0; }
  [[nodiscard]] std::size_t bytes() const { return links_ != nullptr ? links_->bytes() : 0; }

 private:
  /// e at the links' sites, without these, and what finding it took.
  [[nodiscard]] SampleSet trace_and_solve(const Scene& scene, const Run& run, BakeResult& result);
  [[nodiscard]] Solution solve(const Scene& scene, const Run& run, BakeResult& result);
  /// Whether the sites' places need not be held while light is found.
  [[nodiscard]] bool can_do_without_places(const Scene& scene) const;
  /// The light of a scene for which they are let go: `places` says where they were.
  [[nodiscard]] BakeResult light_without_places(const Scene& scene, const TexelPlaces& places, const Run& run);
  /// \throw InvalidInput if rays are gone
  void require_kept() const;
  /// Lets go what is kept.
  void finish_links();
  /// The light that reflections read.
  [[nodiscard]] IlluminationGrid between_reflections(const SampleSet& samples, const Run& run);
  /// Whether all sites have the rays from which errors are believed.
  [[nodiscard]] bool has_begun() const;
  /// The squared noise of the sites from which on more rays are not worth it towards settings.target_rmse; 0 without.
  /// Where texels are made of several sites it makes them in `result` and judges them.
  [[nodiscard]] double noise_worth_rays(SampleSet& samples, const Run& run, BakeResult& result);
  /// The sites that should get more rays; none if it is enough.
  [[nodiscard]] std::vector<std::uint32_t> wanting(const SampleSet& samples, double noise, double solve_seconds) const;
  /// By which places and paths are chosen. In a time they are what it has room for.
  [[nodiscard]] BakeSettings settings_to_judge() const;
  /// BakeResult::reading_error, as far as it is judged.
  [[nodiscard]] double reading_error(const SampleSet& samples) const;

  const Volume& volume_;
  Stopwatch since_;
  BakeSettings settings_;
  Lattice texels_;
  Lattice reflecting_;  ///< the texels that reflections are read from
  std::unique_ptr<const Resampler> resampler_;
  BakeResult begun_;  ///< what the construction found
  std::unique_ptr<LightLinks> links_;
  std::optional<TexelMeans> means_;  ///< what scattered sites' light is read from between reflections, once it is
  std::size_t one_of_ = 1;           ///< SolveSettings
  std::size_t ends_one_of_ = 1;      ///< SolveSettings
  double trace_seconds_ = 0.0;
  double judge_seconds_ = 0.0;
  std::vector<float> last_;  ///< e of the last solution
  std::unique_ptr<const ReadingError> judge_;
  std::unique_ptr<TexelRounds> texel_rounds_;  ///< where texels are made of several sites, towards an error
};

}  // namespace isolux
