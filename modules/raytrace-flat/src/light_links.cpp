#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/raytrace_flat/light_links.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "environment.h"
#include "trace_counters.h"
#include "wide/aimer.h"
#include "wide/net_mean.h"

namespace isolux {
namespace {

constexpr std::size_t kSitesABlock = 512;
constexpr double kParts = 65534.0;

}  // namespace

/// Reads e of a grid at the ends of rays.
class LightLinks::Reader {
 public:
  Reader(const IlluminationGrid& grid, const Lattice& volume)
      : stride_y_(grid.lattice.size.x), stride_z_(stride_y_ * grid.lattice.size.y), grid_(grid) {
    const IndexToWorld to_texel = index_to_index(volume, grid.lattice);
    origin_ = to_texel.origin;
    for (int a = 0; a < 3; ++a) {
      step_[a] = to_texel.axes[a] * (double(volume.size[a] - 1) / kParts);
      corner_[a] = float(origin_[a]);
      scale_[a] = float(step_[a][a]);
      last_[a] = float(grid.lattice.size[a] - 1);
      // A thousandth of a texel over the whole box is nothing.
      for (int b = 0; b < 3; ++b) is_aligned_ = is_aligned_ && (a == b || std::fabs(step_[a][b]) * kParts < 1e-3);
    }
  }

  /// \pre `end` is not outside
  [[nodiscard]] Vec3 at(const End& end) const {
    return Vec3(
        grid_.at_index(origin_ + double(end.x) * step_[0] + double(end.y) * step_[1] + double(end.z) * step_[2]));
  }

  /// Sum over the ends of hits.
  [[nodiscard]] Vec3 sum(std::span<const End> ends) const {
    Vec3 sum(0.0);
    if (grid_.channels == 1 && is_aligned_) {
      float grey = 0.0f;
      for (const End& end : ends)
        if (end.x != kOutside) grey += grey_at(end);
      return Vec3(double(grey));
    }
    for (const End& end : ends)
      if (end.x != kOutside) sum += at(end);
    return sum;
  }

 private:
  /// at() of one channel and axes that agree: what sweeps spend their time with.
  [[nodiscard]] float grey_at(const End& end) const {
    const float x = std::clamp(corner_[0] + float(end.x) * scale_[0], 0.0f, last_[0]);
    const float y = std::clamp(corner_[1] + float(end.y) * scale_[1], 0.0f, last_[1]);
    const float z = std::clamp(corner_[2] + float(end.z) * scale_[2], 0.0f, last_[2]);
    // The upper neighbour of the last texel is itself.
    const auto i = int(x);
    const auto j = int(y);
    const auto k = int(z);
    const std::ptrdiff_t dx = x < last_[0] ? 1 : 0;
    const std::ptrdiff_t dy = y < last_[1] ? stride_y_ : 0;
    const std::ptrdiff_t dz = z < last_[2] ? stride_z_ : 0;
    const float* v = grid_.values.data() + (i + j * stride_y_ + k * stride_z_);
    const float fx = x - float(i);
    const float fy = y - float(j);
    const float fz = z - float(k);
    const auto mix = [](float a, float b, float f) { return a + f * (b - a); };
    const float near = mix(mix(v[0], v[dx], fx), mix(v[dy], v[dy + dx], fx), fy);
    const float far = mix(mix(v[dz], v[dz + dx], fx), mix(v[dz + dy], v[dz + dy + dx], fx), fy);
    return mix(near, far, fz);
  }

  bool is_aligned_ = true;
  float corner_[3];
  float scale_[3];
  float last_[3];
  std::ptrdiff_t stride_y_;
  std::ptrdiff_t stride_z_;
  const IlluminationGrid& grid_;
  Vec3 origin_;
  Vec3 step_[3];
};

LightLinks::LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run)
    : LightLinks(volume, std::move(sites), settings, run, WithoutProbes{}) {
  probes_ = wide::choose_probes(sites_);
  Run other = run;
  other.seed = wide::probe_seed(run.seed);
  other.progress = {};
  again_.reset(new LightLinks(volume, wide::sites_of(sites_, probes_), settings, other, WithoutProbes{}));
  add(counters_, again_->counters_);
}

