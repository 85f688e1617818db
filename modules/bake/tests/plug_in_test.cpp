// What a program's own backends give a bake is checked before it is used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace isolux::test {
namespace {

using ::testing::HasSubstr;

/// What is done to what a healthy backend gave; of one test at a time.
template <class What>
std::function<void(What&)>& spoiling() {
  static std::function<void(What&)> spoil;
  return spoil;
}

class SpoiltSampler final : public SiteSampler {
 public:
  using Options = NoOptions;
  explicit SpoiltSampler(const Options& /*options*/) {}
  [[nodiscard]] Sites sample(const Volume& volume, const SiteRequest& request, const isolux::Run& run) const override {
    Sites sites = samplers().create("random")->sample(volume, request, run);
    spoiling<Sites>()(sites);
    return sites;
  }
};

class SpoiltTracer final : public FlatTracer {
 public:
  using Options = NoOptions;
  explicit SpoiltTracer(const Options& /*options*/) {}
  [[nodiscard]] TraceResult trace(const Volume& volume, const Scene& scene, Sites sites, const TraceSettings& settings,
                                  const isolux::Run& run) const override {
    TraceResult result = tracers().create("wide")->trace(volume, scene, std::move(sites), settings, run);
    spoiling<SampleSet>()(result.samples);
    spoiling<TraceResult>()(result);
    return result;
  }
};

class SpoiltResampler final : public Resampler {
 public:
  using Options = NoOptions;
  explicit SpoiltResampler(const Options& /*options*/) {}
  [[nodiscard]] ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                                       const isolux::Run& run) const override {
    ResampledGrid result = resamplers().create("cell_grid")->resample(volume, samples, texels, run);
    spoiling<ResampledGrid>()(result);
    return result;
  }
};

