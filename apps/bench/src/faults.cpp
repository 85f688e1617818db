#include "faults.h"

#include <cell_cubic.h>
#include <directions.h>
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/level_set_intersector.h>
#include <isolux/raytrace_flat/trace_counters.h>

#include <memory>
#include <optional>
#include <utility>

#include "cell_walk.h"

namespace isolux::bench {
namespace {

constexpr float kDimming = 0.98f;
constexpr double kLostHits = 0.02;

/// A beginner's path tracer, one ray at a time; where a ray ends is Hits' answer.
template <class Hits>
class PlainTracer final : public FlatTracer {
 public:
  struct Options {
    int longest_path = 1000;

    void describe(OptionVisitor& option) {
      option("longest_path", longest_path, {.min = 0, .max = 1e6, .help = "reflections at most"});
    }
  };
  explicit PlainTracer(const Options& options) : options_(options) {}

  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const Run& run) const override {
    const auto* sky = std::get_if<UniformEnvironment>(&scene.environment);
    if (sky == nullptr || !scene.lights.empty() || !is_grey(scene)) {
      throw InvalidInput("this tracer, wrong on purpose, knows grey light from a uniform environment only");
    }
    TraceResult result;
    SampleSet& samples = result.samples;
    samples.sites = std::move(sites);
    samples.radiance.resize(samples.size());
    samples.variance.resize(samples.size());
    const Hits hits(volume, scene.outer);
    constexpr std::size_t kSitesABlock = 32;
    std::vector<TraceCounters> counters(block_count(samples.size(), kSitesABlock));
    parallel_blocks(samples.size(), kSitesABlock, run, "trace", [&](const Block& block) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        double sum = 0.0;
        double squares = 0.0;
        for (int path = 0; path < settings.rays; ++path) {
          RandomStream random(run.seed, i, std::uint32_t(path));
          const double e = follow(hits, volume, scene, double(sky->radiance.x), settings.bounces, samples.sites, i,
                                  random, counters[block.index]);
          sum += e;
          squares += e * e;
        }
        const double n = settings.rays;
        samples.radiance[i] = float(sum / n);
        samples.variance[i] = float(std::max(0.0, squares / n - sum / n * (sum / n)) / std::max(1.0, n - 1.0));
      }
    });
    for (const TraceCounters& part : counters) add(result.counters, part);
    return result;
  }

 private:
  [[nodiscard]] double follow(const Hits& hits, const Volume& volume, const Scene& scene, double sky, int bounces,
                              const Sites& sites, std::size_t site, RandomStream& random,
                              TraceCounters& counters) const {
    const TrilinearField field(volume);
    const float isovalue = sites.isovalues[site];
    const auto albedo = double(scene.albedo.at(isovalue).x);
    const auto emission = double(scene.emission.at(isovalue).x);
    Vec3 position(sites.positions[site]);
    Vec3 normal(sites.normals[site]);
    double throughput = 1.0;
    double sum = 0.0;
    for (int depth = 0; depth <= options_.longest_path && normal != Vec3(0.0); ++depth) {
      const double u = random.uniform_double();
      const Vec3 towards = frame_about(normal).world(cosine_direction(u, random.uniform_double()));
      const Vec3 direction = glm::inverse(volume.lattice().frame.axes) * towards;
      ++counters.rays;
      const auto place = hits.next(position, direction, isovalue, random, counters);
      if (!place) return sum + throughput * sky;
      ++counters.hits;
      sum += throughput * emission;
      throughput *= albedo;
      if (depth == bounces || throughput < 1e-4) return sum;
      position = *place;
      normal = field.normal(position, scene.outer, GradientKind::kCentralDifferences);
    }
    return sum;
  }

  Options options_;
};

/// The scalar oracle, whose answer is thrown away once in fifty hits.
class LostHits {
 public:
  LostHits(const Volume& volume, OuterSide outer) : intersector_(volume), outer_(outer) {}
  [[nodiscard]] std::optional<Vec3> next(const Vec3& origin, const Vec3& direction, float isovalue,
                                         RandomStream& random, TraceCounters& /*counters*/) const {
    const auto hit = intersector_.next_hit(origin, direction, isovalue, outer_);
    if (!hit || random.uniform_double() < kLostHits) return std::nullopt;
    return hit->position;
  }

