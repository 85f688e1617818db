#include "wide/path_waves.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "directions.h"

namespace isolux::wide {
namespace {

/// Writes a ray of a batch.
void put_ray(Rays& rays, const Vec3f& origin, float isovalue, const Vec3& towards, const ToIndex& to_index) {
  const std::size_t at = rays.count++;
  for (int a = 0; a < 3; ++a) {
    const float* m = to_index.m[a];
    rays.origin[a][at] = origin[a];
    rays.direction[a][at] = float(double(m[0]) * towards.x + double(m[1]) * towards.y + double(m[2]) * towards.z);
  }
  rays.isovalue[at] = isovalue;
}

/// Is a place on the ray outside the box?
bool leaves_box(const Rays& rays, std::size_t ray, double t, const Vec3& last) {
  for (int a = 0; a < 3; ++a) {
    const double direction = double(rays.direction[a][ray]);
    if (direction == 0.0) continue;
    const double x = double(rays.origin[a][ray]) + t * direction;
    if (x < 0.0 || x > last[a]) return true;
  }
  return false;
}

}  // namespace

/// What a block's paths have come to.
struct PathWaves::Wave {
  int depth = 0;
  std::span<const std::uint32_t> sites;
  std::vector<Material> materials;  ///< of each site
  std::vector<Vec3> value;          ///< of each ray of the first wave
  std::vector<Vec3> lamps;          ///< what of it comes straight from light sources; empty: not asked for
  std::vector<Path> paths;          ///< one a ray of `batch`
  Batch batch;
};

/// A question of a path: does the light from there arrive?
struct PathWaves::Sighting {
  std::uint32_t path;
  Vec3 towards;     ///< world space, unit
  double distance;  ///< world units
  Vec3 light;       ///< added to the path's value if nothing is in the way
};

PathWaves::PathWaves(const Volume& volume, const Scene& scene, const TraceSettings& settings, const PathLimits& limits,
                     std::uint64_t seed, const Sites& sites)
    : scene_(scene),
      settings_(settings),
      limits_(limits),
      seed_(seed),
      field_(volume),
      environment_(scene.environment),
      lights_(scene.lights.begin(), scene.lights.end()),
      aimer_(volume.lattice().frame, seed, {.count = std::size_t(settings.rays)}, settings.nets, sites),
      mean_(aimer_.points(), std::size_t(settings.rays)) {}

UnitPair PathWaves::numbers(const Wave& wave, const Path& path, std::uint32_t dimension) const {
  const auto rays = std::uint32_t(aimer_.rays());
  // Of each vertex: its next direction, its roulette, its lights, its environment.
  const auto pairs_a_vertex = std::uint32_t(lights_.size()) + 3;
  return PathSampler(seed_, wave.sites[path.ray / rays])
      .pair(path.ray % rays, std::uint32_t(wave.depth) * pairs_a_vertex + dimension);
}

bool PathWaves::cuts_paths() const {
  constexpr float kLasting = 0.98f;
  const bool is_limited = settings_.bounces == kAllBounces || settings_.bounces > limits_.longest_path;
  return is_limited && largest_albedo(scene_) > kLasting;
}

void PathWaves::count_cut(const Wave& wave, std::span<std::uint32_t> cut, TraceCounters& counters) const {
  for (std::size_t i = 0; i < wave.batch.rays.count; ++i) {
    const Path& path = wave.paths[i];
    if (wave.batch.rays.t[i] == kEscaped || wave.materials[path.ray / aimer_.rays()].is_black) continue;
    ++counters.cut;
    if (!cut.empty()) ++cut[wave.sites[path.ray / aimer_.rays()]];
  }
}

void PathWaves::light(const SiteBlock& block, SampleSet& samples, SampleSet* lamps, std::span<std::uint32_t> cut,
                      TraceCounters& counters) const {
  static thread_local Wave wave;
  start(block, samples.sites, wave);
  wave.lamps.assign(lamps != nullptr ? wave.value.size() : 0, Vec3(0.0));
  for (wave.depth = 0; !wave.paths.empty(); ++wave.depth) {
    if (!lights_.empty() || environment_.has_samples()) direct_light(block, wave, counters);
    const bool none_goes_on = wave.depth == settings_.bounces || wave.depth == limits_.longest_path;
    const bool cuts = none_goes_on && wave.depth != settings_.bounces;
    if (is_dark(wave) && !cuts) break;
    if (wave.depth > 0) aim(wave);
    trace(block.field, block.occupancy, block.inner, none_goes_on ? Question::kAnyHit : Question::kFirstHit,
          wave.batch.rays, counters);
    for (std::size_t i = 0; i < wave.batch.rays.count; ++i)
      counters.hits += std::uint64_t(wave.batch.rays.t[i] != kEscaped);
    if (cuts) count_cut(wave, cut, counters);
    arrive(block, wave);
  }
  const std::size_t rays = aimer_.rays();
  for (std::size_t s = 0; s < block.sites.size(); ++s) {
    const std::uint32_t site = block.sites[s];
    if (samples.sites.normals[site] == Vec3f(0.0f)) continue;
    mean_.add(mean_.moments(std::span(wave.value).subspan(s * rays, rays)), site, samples);
    if (lamps != nullptr) mean_.add(mean_.moments(std::span(wave.lamps).subspan(s * rays, rays)), site, *lamps);
  }
}

bool PathWaves::is_dark(const Wave& wave) const {
  if (environment_.shines()) return false;
  const bool is_last = wave.depth == settings_.bounces || wave.depth == limits_.longest_path;
  return std::all_of(wave.materials.begin(), wave.materials.end(), [&](const Material& material) {
    return material.emission == Vec3(0.0) && (is_last || material.is_black);
  });
}

void PathWaves::start(const SiteBlock& block, const Sites& sites, Wave& wave) const {
  const std::size_t rays = aimer_.rays();
  wave.sites = block.sites;
  wave.materials.clear();
  wave.paths.clear();
  wave.value.assign(block.sites.size() * rays, Vec3(0.0));
  wave.batch.clear(wave.value.size());
  for (const std::uint32_t site : block.sites) {
    const float isovalue = sites.isovalues[site];
    const Vec3 albedo(scene_.albedo.at(isovalue));
    wave.materials.push_back({albedo, Vec3(scene_.emission.at(isovalue)), albedo == Vec3(0.0)});
    const auto first = std::uint32_t(wave.batch.rays.count);
    aimer_.append(sites, site, wave.batch.rays, wave.batch.world);
    const Path path{.ray = first,
                    .throughput = Vec3(1.0),
                    .position = sites.positions[site],
                    .isovalue = isovalue,
                    .normal = Vec3(sites.normals[site])};
    for (std::uint32_t k = 0; k < rays; ++k) wave.paths.push_back(path), wave.paths.back().ray = first + k;
  }
}

void PathWaves::aim(Wave& wave) const {
  wave.batch.rays.count = 0;
  for (const Path& path : wave.paths) {
    const UnitPair pair = numbers(wave, path, 0);
    const Vec3 towards = frame_about(path.normal).world(cosine_direction(pair.u, pair.v));
    for (int a = 0; a < 3; ++a) wave.batch.world.axis[a][wave.batch.rays.count] = float(towards[a]);
    put_ray(wave.batch.rays, path.position, path.isovalue, towards, aimer_.to_index());
  }
}

Vec3 PathWaves::escaped_light(const Vec3& normal, const Vec3& towards) const {
  const Vec3 radiance = environment_.radiance(towards);
  if (!environment_.has_samples()) return radiance;
  const double density = std::max(0.0, glm::dot(normal, towards)) * std::numbers::inv_pi;
  const double both = density + environment_.density(towards);
  return both > 0.0 ? radiance * (density / both) : Vec3(0.0);
}

bool PathWaves::go_on(const SiteBlock& block, const Wave& wave, std::size_t ray, Path& path) const {
  const Material& material = wave.materials[path.ray / aimer_.rays()];
  if (wave.depth == settings_.bounces || wave.depth == limits_.longest_path || material.is_black) return false;
  path.throughput *= material.albedo;
  if (wave.depth >= limits_.roulette_depth) {
    const Vec3& t = path.throughput;
    const double survival = std::min(1.0, std::max({t.x, t.y, t.z}));
    if (numbers(wave, path, 1).u >= survival) return false;
    path.throughput /= survival;
  }
  const Rays& rays = wave.batch.rays;
  Vec3 position;
  for (int a = 0; a < 3; ++a) {
    const double x = double(rays.origin[a][ray]) + double(rays.t[ray]) * double(rays.direction[a][ray]);
    position[a] = std::clamp(x, 0.0, double(block.field.size[a] - 1));
  }
  path.position = Vec3f(position);
  position = Vec3(path.position);
  path.isovalue = block.admitted(float(field_.value(position)));
  path.normal = field_.normal(position, scene_.outer, settings_.gradient);
  // Central differences can cancel where the cell itself still slopes.
  if (path.normal == Vec3(0.0)) path.normal = field_.normal(position, scene_.outer, GradientKind::kCell);
  return path.normal != Vec3(0.0);
}

void PathWaves::arrive(const SiteBlock& block, Wave& wave) const {
  const Rays& rays = wave.batch.rays;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rays.count; ++i) {
    Path path = wave.paths[i];
    Vec3& value = wave.value[path.ray];
    if (rays.t[i] == kEscaped) {
      const auto& world = wave.batch.world.axis;
      value += path.throughput * escaped_light(path.normal, {world[0][i], world[1][i], world[2][i]});
      continue;
    }
    value += path.throughput * wave.materials[path.ray / aimer_.rays()].emission;
    if (go_on(block, wave, i, path)) wave.paths[kept++] = path;
  }
  wave.paths.resize(kept);
}

