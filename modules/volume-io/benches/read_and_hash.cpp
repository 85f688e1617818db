#include <benchmark/benchmark.h>
#include <isolux/volume_io.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

// A folder of its own, removed at the end.
struct Folder {
  std::filesystem::path path;
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "isolux-bench-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path); }
};

void set_rate(benchmark::State& state, const isolux::Volume& volume) {
  state.SetItemsProcessed(state.iterations() * std::int64_t(volume.lattice().count()));
}

void read_nrrd(benchmark::State& state) {
  const Folder folder;
  const std::string path = (folder.path / "a.nrrd").string();
  const isolux::Volume volume = isolux::read_volume("gen:gyroid:" + std::to_string(state.range(0)));
  isolux::write_volume(volume, path, {.compress = state.range(1) != 0});
  for (auto _ : state) benchmark::DoNotOptimize(isolux::read_volume(path));
  set_rate(state, volume);
}
BENCHMARK(read_nrrd)->ArgNames({"n", "gzip"})->Args({128, 0})->Args({128, 1})->Unit(benchmark::kMillisecond);

void sample_field(benchmark::State& state, const char* name) {
  isolux::Run run;
  run.threads = int(state.range(1));
  isolux::Volume volume;
  for (auto _ : state) volume = isolux::sample_analytic_field(name, int(state.range(0)), run);
  set_rate(state, volume);
}
BENCHMARK_CAPTURE(sample_field, gyroid, "gyroid")->ArgNames({"n", "threads"})->Args({128, 1})->Args({128, 2});
BENCHMARK_CAPTURE(sample_field, noise, "noise")->ArgNames({"n", "threads"})->Args({128, 1})->Args({128, 2});

void hash(benchmark::State& state) {
  const isolux::Volume volume = isolux::read_volume("gen:gyroid:" + std::to_string(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(isolux::volume_sha256(volume));
  set_rate(state, volume);
}
BENCHMARK(hash)->ArgName("n")->Arg(128)->Unit(benchmark::kMillisecond);

}  // namespace
