#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace isolux {

struct LinkAim;
struct RayCounts;
struct RoundRequest;
struct TargetLight;
class SceneParts;

/// What is kept of each ray.
enum class LinkEnds : std::uint8_t {
  kKept,      ///< where it ends: any number of bounces
  kAtTexels,  ///< the texel at its end, whoever the sites are: any number of bounces, and more sites by append()
  kDropped    ///< only whether it escaped: no bounces; quicker, a bit a ray
};

struct LinkSettings {
  int rays = 64;  ///< a site, at first
  /// Of these, how many are kept, a power of two: reflections are iterated over them; the others are traced anew for
  /// the last reflection of each solution, and forgotten. 0: all, and only then more rays or sites can be had.
  int kept = 0;
  OuterSide outer = OuterSide::kLower;
  LinkEnds ends = LinkEnds::kKept;
  std::optional<Lattice> texels{};  ///< the grid that reflected light is read from; default one texel a cell
  /// Of rays kept with sites at the texels: what ends on a level set from whose outer side nothing leads out of the box
  /// reads sites on such level sets alone, and everything else none of them. Right for albedos near 1, with which a way
  /// out, however narrow, lights all that it leads to; with others light fades towards it and is better read from both.
  bool parts_pockets = false;
  RayNets nets = RayNets::kIndependent;  ///< interleaved, there are neither more rays nor more sites later
};

struct SolveSettings {
  int bounces = kAllBounces;                                  ///< of a number, no more are found than change anything
  GradientKind gradient = GradientKind::kCentralDifferences;  ///< of light sources' shadow rays
  double tolerance = 2e-3;  ///< all bounces: stop when what is left to come is less, rms over the rms of e
  int most_sweeps = 400;    ///< all bounces: stop anyhow (pockets of albedo 1 that shine)
  /// All bounces, of sites that do not sit at the texels: iterate over one of so many sites; all of them make the last
  /// reflection. Where many share a texel, some say as much of it.
  std::size_t one_of = 1;
  /// All bounces: iterate over one of so many ends of each site, in turn along its net's strata; the last reflection
  /// reads all. The noise that this leaves is that of the mean over the ends of what they reflect.
  std::size_t ends_one_of = 1;
  LampLight lamps = LampLight::kWithin;  ///< of the solution's samples
};

struct Solution {
  SampleSet samples;           ///< e at LightLinks::sites(), which are not repeated here
  int sweeps = 0;              ///< over the links
  double change = 0.0;         ///< what was left to come after the last sweep, estimated; rms over the rms of e
  TraceCounters counters;      ///< shadow rays, and rays that are not kept
  double trace_seconds = 0.0;  ///< for the latter
};

/// Hemisphere rays of a set of sites, traced once and kept by where they end: light that is reflected any number of
/// times is then found by iterating over the kept ends, e(x) = direct(x) + rho(h) * mean of e(y) over the ends y, with
/// e(y) read from the last iterate (radiosity's gathering; here a final gather at every texel). Each ray reads ONE of
/// the texels around its end, drawn once by its trilinear weight and, where targets have no slopes, by how near its
/// isovalue is to the ray's: a sweep is a product with a sparse matrix. Albedo, emission and the environment change
/// without another ray; light sources cost shadow rays. The grid's error enters as a bias. Memory: 4 bytes a ray that
/// hits, a bit a ray and 16 bytes a site; while bounces are found seven floats a site and channel. Queries may be
/// called from many threads.
class LightLinks {
 public:
  /// What a sweep reads from if the sites do not sit at the texels, or their links' ends are kAtTexels: e of the
  /// samples on LinkSettings::texels, every texel filled; slopes of its detail are read too, along each ray's own level
  /// set. It must not depend on threads. Samples are those of all sites or, where SolveSettings::one_of asks for some,
  /// always the same some of them. Otherwise sites at texels are read as they are and an unlit texel as the nearest lit
  /// one; this is not called then and may be empty.
  using ToGrid = std::function<IlluminationGrid(const SampleSet& samples)>;