void PathWaves::direct_light(const SiteBlock& block, Wave& wave, TraceCounters& counters) const {
  const IndexToWorld& frame = field_.lattice().frame;
  std::vector<Sighting> sightings;
  const auto consider = [&](std::size_t i, const Vec3& towards, double distance, const Vec3& light_a_cosine) {
    const Path& path = wave.paths[i];
    const double cosine = glm::dot(path.normal, towards);
    if (cosine > 0.0)
      sightings.push_back({std::uint32_t(i), towards, distance, path.throughput * light_a_cosine * cosine});
  };
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    LightView seen;
    for (std::size_t i = 0; i < wave.paths.size(); ++i) {
      const Path& path = wave.paths[i];
      // The first rays of a site all see the light from there.
      if (i == 0 || path.position != wave.paths[i - 1].position)
        seen = lights_[light].from(frame.world(Vec3(path.position)));
      const UnitPair pair = numbers(wave, path, 2 + std::uint32_t(light));
      const auto sample = seen.sample(pair.u, pair.v);
      if (sample) consider(i, sample->towards, sample->distance, sample->weight * std::numbers::inv_pi);
    }
    look(block, wave, sightings, counters);
  }
  // Nothing else has been added yet.
  if (wave.depth == 0 && !wave.lamps.empty()) wave.lamps = wave.value;
  if (!environment_.has_samples()) return;
  for (std::size_t i = 0; i < wave.paths.size(); ++i) {
    const Path& path = wave.paths[i];
    const UnitPair pair = numbers(wave, path, 2 + std::uint32_t(lights_.size()));
    const auto sample = environment_.sample(pair.u, pair.v);
    // The balance heuristic with the path's own cosine-distributed direction.
    const double both = glm::dot(path.normal, sample.towards) * std::numbers::inv_pi + sample.density;
    consider(i, sample.towards, kInfinity,
             environment_.radiance(sample.towards) * (std::numbers::inv_pi / std::max(both, 1e-300)));
  }
  look(block, wave, sightings, counters);
}