 private:
  LevelSetIntersector intersector_;
  OuterSide outer_;
};

/// Every cell on the way is loaded and tested.
class EveryCell {
 public:
  EveryCell(const Volume& volume, OuterSide outer)
      : lattice_(volume.lattice()),
        data_(volume.values.values().data()),
        inner_(outer == OuterSide::kLower ? 1.0 : -1.0),
        field_(volume) {}

  [[nodiscard]] std::optional<Vec3> next(const Vec3& origin, const Vec3& direction, float /*isovalue*/,
                                         RandomStream& /*random*/, TraceCounters& counters) const {
    const double level = field_.value(origin);
    std::optional<Vec3> hit;
    bool fresh = true;
    walk_cells(lattice_, origin, direction, std::numeric_limits<double>::infinity(),
               [&](const Index3& cell, double t0, double t1) {
                 ++counters.cells;
                 const auto s = test(cell, origin + t0 * direction, origin + t1 * direction, level, fresh, counters);
                 if (s) hit = origin + (t0 + *s * (t1 - t0)) * direction;
                 return !hit;
               });
    return hit;
  }

 private:
  /// Where the ray meets the level set on its way through the cell, 0 to 1.
  [[nodiscard]] std::optional<double> test(const Index3& cell, const Vec3& enter, const Vec3& leave, double level,
                                           bool& fresh, TraceCounters& counters) const {
    const float* p = data_ + lattice_.offset(cell.x, cell.y, cell.z);
    const std::ptrdiff_t y = lattice_.size.x;
    const std::ptrdiff_t z = y * lattice_.size.y;
    CellCorners corners{p[0], p[1], p[y], p[y + 1], p[z], p[z + 1], p[y + z], p[y + z + 1]};
    for (double& v : corners) v = inner_ * (v - level);
    std::array<double, 3> from{};
    std::array<double, 3> to{};
    for (int a = 0; a < 3; ++a) {
      from[std::size_t(a)] = std::clamp(enter[a] - cell[a], 0.0, 1.0);
      to[std::size_t(a)] = std::clamp(leave[a] - cell[a], 0.0, 1.0);
    }
    // A first part as short as the rounding of a coordinate tells nothing.
    if (fresh && glm::length(leave - enter) < 1e-12 * lattice_.size.x) return std::nullopt;
    ++counters.cubics;
    const auto b = segment_cubic(corners, from, to);
    if (!fresh) return b[0] >= 0.0 ? 0.0 : first_root(b, RootWish::kPlace);
    const DeflatedRoot root = deflated_root(b);
    fresh = root.kind == DeflatedRoot::Kind::kFlat;
    if (root.kind == DeflatedRoot::Kind::kBlocked) return 0.0;
    return root.kind == DeflatedRoot::Kind::kHit ? std::optional(root.s) : std::nullopt;
  }

  Lattice lattice_;
  const float* data_;
  double inner_;
  TrilinearField field_;
};

class DimLight final : public FlatTracer {
 public:
  using Options = NoOptions;
  explicit DimLight(const NoOptions& /*options*/) : healthy_(tracers().create()) {}
  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const Run& run) const override {
    TraceResult result = healthy_->trace(volume, scene, std::move(sites), settings, run);
    for (float& e : result.samples.radiance) e *= kDimming;
    return result;
  }

 private:
  std::unique_ptr<const FlatTracer> healthy_;
};

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"dim_light", "the default tracer, its light times .98"},
      {"lost_hits", "a ray forgets one hit in fifty"},
      {"no_skipping", "every cell on a ray's way is tested"},
  };
  return all;
}

Stages with_fault(Stages stages, std::string_view name) {
  if (name == "dim_light") {
    stages.tracers.add<DimLight>("dim_light", std::string(faults()[0].help));
  } else if (name == "lost_hits") {
    stages.tracers.add<PlainTracer<LostHits>>("lost_hits", std::string(faults()[1].help));
  } else if (name == "no_skipping") {
    stages.tracers.add<PlainTracer<EveryCell>>("no_skipping", std::string(faults()[2].help));
  } else {
    throw InvalidInput(fmt::format("no fault '{}': there are dim_light, lost_hits and no_skipping", name));
  }
  stages.tracers.set_default(name);
  return stages;
}

}  // namespace isolux::bench
