// Speed of the scalar intersector on the rays of flattened lighting: sites uniform in the volume, cosine rays about
// their normals, each confined to its own level set.
#include <benchmark/benchmark.h>
#include <isolux/core/field.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include <vector>

#include "analytic_volume.h"
#include "cell_cubic.h"
#include "directions.h"

namespace {

using namespace isolux;

struct SurfaceRay {
  Vec3 origin;
  Vec3 direction;
  float isovalue;
};

/// `count` sites with `rays_a_site` rays each, the sites in random order.
std::vector<SurfaceRay> surface_rays(const Volume& volume, int count, int rays_a_site) {
  RandomStream random(1, 2);
  const TrilinearField field(volume);
  const Vec3 last(volume.lattice().size - 1);
  std::vector<SurfaceRay> rays;
  for (int s = 0; s < count; ++s) {
    const Vec3 origin(Vec3f(last * Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double())));
    const Vec3 normal = field.normal(origin, OuterSide::kLower, GradientKind::kCentralDifferences);
    const Frame frame = frame_about(normal);
    for (int r = 0; r < rays_a_site; ++r)
      rays.push_back({.origin = origin,
                      .direction = frame.world(cosine_direction(random.uniform_double(), random.uniform_double())),
                      .isovalue = float(field.value(origin))});
  }
  return rays;
}

void report_rate(benchmark::State& state) {
  state.counters["Mrays/s"] = benchmark::Counter(double(state.iterations()) * 1e-6, benchmark::Counter::kIsRate);
}

void next_hit(benchmark::State& state) {
  const Volume volume = test::gyroid(int(state.range(0)));
  const LevelSetIntersector intersector(volume);
  const auto rays = surface_rays(volume, 4096, 64);
  std::size_t i = 0;
  for (auto _ : state) {
    const SurfaceRay& ray = rays[i++ % rays.size()];
    benchmark::DoNotOptimize(intersector.next_hit(ray.origin, ray.direction, ray.isovalue, OuterSide::kLower));
  }
  report_rate(state);
}
BENCHMARK(next_hit)->ArgName("gyroid")->Arg(64)->Arg(128)->Arg(256);

void any_hit(benchmark::State& state) {
  const Volume volume = test::gyroid(int(state.range(0)));
  const LevelSetIntersector intersector(volume);
  const auto rays = surface_rays(volume, 4096, 64);
  std::size_t i = 0;
  for (auto _ : state) {
    const SurfaceRay& ray = rays[i++ % rays.size()];
    benchmark::DoNotOptimize(intersector.is_occluded(ray.origin, ray.direction, ray.isovalue, OuterSide::kLower));
  }
  report_rate(state);
}
BENCHMARK(any_hit)->ArgName("gyroid")->Arg(64)->Arg(128)->Arg(256);

/// Parallel camera rays, row by row, as a renderer sends them.
void camera(benchmark::State& state) {
  const int n = int(state.range(0));
  const Volume volume = test::gyroid(n);
  const LevelSetIntersector intersector(volume);
  constexpr int kPixels = 256;
  int i = 0;
  for (auto _ : state) {
    const double u = (i % kPixels + 0.5) / kPixels;
    const double v = (i / kPixels % kPixels + 0.5) / kPixels;
    ++i;
    benchmark::DoNotOptimize(
        intersector.first_hit(Vec3(u * (n - 1), v * (n - 1), -double(n)), Vec3(0.1, 0.2, 1.0), 0.25f));
  }
  report_rate(state);
}
BENCHMARK(camera)->ArgName("gyroid")->Arg(64)->Arg(128)->Arg(256);

void build(benchmark::State& state) {
  const Volume volume = test::gyroid(int(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(std::make_unique<LevelSetIntersector>(volume));
}
BENCHMARK(build)->ArgName("gyroid")->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

/// The cell test alone: coefficients, then the first root; half the cells have one.
void cell_cubic(benchmark::State& state) {
  RandomStream random(5, 5);
  std::vector<CellCorners> cells(1024);
  for (CellCorners& cell : cells)
    for (double& v : cell) v = random.uniform_double() - 0.6;
  const std::array<double, 3> enter{0.0, 0.3, 0.2};
  const std::array<double, 3> leave{0.7, 1.0, 0.6};
  std::size_t i = 0;
  for (auto _ : state) {
    const auto b = segment_cubic(cells[i++ % cells.size()], enter, leave);
    if (b[0] < 0.0) benchmark::DoNotOptimize(first_root(b, RootWish::kPlace));
  }
}
BENCHMARK(cell_cubic);

}  // namespace