LightLinks::LightLinks(const Volume& volume, Sites sites, const LinkSettings& settings, const Run& run, WithoutProbes)
    : volume_(volume), sites_(std::move(sites)), settings_(settings), seed_(run.seed) {
  const GatherSettings request{.rays = settings.rays, .outer = settings.outer, .question = RayQuestion::kFirstHit};
  if (settings.rays > 0) ends_.resize(sites_.size() * std::size_t(settings.rays));
  counters_ = gather(volume, sites_, request, run, [&](const GatheredRays& gathered) {
    for (std::size_t i = 0; i < gathered.index_distance.size(); ++i) {
      const std::size_t site = gathered.sites[i / gathered.rays];
      const double t = double(gathered.index_distance[i]);
      const Vec3 direction(gathered.index_direction[0][i], gathered.index_direction[1][i],
                           gathered.index_direction[2][i]);
      ends_[site * gathered.rays + i % gathered.rays] =
          gathered.escaped(i) ? End{kOutside, 0, 0} : end_of(sites_.positions[site], t * direction);
    }
  });
}

LightLinks::End LightLinks::end_of(const Vec3f& origin, const Vec3& way) const {
  std::uint16_t parts[3];
  for (int a = 0; a < 3; ++a) {
    const double place = (double(origin[a]) + way[a]) / double(volume_.lattice().size[a] - 1);
    parts[a] = std::uint16_t(std::lround(std::clamp(place, 0.0, 1.0) * kParts));
  }
  return {parts[0], parts[1], parts[2]};
}

SampleSet LightLinks::lamp_light(const Scene& scene, const SolveSettings& settings, TraceCounters& counters,
                                 const Run& run) const {
  SampleSet samples;
  samples.sites = sites_;
  samples.channels = is_grey(scene) ? 1 : 3;
  samples.radiance.resize(sites_.size() * std::size_t(samples.channels));
  samples.variance.resize(sites_.size());
  if (scene.lights.empty()) return samples;
  Scene lamps = scene;
  lamps.environment = UniformEnvironment{Vec3f(0.0f)};
  lamps.emission = {.keys = {{0.0f, Vec3f(0.0f)}}};
  const TraceSettings trace{.rays = settings_.rays, .bounces = 0, .gradient = settings.gradient};
  Run own = run;
  own.seed = seed_;
  TraceResult result = tracers().create("wide")->trace(volume_, lamps, sites_, trace, own);
  add(counters, result.counters);
  for (std::size_t i = 0; i < samples.radiance.size(); ++i)
    samples.radiance[i] = result.samples.radiance[result.samples.channels == samples.channels ? i : i / 3];
  samples.variance = std::move(result.samples.variance);
  return samples;
}

void LightLinks::ray_values(std::size_t site, const Scene& scene, const Reader* e, std::vector<Vec3>& values) const {
  const float isovalue = sites_.isovalues[site];
  const Vec3 albedo(scene.albedo.at(isovalue));
  const Vec3 emission(scene.emission.at(isovalue));
  const auto* uniform = std::get_if<UniformEnvironment>(&scene.environment);
  const std::span<const End> all = ends(site);
  values.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].x == kOutside) {
      values[k] = uniform != nullptr ? Vec3(uniform->radiance) : Vec3(0.0);
    } else {
      values[k] = e != nullptr ? emission + albedo * e->at(all[k]) : emission;
    }
  }
}

void LightLinks::add_up(const Scene& scene, const SampleSet& lamps, const Reader* e, SampleSet& samples,
                        const Run& run) const {
  const auto rays = std::size_t(settings_.rays);
  const wide::Aimer aimer(volume_.lattice().frame, seed_, rays);
  const wide::NetMean mean(aimer.points(), rays);
  const PreparedEnvironment environment(scene.environment);
  const bool is_uniform = std::holds_alternative<UniformEnvironment>(scene.environment);
  samples.sites = sites_;
  samples.channels = lamps.channels;
  samples.radiance.resize(lamps.radiance.size());
  samples.variance.resize(lamps.variance.size());
  parallel_blocks(sites_.size(), kSitesABlock, run, "", [&](const Block& block) {
    std::vector<Vec3> values;
    wide::Batch batch;
    batch.clear(rays);
    for (std::size_t site = block.begin; site < block.end; ++site) {
      ray_values(site, scene, e, values);
      if (!is_uniform) {
        // The directions are a function of seed and site: they are made again, not kept.
        batch.rays.count = 0;
        aimer.append(sites_, site, batch.rays, batch.world);
        const auto& w = batch.world.axis;
        const std::span<const End> all = ends(site);
        for (std::size_t k = 0; k < rays; ++k)
          if (all[k].x == kOutside) values[k] = environment.radiance({w[0][k], w[1][k], w[2][k]});
      }
      mean.put(values, site, samples);
    }
  });
  for (std::size_t i = 0; i < samples.radiance.size(); ++i) samples.radiance[i] += lamps.radiance[i];
  for (std::size_t i = 0; i < samples.variance.size(); ++i) samples.variance[i] += lamps.variance[i];
}