void PathWaves::look(const SiteBlock& block, Wave& wave, std::vector<Sighting>& sightings,
                     TraceCounters& counters) const {
  static thread_local Rays rays(0);
  if (rays.capacity() < sightings.size()) rays = Rays(sightings.size());
  rays.count = 0;
  // Whatever is in the way of a light outside the box is nearer than it: any hit will do.
  bool all_far = true;
  const Vec3 last(block.field.size - 1);
  for (const Sighting& s : sightings) {
    const Path& path = wave.paths[s.path];
    put_ray(rays, path.position, path.isovalue, s.towards, aimer_.to_index());
    all_far = all_far && leaves_box(rays, rays.count - 1, s.distance / double(aimer_.to_index().world_step), last);
  }
  trace(block.field, block.occupancy, block.inner, all_far ? Question::kAnyHit : Question::kFirstHit, rays, counters);
  for (std::size_t i = 0; i < rays.count; ++i) {
    const double met = double(rays.t[i]) * double(aimer_.to_index().world_step);
    const bool blocked = rays.t[i] != kEscaped && met <= sightings[i].distance;
    counters.hits += std::uint64_t(blocked);
    if (!blocked) wave.value[wave.paths[sightings[i].path].ray] += sightings[i].light;
  }
  sightings.clear();
}

}  // namespace isolux::wide
