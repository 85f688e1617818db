#include <benchmark/benchmark.h>
#include <isolux/sample_sites.h>

#include <cmath>

namespace {

/// A gyroid on [0,1]^3.
isolux::Volume gyroid(int n) {
  isolux::Volume volume;
  volume.name = "gyroid";
  volume.values = isolux::Grid<float>(isolux::Lattice{.size = isolux::Index3(n), .frame = {}});
  const auto angle = [n](int i) { return 4.0 * 3.14159265358979 * i / (n - 1); };
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        volume.values(i, j, k) =
            float(std::sin(angle(i)) * std::cos(angle(j)) + std::sin(angle(j)) * std::cos(angle(k)) +
                  std::sin(angle(k)) * std::cos(angle(i)));
      }
    }
  }
  return volume;
}

/// Sites a second of one backend, over the whole volume or a hundredth of its isovalues.
void sample(benchmark::State& state, const char* name, bool narrow) {
  const isolux::Volume volume = gyroid(int(state.range(0)));
  isolux::SiteRequest request{.texels = isolux::cell_lattice(volume.lattice()), .count = std::size_t(state.range(1))};
  if (narrow) request.isovalues = isolux::ValueRange{.low = 0.0f, .high = 0.03f};
  const auto sampler = isolux::samplers().create(name);
  std::size_t sites = 0;
  for (auto _ : state) sites += sampler->sample(volume, request, {.seed = 1, .threads = 1}).size();
  state.counters["sites/s"] = benchmark::Counter(double(sites), benchmark::Counter::kIsRate);
}

}  // namespace

#define ISOLUX_SAMPLER_BENCH(name)                      \
  BENCHMARK_CAPTURE(sample, name##_whole, #name, false) \
      ->ArgNames({"n", "sites"})                        \
      ->Args({64, 1 << 18})                             \
      ->Args({128, 1 << 18});                           \
  BENCHMARK_CAPTURE(sample, name##_narrow, #name, true)->ArgNames({"n", "sites"})->Args({64, 1 << 16})
ISOLUX_SAMPLER_BENCH(random);
ISOLUX_SAMPLER_BENCH(stratified);
ISOLUX_SAMPLER_BENCH(low_discrepancy);
ISOLUX_SAMPLER_BENCH(texels);
