// What does light traced at the vertices of one isosurface cost, alone and with a baked light as control variate? The
// blocks and isosurfaces are those of light_on_surface; the error is taken at the vertices against 1024 rays. Counters:
// median and 80th percentile of the rms error and median of the absolute bias over all isosurfaces, vertices a second.
#include <benchmark/benchmark.h>
#include <isolux/bake/light_points.h>
#include <isolux/mc_extract/extractor.h>

#include <map>
#include <memory>

#include "surface_cases.h"

namespace {

using namespace isolux;
using namespace isolux::bench;

struct Surface {
  const Volume* volume;
  const LightReader* light;
  std::vector<Vec3f> vertices;
  PointLight reference;
};

struct Block {
  Volume volume;
  IlluminationGrid light;
  std::unique_ptr<LightReader> reader;
};

const TraceSettings kReference{.rays = kReferenceRays, .bounces = 0};

struct Cases {
  std::vector<std::unique_ptr<Block>> blocks;
  std::vector<Surface> surfaces;
  Stages stages = builtin_stages();

  Cases() {
    for (const Source& source : sources()) {
      auto block = std::make_unique<Block>();
      block->volume = busiest_block(read_volume(source.name), source.isovalues);
      const Lattice texels = cell_lattice(block->volume.lattice());
      const SiteRequest request{.texels = texels, .per_texel = 8.0};
      const SampleSet samples =
          trace(block->volume, samplers().create("stratified")->sample(block->volume, request, {.seed = 3}), 16, 5);
      block->light = fill_unlit(resamplers().create("fit")->resample(block->volume, samples, texels, {}), {});
      block->reader = std::make_unique<LightReader>(block->volume, block->light);
      for (const float h : source.isovalues) add_surface(*block, h);
      blocks.push_back(std::move(block));
    }
  }

  void add_surface(const Block& block, float isovalue) {
    const IsoMesh mesh = stages.extractors.create()->extract(block.volume, {.isovalue = isovalue}, {});
    if (mesh.n_vertices() < kPoints) return;
    Surface surface{.volume = &block.volume, .light = block.reader.get(), .vertices = {}, .reference = {}};
    for (const auto vertex : mesh.vertices()) {
      const auto& p = mesh.point(vertex);
      surface.vertices.emplace_back(p[0], p[1], p[2]);
    }
    surface.reference = light_points(block.volume, {}, surface.vertices, kReference, {}, stages, {.seed = 77});
    surfaces.push_back(std::move(surface));
  }
};

const Cases& cases() {
  static const Cases all;
  return all;
}

enum class Way { kTraced, kRefined, kRead };

void exact_light(benchmark::State& state, Way way) {
  const Cases& all = cases();
  const TraceSettings settings{.rays = int(state.range(0)), .bounces = 0};
  std::vector<double> rms;
  std::vector<double> bias;
  std::size_t vertices = 0;
  for (auto _ : state) {
    rms.clear();
    bias.clear();
    for (const Surface& surface : all.surfaces) {
      std::vector<Vec3f> e;
      if (way == Way::kTraced) {
        e = light_points(*surface.volume, {}, surface.vertices, settings, {}, all.stages, {.seed = 5}).radiance;
      } else if (way == Way::kRefined) {
        e = light_points(*surface.volume, {}, surface.vertices, settings, {}, all.stages, {.seed = 5}, *surface.light)
                .radiance;
      } else {
        for (const Vec3f& p : surface.vertices) e.push_back(surface.light->at_world(Vec3(p)));
      }
      double sum = 0.0;
      double squares = 0.0;
      for (std::size_t i = 0; i < e.size(); ++i) {
        const double d = double(e[i].x) - double(surface.reference.radiance[i].x);
        sum += d;
        squares += d * d;
      }
      vertices += e.size();
      rms.push_back(std::sqrt(squares / double(e.size())));
      bias.push_back(std::fabs(sum / double(e.size())));
    }
  }
  state.counters["median"] = percentile(rms, 0.5);
  state.counters["p80"] = percentile(rms, 0.8);
  state.counters["bias"] = percentile(bias, 0.5);
  state.counters["vertices/s"] = benchmark::Counter(double(vertices), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(exact_light, read, Way::kRead)->Arg(0)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(exact_light, traced, Way::kTraced)
    ->RangeMultiplier(2)
    ->Range(4, 512)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(exact_light, refined, Way::kRefined)
    ->RangeMultiplier(2)
    ->Range(4, 256)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
