// Shepard's interpolation: run time of the backends by number of samples and k.
#include <benchmark/benchmark.h>
#include <isolux/resample.h>

#include <cmath>

#include "../tests/support.h"

namespace {

using namespace isolux;

void shepard(benchmark::State& state, const std::string& backend, const std::string& distance) {
  const auto n = int(state.range(0));
  const Volume volume = testing::ramp_volume(Index3(n + 1));
  const Lattice texels = cell_lattice(volume.lattice());
  const SampleSet samples = testing::random_samples(volume, texels.count(), 1, [](const Vec3& p, int) {
    return float(0.5 + 0.5 * std::sin(0.3 * p.x) * std::cos(0.2 * p.y + 0.1 * p.z));
  });
  const auto resampler = resamplers().create(
      backend, {{"k", std::to_string(state.range(1))}, {"exponent", "0.5"}, {"distance", distance}});
  for (auto _ : state) benchmark::DoNotOptimize(resampler->resample(volume, samples, texels, {.threads = 1}));
  state.counters["texels/s"] =
      benchmark::Counter(double(texels.count()), benchmark::Counter::kIsIterationInvariantRate);
}

void with_axes(benchmark::internal::Benchmark* bench, int most) {
  bench->ArgNames({"n", "k"})->Unit(benchmark::kMillisecond);
  for (const int n : {16, 32, 64, 100}) {
    if (n > most) continue;
    for (const int k : {4, 11, 32}) bench->Args({n, k});
  }
}

BENCHMARK_CAPTURE(shepard, brute_force, std::string("brute_force"), std::string("euclidean"))->Apply([](auto* b) {
  with_axes(b, 16);
});
BENCHMARK_CAPTURE(shepard, cgal_kdtree, std::string("cgal_kdtree"), std::string("euclidean"))->Apply([](auto* b) {
  with_axes(b, 100);
});
BENCHMARK_CAPTURE(shepard, cell_grid, std::string("cell_grid"), std::string("euclidean"))->Apply([](auto* b) {
  with_axes(b, 100);
});
BENCHMARK_CAPTURE(shepard, cgal_kdtree_chebyshev, std::string("cgal_kdtree"), std::string("chebyshev"))
    ->Apply([](auto* b) { with_axes(b, 100); });
BENCHMARK_CAPTURE(shepard, cell_grid_chebyshev, std::string("cell_grid"), std::string("chebyshev"))->Apply([](auto* b) {
  with_axes(b, 100);
});

}  // namespace
