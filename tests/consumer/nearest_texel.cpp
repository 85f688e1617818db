// A program outside isolux that adds a backend of its own: the resampler "nearest_sample" gives each texel its nearest
// sample.
#include <isolux/bake.h>
#include <isolux/core.h>
#include <isolux/volume_io.h>

#include <cstdio>
#include <limits>

namespace {

class NearestSample : public isolux::Resampler {
 public:
  struct Options {
    double reach = 1.0;
    void describe(isolux::OptionVisitor& option) {
      option("reach", reach, {.min = 0, .unit = "world units", .help = "farther texels stay unlit"});
    }
  };
  explicit NearestSample(const Options& options) : options_(options) {}

  [[nodiscard]] isolux::ResampledGrid resample(const isolux::Volume& volume, const isolux::SampleSet& samples,
                                               const isolux::Lattice& texels, const isolux::Run& run) const override {
    if (samples.size() == 0) throw isolux::InvalidInput("nearest_sample: there are no samples");
    isolux::ResampledGrid result{isolux::IlluminationGrid(texels, samples.channels), {}};
    result.lit.assign(texels.count(), 0);
    const auto channels = std::size_t(samples.channels);
    isolux::parallel_blocks(texels.count(), 256, run, "resample", [&](const isolux::Block& block) {
      for (std::size_t t = block.begin; t < block.end; ++t) {
        const auto nx = std::size_t(texels.size.x);
        const auto ny = std::size_t(texels.size.y);
        const isolux::Vec3 centre =
            texels.frame.world(isolux::Vec3(double(t % nx), double(t / nx % ny), double(t / (nx * ny))));
        double best = options_.reach * options_.reach;
        for (std::size_t s = 0; s < samples.size(); ++s) {
          const isolux::Vec3 d = volume.lattice().frame.world(isolux::Vec3(samples.sites.positions[s])) - centre;
          const double distance = d.x * d.x + d.y * d.y + d.z * d.z;
          if (distance > best) continue;
          best = distance;
          result.lit[t] = 1;
          for (std::size_t c = 0; c < channels; ++c)
            result.grid.values[t * channels + c] = samples.radiance[s * channels + c];
        }
      }
    });
    return result;
  }

 private:
  Options options_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: consumer VOLUME\n", stderr);
    return 2;
  }
  if (isolux::read_volume(argv[1]).lattice().count() < 8) return 1;
  const isolux::Volume volume = isolux::read_volume("gen:sphere:8");
  isolux::Stages stages = isolux::builtin_stages();
  stages.resamplers.add<NearestSample>("nearest_sample", "the value of the nearest sample");

  isolux::BakeSettings settings;
  settings.sampler.name = "random";
  settings.samples = 100;
  settings.resampler = {"nearest_sample", {{"reach", "0.5"}}};
  settings.trace.rays = 4;
  settings.trace.bounces = 0;
  const isolux::BakeResult result = isolux::bake(volume, isolux::Scene{}, settings, stages, isolux::Run{});
  const float e = result.light.at_world(isolux::Vec3(0.5, 0.5, 0.8)).x;
  std::printf("light at the sphere's top: %g\n", double(e));
  return e > 0.9f && e < 1.1f ? 0 : 1;  // a convex level set under a white sky
}