/// The words of what a bake with these three throws; empty if it throws nothing.
template <class What>
std::string error_of(std::function<void(What&)> spoil,
                     const std::function<void(const BakeSettings&, const Stages&)>& light) {
  spoiling<Sites>() = [](Sites&) {};
  spoiling<SampleSet>() = [](SampleSet&) {};
  spoiling<TraceResult>() = [](TraceResult&) {};
  spoiling<ResampledGrid>() = [](ResampledGrid&) {};
  spoiling<What>() = std::move(spoil);
  Stages stages = builtin_stages();
  stages.samplers.add<SpoiltSampler>("mine", "");
  stages.tracers.add<SpoiltTracer>("mine", "");
  stages.resamplers.add<SpoiltResampler>("mine", "");
  BakeSettings settings;
  settings.sampler.name = settings.tracer.name = settings.resampler.name = "mine";
  settings.trace = {.rays = 4, .bounces = 0};
  settings.samples = 300;
  try {
    light(settings, stages);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

template <class What>
std::string error_of(std::function<void(What&)> spoil) {
  return error_of<What>(std::move(spoil), [](const BakeSettings& settings, const Stages& stages) {
    (void)bake(read_volume("gen:gyroid:9"), {}, settings, stages, {});
  });
}

TEST(PlugIns, ThatDoWellAreTaken) {
  EXPECT_EQ(error_of<Sites>([](Sites&) {}), "");
}

TEST(PlugIns, SitesHaveToLieInTheBoxAndBeNumbers) {
  EXPECT_THAT(error_of<Sites>([](Sites& sites) { sites.positions[3] = Vec3f(-40.0f); }),
              HasSubstr("sampler mine: site 3 at (-40, -40, -40) is not in the box"));
  EXPECT_THAT(error_of<Sites>([](Sites& sites) { sites.positions[3].x = std::nanf(""); }), HasSubstr("not in the box"));
  EXPECT_THAT(error_of<Sites>([](Sites& sites) { sites.positions[3].y = INFINITY; }), HasSubstr("not in the box"));
  EXPECT_THAT(error_of<Sites>([](Sites& sites) { sites.isovalues[3] = std::nanf(""); }), HasSubstr("isovalue nan"));
  EXPECT_THAT(error_of<Sites>([](Sites& sites) { sites.normals[3].z = std::nanf(""); }), HasSubstr("normal ("));
  EXPECT_THAT(error_of<Sites>([](Sites& sites) { sites.normals.resize(3); }), HasSubstr("3 normals"));
}

TEST(PlugIns, TracersHaveToLightEverySite) {
  EXPECT_THAT(error_of<SampleSet>([](SampleSet& samples) {
                const std::vector<std::size_t> first{0, 1, 2};
                samples.sites = some_of(samples.sites, first);
                samples.radiance.resize(3);
                samples.variance.resize(3);
              }),
              HasSubstr("tracer mine: "));
  EXPECT_THAT(error_of<SampleSet>([](SampleSet& samples) { samples.radiance.pop_back(); }), HasSubstr("tracer mine: "));
  EXPECT_THAT(error_of<SampleSet>([](SampleSet& samples) { samples.channels = 0; }), HasSubstr("tracer mine: "));
  EXPECT_THAT(error_of<TraceResult>([](TraceResult& result) { result.rays.resize(3); }),
              HasSubstr("3 numbers of rays"));
  EXPECT_THAT(error_of<TraceResult>([](TraceResult& result) { result.cut.resize(3); }),
              HasSubstr("3 of paths cut off"));
  for (const float bad : {std::nanf(""), INFINITY})
    EXPECT_THAT(error_of<SampleSet>([&](SampleSet& samples) { samples.radiance[7] = bad; }),
                HasSubstr("tracer mine: sample 7: its radiance is "));
}

TEST(PlugIns, TracersHaveToLightTheTexelsThatAreChosenFrom) {
  const auto choose = [](const BakeSettings& settings, const Stages& stages) {
    (void)choose_texels(read_volume("gen:gyroid:9"), {}, settings, 0.1, stages, {});
  };
  EXPECT_EQ(error_of<SampleSet>([](SampleSet&) {}, choose), "");
  EXPECT_THAT(error_of<SampleSet>([](SampleSet& samples) { samples.radiance.resize(3); }, choose),
              HasSubstr("tracer mine: "));
}

TEST(PlugIns, TracersHaveToLightEverySiteHoweverTheyAreUsed) {
  const auto too_few = [](SampleSet& samples) { samples.variance.resize(3); };
  const auto in_parts = [](BakeSettings settings, const Stages& stages) {
    settings.sampler = settings.resampler = {};
    settings.samples = 0;
    (void)bake(read_volume("gen:gyroid:9"), {}, settings, stages, {});
  };
  const auto by_need = [](BakeSettings settings, const Stages& stages) {
    settings.texel_sites = TexelSites::kNeeded;
    (void)bake(read_volume("gen:gyroid:9"), {}, settings, stages, {});
  };
  const auto at_points = [](const BakeSettings& settings, const Stages& stages) {
    const std::vector<Vec3f> points{Vec3f(0.3f), Vec3f(0.4f), Vec3f(0.5f), Vec3f(0.6f)};
    (void)light_points(read_volume("gen:gyroid:9"), {}, points, settings.trace, settings.tracer, stages, {});
  };
  for (const std::function<void(const BakeSettings&, const Stages&)>& light :
       std::vector<std::function<void(const BakeSettings&, const Stages&)>>{in_parts, by_need, at_points}) {
    EXPECT_EQ(error_of<SampleSet>([](SampleSet&) {}, light), "");
    EXPECT_THAT(error_of<SampleSet>(too_few, light), HasSubstr("tracer mine: "));
  }
}

TEST(PlugIns, ResamplersHaveToGiveWhatTheyAreAskedFor) {
  const auto error = [](std::function<void(ResampledGrid&)> spoil) {
    return error_of<ResampledGrid>(std::move(spoil));
  };
  EXPECT_THAT(
      error([](ResampledGrid& r) {
        r = {.grid = IlluminationGrid({.size = {2, 2, 2}, .frame = {}}, 1), .lit = std::vector<std::uint8_t>(8, 1)};
      }),
      HasSubstr("resampler mine: it gave 2x2x2 texels and was asked for 8x8x8"));
  EXPECT_THAT(error([](ResampledGrid& r) { r.grid.lattice.frame.origin.x += 1.0; }), HasSubstr("lie elsewhere"));
  EXPECT_THAT(error([](ResampledGrid& r) {
                r.grid.channels = 3;
                r.grid.values.resize(3 * r.lit.size());
              }),
              HasSubstr("3 channels"));
  EXPECT_THAT(error([](ResampledGrid& r) { r.lit.pop_back(); }), HasSubstr("511 flags"));
  EXPECT_THAT(error([](ResampledGrid& r) { r.grid.detail.slopes.resize(3); }), HasSubstr("3 slopes"));
  EXPECT_THAT(error([](ResampledGrid& r) { r.grid.detail.normal_slopes[1].resize(3); }), HasSubstr("of the normal"));
  EXPECT_THAT(error([](ResampledGrid& r) {
                r.lit[7] = 1;
                r.grid.values[7] = std::nanf("");
              }),
              HasSubstr("texel 7 is lit and holds nan"));
}

}  // namespace
}  // namespace isolux::test
