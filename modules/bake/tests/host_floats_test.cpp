// Bakes inside programs whose floating-point numbers are not as at the start of a program.
#include <gtest/gtest.h>
#include <isolux/bake.h>
#include <isolux/volume_io/analytic_fields.h>

#include "hosts_floats.h"

namespace isolux {
namespace {

TEST(HostsFloats, ChangeNoBitOfALight) {
  const Volume volume = sample_analytic_field("gyroid", 10);
  for (const std::string resampler : {"direct", "fit", "cell_grid", "moving_least_squares"}) {
    for (const double rmse : {0.0, 0.15}) {
      if (rmse > 0.0 && resampler != "direct") continue;  // some try many numbers of rays
      BakeSettings settings;
      settings.resampler.name = resampler;
      settings.trace.rays = 8;
      settings.target_rmse = rmse;
      const auto baked = [&] { return bake(volume, Scene{}, settings, builtin_stages(), {.threads = 2}); };
      const BakeResult plain = baked();
      const BakeResult hosted = [&] {
        const test::HostsFloats hosts;
        return baked();
      }();
      EXPECT_EQ(hosted.light.values, plain.light.values) << resampler << " " << rmse;
      EXPECT_EQ(hosted.rmse_estimate, plain.rmse_estimate) << resampler << " " << rmse;
      // Reading is not guarded: it neither traps nor is off by more than the rounding that the host asks for.
      const LightReader reader(volume, plain.light);
      const Vec3f light = reader.at_index({3.25, 4.5, 5.75});
      const test::HostsFloats hosts;
      const Vec3f again = LightReader(volume, plain.light).at_index({3.25, 4.5, 5.75});
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(again[c], light[c], 1e-6) << resampler;
    }
  }
}

}  // namespace
}  // namespace isolux
