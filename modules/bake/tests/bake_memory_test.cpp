// What a bake takes beside the volume and its light, counted where memory is asked for: every `new` of this program.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/core/sanitized.h>
#include <isolux/volume_io/read.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <optional>
#include <utility>

#if defined(__GLIBC__) && !defined(ISOLUX_SANITIZED)
#include <malloc.h>
#define ISOLUX_COUNTS_MEMORY 1

namespace {

std::atomic<std::size_t> bytes_held{0};
std::atomic<std::size_t> most_bytes{0};

}  // namespace

void* operator new(std::size_t size) {
  void* const memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t held = bytes_held += malloc_usable_size(memory);
  std::size_t most = most_bytes;
  while (held > most && !most_bytes.compare_exchange_weak(most, held)) {
  }
  return memory;
}

void operator delete(void* memory) noexcept {
  if (memory != nullptr) bytes_held -= malloc_usable_size(memory);
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
#endif

namespace isolux::test {
namespace {

#ifdef ISOLUX_COUNTS_MEMORY
TEST(BakeMemory, IsLittleBesideVolumeAndLightWherePartsAreLit) {
  const Volume volume = read_volume("gen:gyroid:96");
  BakeSettings settings;
  settings.trace = {.rays = 2, .bounces = 0};
  settings.isovalue_parts = 16;
  const std::size_t before = bytes_held;
  most_bytes = before;
  const BakeResult result = bake(volume, {}, settings, builtin_stages(), {.threads = 1});
  const double floats = 4.0 * double(volume.lattice().count());
  const double light = 4.0 * double(result.light.values.size());
  // Of the volume's floats, 3.5 MB: cell codes .13, words, leaps and inner cubes .1, a sixteenth of the sites with
  // their light .56, one thread's rays and other things of fixed size 1 MB: 1.09. A byte a cell and one a texel would
  // add .37.
  EXPECT_LT((double(most_bytes - before) - light) / floats, 1.2);
}

TEST(BakeMemory, OfAllBouncesIsThatOfLinksAndAFewFloatsATexel) {
  const Volume volume = read_volume("gen:gyroid:64");
  BakeSettings settings;
  settings.trace.rays = 16;
  const std::size_t before = bytes_held;
  most_bytes = before;
  const BakeResult result = bake(volume, {}, settings, builtin_stages(), {.threads = 1});
  const double texels = double(result.light.values.size());
  // While reflections are iterated seven floats and the isovalue, 32 bytes; while links are traced sites of 28 bytes
  // and 8 that tell ends; things of fixed size 1 MB: 38.2. The sites' places would add 24, two more iterates 8.
  EXPECT_LT((double(most_bytes - before) - double(result.link_bytes)) / texels, 42.0);
}
/// What a bake has at once over what is foreseen for it.
double had_over_foreseen(const Volume& volume, const Scene& scene, const BakeSettings& settings) {
  const Stages stages = builtin_stages();
  const double foreseen = memory_foreseen(volume, scene, settings, stages);
  const std::size_t before = bytes_held;
  most_bytes = before;
  const BakeResult result = bake(volume, scene, settings, stages, {.threads = 2});
  return double(most_bytes - before) / foreseen;
}

TEST(BakeMemory, IsForeseen) {
  const Volume volume = read_volume("gen:gyroid:64");
  Scene coloured;
  coloured.environment = SkyEnvironment{.up = {0, 0, 1}, .zenith = {1, 0.5, 0.2}, .horizon = {1, 1, 1}, .ground = {}};
  Scene sunny = coloured;
  sunny.lights.emplace_back(SunLight{.direction = {0, 0, 1}, .irradiance = {1, 1, 1}, .angular_diameter_deg = 1});
  Scene both = coloured;
  both.sides = LitSides::kBoth;
  BakeSettings settings;
  settings.trace.rays = 16;
  BakeSettings straight = settings;
  straight.trace.bounces = 0;
  BakeSettings paths = settings;
  paths.bounce_method = BounceMethod::kPaths;
  BakeSettings denoised = straight;
  denoised.resampler.settings = {{"denoise", "true"}};
  BakeSettings fit = straight;
  fit.trace.rays = 2;
  fit.resampler.name = "fit";
  BakeSettings scattered = straight;
  scattered.samples = 200000;
  BakeSettings towards = settings;
  towards.target_rmse = 0.05;
  BakeSettings need = settings;
  need.target_rmse = 0.05;
  need.texel_sites = TexelSites::kNeeded;
  struct Case {
    const char* name;
    const Scene& scene;
    const BakeSettings& settings;
  };
  const Scene grey;
  for (const Case& c :
       {Case{"grey", grey, settings}, Case{"coloured", coloured, settings}, Case{"sunny", sunny, settings},
        Case{"both sides", both, settings}, Case{"without bounces", coloured, straight}, Case{"paths", coloured, paths},
        Case{"denoised", grey, denoised}, Case{"denoised, sunny", sunny, denoised}, Case{"fit", grey, fit},
        Case{"scattered", coloured, scattered}, Case{"towards an error", grey, towards}, Case{"by need", grey, need}}) {
    const double ratio = had_over_foreseen(volume, c.scene, c.settings);
    EXPECT_GT(ratio, 0.6) << c.name;
    EXPECT_LT(ratio, 1.3) << c.name;
  }
}

TEST(BakeMemory, IsForeseenWhereFewLevelSetsAreAsked) {
  const Stages stages = builtin_stages();
  BakeSettings settings;
  settings.resampler.name = "fit";
  settings.trace.rays = 4;
  // Of a sphere next to no cell has a site: all is of texels.
  for (const auto& [name, isovalue] : {std::pair{"gen:gyroid:64", 0.0f}, std::pair{"gen:sphere:64", -0.2f}}) {
    const Volume volume = read_volume(name);
    settings.isovalues = std::nullopt;
    const double all = memory_foreseen(volume, {}, settings, stages);
    settings.isovalues = ValueRange{isovalue, isovalue};
    EXPECT_LT(memory_foreseen(volume, {}, settings, stages), 0.6 * all) << name;
    for (const int bounces : {0, kAllBounces}) {
      settings.trace.bounces = bounces;
      const double ratio = had_over_foreseen(volume, {}, settings);
      EXPECT_GT(ratio, 0.5) << name << ", bounces " << bounces;
      EXPECT_LT(ratio, 1.4) << name << ", bounces " << bounces;
    }
  }
}
#endif

}  // namespace
}  // namespace isolux::test
