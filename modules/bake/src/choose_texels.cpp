#include <fmt/format.h>
#include <isolux/bake/choose_texels.h>
#include <isolux/core/error.h>
#include <isolux/core/field.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace isolux {
namespace {

constexpr std::array<double, 6> kRatios = {0.25, 0.5, 0.75, 1.0, 1.5, 2.0};
constexpr std::size_t kPoints = 1000;  // the rms of an error is known to some 5 percent
constexpr int kPointRays = 256;
constexpr int kTexelRays = 64;

/// Random points of random level sets, the light there, and how much area of how many level sets each stands for.
struct Reference {
  SampleSet samples;
  std::vector<double> weights;
};

Reference trace_reference(const Volume& volume, const Scene& scene, const BakeSettings& settings,
                          const FlatTracer& tracer, const Stages& stages, const Run& run, TraceCounters& counters) {
  const auto sampler = stages.samplers.create(settings.isovalues ? "level_sets" : "random");
  SiteRequest request{.texels = cell_lattice(volume.lattice()),
                      .count = kPoints,
                      .isovalues = settings.isovalues,
                      .outer = scene.outer,
                      .gradient = settings.trace.gradient};
  Sites sites = sampler->sample(volume, request, run);
  if (sites.size() == 0)
    throw InvalidInput(fmt::format("{}: no site has a normal and an isovalue in the range", volume.name));
  Reference reference;
  const TrilinearField field(volume);
  for (const Vec3f& position : sites.positions) {
    // Points even in space lie the sparser on a level set the steeper the field is (the coarea formula).
    const Vec3 gradient = field.world_gradient(Vec3(position), GradientKind::kCentralDifferences);
    reference.weights.push_back(settings.isovalues ? 1.0 : glm::length(gradient));
  }
  TraceSettings rays = settings.trace;
  rays.rays = kPointRays;
  TraceResult traced = tracer.trace(volume, scene, std::move(sites), rays, run);
  counters.rays += traced.counters.rays;
  reference.samples = std::move(traced.samples);
  return reference;
}

/// The texels around every point, as sites.
struct Corners {
  struct Corner {
    std::size_t point;
    double weight;  ///< of the trilinear reading
  };
  Sites sites;
  std::vector<Corner> corners;  ///< of each site
};

Corners corners_of(const Volume& volume, const Scene& scene, const Lattice& texels, const Sites& points,
                   GradientKind gradient) {
  const TrilinearField field(volume);
  const IndexToWorld to_texels = index_to_index(volume.lattice(), texels);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  Corners result;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3 last = Vec3(texels.size - 1);
    const Vec3 at = glm::clamp(to_texels.world(Vec3(points.positions[p])), Vec3(0.0), last);
    const Vec3 low = glm::floor(at);
    for (unsigned q = 0; q < 8; ++q) {
      const Vec3 step(q & 1u, q >> 1 & 1u, q >> 2);
      const Vec3 part = glm::mix(1.0 - (at - low), at - low, step);
      const double weight = part.x * part.y * part.z;
      if (weight == 0.0) continue;
      const Vec3f position(to_volume.world(glm::min(low + step, last)));
      const Vec3 normal = field.normal(Vec3(position), scene.outer, gradient);
      if (normal == Vec3(0.0)) continue;
      result.sites.positions.push_back(position);
      result.sites.isovalues.push_back(float(field.value(Vec3(position))));
      result.sites.normals.emplace_back(normal);
      result.corners.push_back({p, weight});
    }
  }
  return result;
}

/// What reading between the texels says at each point, and the variance of that by rays.
struct Readings {
  std::vector<double> light;  ///< as SampleSet::radiance
  std::vector<double> variance;
  std::vector<double> weight;  ///< of the corners that are lit
};

Readings read_between(const Corners& corners, const SampleSet& texels, std::size_t points) {
  const auto channels = std::size_t(texels.channels);
  Readings read{std::vector<double>(points * channels), std::vector<double>(points), std::vector<double>(points)};
  for (std::size_t s = 0; s < texels.size(); ++s) {
    const auto [point, weight] = corners.corners[s];
    for (std::size_t c = 0; c < channels; ++c)
      read.light[point * channels + c] += weight * double(texels.radiance[s * channels + c]);
    read.variance[point] += weight * weight * double(texels.variance[s]);
    read.weight[point] += weight;
  }
  return read;
}

double interpolation_error(const Reference& reference, const Readings& read) {
  const auto channels = std::size_t(reference.samples.channels);
  double squares = 0.0;
  double total = 0.0;
  for (std::size_t p = 0; p < reference.samples.size(); ++p) {
    const double lit = read.weight[p];
    if (!(lit > 0.0)) continue;
    double square = 0.0;
    for (std::size_t c = 0; c < channels; ++c) {
      const double e = read.light[p * channels + c] / lit;
      square += std::pow(e - double(reference.samples.radiance[p * channels + c]), 2.0) / double(channels);
    }
    const double noise = double(reference.samples.variance[p]) + read.variance[p] / (lit * lit);
    squares += reference.weights[p] * (square - noise);
    total += reference.weights[p];
  }
  return total > 0.0 ? std::sqrt(std::max(0.0, squares / total)) : 0.0;
}

/// What the side that wants more texels wants.
TexelChoice choose_for_both(const Volume& volume, const Scene& scene, const BakeSettings& settings, double target,
                            const Stages& stages, const Run& run) {
  const auto choose = [&](LevelSetSide side) {
    return choose_texels(volume, scene_of_side(scene, side), settings, target, stages, run);
  };
  TexelChoice both = choose(LevelSetSide::kOuter);
  const TexelChoice inner = choose(LevelSetSide::kInner);
  both.texels = glm::max(both.texels, inner.texels);
  both.error = std::max(both.error, inner.error);
  add(both.counters, inner.counters);
  return both;
}

}  // namespace

Index3 texels_by_ratio(const Lattice& volume, double ratio) {
  return glm::max(Index3(glm::round(Vec3(volume.size - 1) * ratio)), Index3(1));
}

TexelChoice choose_texels(const Volume& volume, const Scene& scene, const BakeSettings& settings, double target,
                          const Stages& stages, const Run& run) {
  require_usable(volume);
  if (settings.lattice == TexelLattice::kVoxels)
    throw InvalidInput("texels at the voxels: their number is the volume's and cannot be chosen");
  if (scene.sides == LitSides::kBoth) return choose_for_both(volume, scene, settings, target, stages, run);
  const auto tracer = stages.tracers.create(settings.tracer.name, settings.tracer.settings);
  TexelChoice best{.texels = Index3(1), .error = std::numeric_limits<double>::infinity(), .counters = {}};
  const Reference reference = trace_reference(volume, scene, settings, *tracer, stages, run, best.counters);
  TraceSettings rays = settings.trace;
  rays.rays = std::min(rays.rays, kTexelRays);
  Run other = run;
  for (const double ratio : kRatios) {
    const Lattice texels = cell_lattice(volume.lattice(), texels_by_ratio(volume.lattice(), ratio));
    Corners corners = corners_of(volume, scene, texels, reference.samples.sites, settings.trace.gradient);
    ++other.seed;  // rays of a texel and of a point must not be the same ones
    const TraceResult traced = tracer->trace(volume, scene, std::move(corners.sites), rays, other);
    best.counters.rays += traced.counters.rays;
    const Readings read = read_between(corners, traced.samples, reference.samples.size());
    const double error = interpolation_error(reference, read);
    if (error < best.error) {
      best.texels = texels.size;
      best.error = error;
    }
    if (error <= target) break;
  }
  return best;
}

}  // namespace isolux