  /// Traces the links. \pre as gather(); the volume must outlive the links. \throw Cancelled, InvalidInput
  LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run);
  LightLinks(Volume&& volume, Sites sites, const LinkSettings& settings, const Run& run) = delete;
  LightLinks(const LightLinks&) = delete;
  LightLinks& operator=(const LightLinks&) = delete;
  ~LightLinks();

  /// Doubles the rays of the sites listed, each once: their sequences go on where they ended. `run` brings threads and
  /// progress; the seed stays. Not at the same time as any other call. \throw InvalidInput where nets are interleaved
  /// or a part of the rays is kept, or a number is no site's or comes twice; Cancelled. Whatever is thrown, the links
  /// are as they were.
  void extend(std::span<const std::uint32_t> sites, const Run& run);

  /// More sites, behind those that are there, with settings.rays each. Not at the same time as any other call. \throw
  /// InvalidInput where ends are kKept, as these know the sites at the texels, or nets are interleaved; Cancelled.
  /// Whatever is thrown, the links are as they were.
  void append(const Sites& more, const Run& run);

  /// Without positions and normals once these were let go.
  [[nodiscard]] const Sites& sites() const { return sites_; }
  /// The sites, to be given back before any other call but the destructor.
  [[nodiscard]] Sites take_sites() { return std::move(sites_); }
  void give_back(Sites sites) { sites_ = std::move(sites); }
  /// Whether light can be found without the sites' positions and normals: they sit at the texels, have normals, and all
  /// their rays are kept, of interleaved nets.
  [[nodiscard]] bool can_let_places_go() const;
  /// Lets these go, 24 bytes a site. The scenes to come must need neither: their environment is uniform and they have
  /// no light sources, or solve() throws InvalidInput. \pre can_let_places_go()
  void let_places_go();
  /// Rays of each site; empty where all have LinkSettings::rays and there can be no more.
  [[nodiscard]] std::span<const std::uint32_t> rays() const { return rays_; }
  [[nodiscard]] const TraceCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t bytes() const;

  /// e without reflections: environment, light sources, emission of what the rays hit. One channel if is_grey(scene),
  /// else three. Traces shadow rays where the scene has light sources. Variances are those of the rays.
  [[nodiscard]] Solution direct(const Scene& scene, const SolveSettings& settings, const Run& run) const;

  /// e with settings.bounces reflections. \pre scene.outer is that of the links. Cost: a sweep reads each hit's e. All
  /// bounces converge faster than one bounce a sweep (Anderson's acceleration, 1965), and from `start` (e of an
  /// earlier solution with as many channels, empty for none) sooner. \throw InvalidInput, also for bounces where the
  /// ends were dropped
  [[nodiscard]] Solution solve(const Scene& scene, const SolveSettings& settings, const ToGrid& to_grid, const Run& run,
                               std::span<const float> start = {}) const;

  /// e where reflected light is not found but given, at the texels (`channels` of the scene each). \pre ends are
  /// kAtTexels. \throw InvalidInput, also where there is not one value a texel and channel
  [[nodiscard]] SampleSet reflecting(const Scene& scene, std::span<const float> texels, const SolveSettings& settings,
                                     const Run& run) const;

 private:
  class Solver;
  struct Rounds;
  struct WithoutProbes {};

  LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run, WithoutProbes);
  void trace(std::size_t first, std::size_t rays, std::span<const std::uint32_t> numbers, const Run& run);
  /// What to go back to where something is thrown.
  struct Mark;
  [[nodiscard]] Mark mark() const;
  void go_back(Mark&& before) noexcept;
  /// A change of the probes' links, whose rays are counted here.
  void change_again(const Run& run, const std::function<void(const Run& quiet)>& change);
  [[nodiscard]] SampleSet lamp_light(const SceneParts& parts, const SolveSettings& settings, TraceCounters& counters,
                                     const Run& run) const;
  /// The last reflection, of the light given, with what it takes to know its noise.
  void reflect_last(const SceneParts& parts, const SampleSet& lamps, const TargetLight& light,
                    const SolveSettings& settings, Solution& solution, const Run& run) const;
  /// e without reflections by the rays that are kept, but of sites that have no place (kLeftOut; empty: all have one).
  [[nodiscard]] SampleSet straight(const Scene& scene, const SampleSet& lamps, std::span<const std::uint32_t> places,
                                   const Run& run) const;
  /// e by all rays, reflecting the light given at the targets (none if empty).
  [[nodiscard]] SampleSet reflected(const Scene& scene, const SampleSet& lamps, const TargetLight& light,
                                    Solution& solution, const Run& run) const;
  /// Whether no more rays will be traced.
  [[nodiscard]] bool is_closed() const { return settings_.nets == RayNets::kInterleaved && settings_.kept == 0; }
  [[nodiscard]] RayCounts kept_rays() const;
  [[nodiscard]] RayCounts all_rays() const;
  [[nodiscard]] std::size_t first_rays() const {
    return std::size_t(settings_.kept > 0 ? settings_.kept : settings_.rays);
  }
  [[nodiscard]] LinkAim aim() const;
  [[nodiscard]] RoundRequest request(std::size_t first, std::size_t rays) const;
  /// \throw InvalidInput where there can be no more of what is named
  void require_open(const char* what) const;

  const Volume& volume_;
  Sites sites_;
  LinkSettings settings_;
  std::uint64_t seed_;
  TraceCounters counters_;
  std::vector<std::uint32_t> rays_;  ///< rays()
  std::unique_ptr<Rounds> rounds_;
  std::vector<std::size_t> probes_;
  std::unique_ptr<LightLinks> again_;  ///< of the probes, with other random numbers: see the variances of e
};

}  // namespace isolux