double LightLinks::sweep(const Scene& scene, const SampleSet& straight, const Reader& e, SampleSet& samples,
                         const Run& run) const {
  const auto channels = std::size_t(samples.channels);
  const std::size_t blocks = block_count(sites_.size(), kSitesABlock);
  std::vector<double> changes(blocks);
  std::vector<double> squares(blocks);
  parallel_blocks(sites_.size(), kSitesABlock, run, "", [&](const Block& block) {
    for (std::size_t site = block.begin; site < block.end; ++site) {
      if (sites_.normals[site] == Vec3f(0.0f)) continue;
      Vec3 sum = e.sum(ends(site));
      sum *= Vec3(scene.albedo.at(sites_.isovalues[site])) / double(settings_.rays);
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t at = site * channels + c;
        const double next = double(straight.radiance[at]) + sum[int(c)];
        changes[block.index] += (next - double(samples.radiance[at])) * (next - double(samples.radiance[at]));
        squares[block.index] += next * next;
        samples.radiance[at] = float(next);
      }
    }
  });
  double change = 0.0;
  double square = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) {
    change += changes[b];
    square += squares[b];
  }
  return square > 0.0 ? std::sqrt(change / square) : 0.0;
}

Solution LightLinks::direct(const Scene& scene, const SolveSettings& settings, const Run& run) const {
  SolveSettings none = settings;
  none.bounces = 0;
  return solve(scene, none, {}, run);
}

Solution LightLinks::solve(const Scene& scene, const SolveSettings& settings, const ToGrid& to_grid,
                           const Run& run) const {
  require_valid(scene);
  if (scene.outer != settings_.outer) throw InvalidInput("the scene's outer side is not that of the light's links");
  if (settings.bounces < kAllBounces)
    throw InvalidInput(fmt::format("bounces = {}: allowed is -1 (all), 0 and more", settings.bounces));
  Solution solution;
  const SampleSet lamps = lamp_light(scene, settings, solution.counters, run);
  add_up(scene, lamps, nullptr, solution.samples, run);
  const SampleSet straight = solution.samples;
  const bool all = settings.bounces == kAllBounces;
  const int most = all ? settings.most_sweeps : settings.bounces;
  IlluminationGrid grid;
  double before = 0.0;
  while (solution.sweeps < most) {
    grid = to_grid(solution.samples);
    const std::vector<float> last = solution.samples.radiance;
    ++solution.sweeps;
    const double change = sweep(scene, straight, Reader(grid, volume_.lattice()), solution.samples, run);
    if (run.progress) run.progress("bounces", double(solution.sweeps) / double(most));
    // Changes fall like a geometric series: what is left of it is known, and added when it is small.
    const double ratio = before > 0.0 ? std::min(change / before, 0.95) : 0.95;
    const double tail = ratio / (1.0 - ratio);
    before = change;
    solution.change = change * tail;
    if (!all || solution.change > settings.tolerance) continue;
    for (std::size_t i = 0; i < last.size(); ++i)
      solution.samples.radiance[i] += float(tail) * (solution.samples.radiance[i] - last[i]);
    grid = to_grid(solution.samples);
    break;
  }
  std::optional<Reader> reflected;
  if (solution.sweeps > 0) reflected.emplace(grid, volume_.lattice());
  const Reader* e = reflected ? &*reflected : nullptr;
  // The last sweep again with what it takes to know its noise; the probes see the same grid with other rays.
  if (e != nullptr) add_up(scene, lamps, e, solution.samples, run);
  if (again_ == nullptr) return solution;
  SampleSet again;
  again_->add_up(scene, again_->lamp_light(scene, settings, solution.counters, run), e, again, run);
  wide::calibrate_variance(solution.samples, probes_, again);
  return solution;
}

}  // namespace isolux
