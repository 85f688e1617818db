// Light of known isovalues at texels: what their level sets read is what a bake of all gives.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io/read.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace isolux::test {
namespace {

constexpr int kRangeSize = 20;

/// A steep torus: a cell's values span a good part of the range, so that hardly any texel's own value lies in a narrow
/// one.
Volume steep_volume() {
  Volume volume = read_volume("gen:torus:20");
  for (float& value : volume.values.values()) value = std::tanh(12.0f * (value + 0.12f));
  return volume;
}

BakeSettings straight_light(std::optional<ValueRange> isovalues) {
  BakeSettings settings;
  settings.trace = {.rays = 64, .bounces = 0};
  settings.isovalues = isovalues;
  settings.resampler.settings = {{"near_field", "false"}};  // its weights are those of the texels that there are
  return settings;
}

class IsoRange : public ::testing::TestWithParam<std::optional<Index3>> {};

TEST_P(IsoRange, ReadsWhatABakeOfAllLevelSetsGives) {
  const Volume volume = steep_volume();
  const TrilinearField field(volume);
  BakeSettings all = straight_light({});
  BakeSettings some = straight_light(ValueRange{0.1f, 0.1f});
  all.texels = some.texels = GetParam();
  // Interleaved nets are of the sites that there are: where paths are drawn alike light is the same to the bit.
  all.tracer.name = some.tracer.name = "scalar";
  const BakeResult whole = bake(volume, {}, all, builtin_stages(), isolux::Run{});
  const BakeResult range = bake(volume, {}, some, builtin_stages(), isolux::Run{});
  EXPECT_LT(range.sites, whole.sites);
  EXPECT_EQ(range.sites + range.skipped.at("sites_outside_iso_range") + range.skipped.at("sites_flat"),
            range.light.lattice.count());
  // Places of the level set along the grid's edges and diagonals.
  int found = 0;
  double squares = 0.0;
  for (int k = 0; k + 1 < kRangeSize; ++k)
    for (int j = 0; j + 1 < kRangeSize; ++j)
      for (int i = 0; i + 1 < kRangeSize; ++i)
        for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)}) {
          double low = 0.0;
          double high = 1.0;
          const auto value = [&](double t) { return field.value(Vec3(i, j, k) + t * way) - 0.1; };
          if (value(low) * value(high) > 0.0) continue;
          for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (low + high);
            (value(low) * value(middle) > 0.0 ? low : high) = middle;
          }
          const Vec3 world = volume.lattice().frame.world(Vec3(i, j, k) + low * way);
          squares += std::pow(double(whole.light.at_world(world).x - range.light.at_world(world).x), 2.0);
          ++found;
        }
  ASSERT_GT(found, 500);
  // Random numbers are keyed by a site's place in the list: the two are as far apart as 64 rays are noisy.
  EXPECT_LT(std::sqrt(squares / found), 0.06);
}

INSTANTIATE_TEST_SUITE_P(Texels, IsoRange,
                         ::testing::Values(std::nullopt, Index3(13, 19, 31), Index3(9, 9, 9), Index3(4, 10, 30)));

TEST(IsoRangeByNeed, LightsTheTexelsThatAreRead) {
  const Volume volume = steep_volume();
  BakeSettings settings = straight_light(ValueRange{0.1f, 0.1f});
  settings.resampler.settings = {};
  settings.target_rmse = 0.05;
  settings.texel_sites = TexelSites::kNeeded;
  const BakeResult result = bake(volume, {}, settings, builtin_stages(), isolux::Run{});
  const BakeResult each = bake(volume, {}, straight_light(ValueRange{0.1f, 0.1f}), builtin_stages(), isolux::Run{});
  // Within a cell whose corners can be lit texels that nothing reads are predicted with the others.
  EXPECT_LE(result.unlit_texels, each.unlit_texels);
  EXPECT_GT(result.unlit_texels, each.unlit_texels - 50);
  EXPECT_GT(each.unlit_texels, 1000u);
}

}  // namespace
}  // namespace isolux::test
