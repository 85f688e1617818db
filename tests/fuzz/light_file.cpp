// Light files as render, probe and extract read them, over a volume that they need not be of.
#include <isolux/bake/light_metadata.h>
#include <isolux/resample/light_reader.h>
#include <isolux/volume_io.h>

#include <cmath>
#include <optional>

#include "fuzz.h"
#include "support.h"

namespace {

using namespace isolux;

void check_readings(const Volume& volume, const IlluminationGrid& light) {
  fuzz::require(!fuzz::refused([&] { require_complete(light); }), "a light that is read is complete");
  for (const TexelStorage storage : {TexelStorage::kDense, TexelStorage::kBricks, TexelStorage::kLent}) {
    const bool refused = fuzz::refused([&] {
      const LightReader reader(volume, light, storage, fuzz::alone());
      for (const Vec3& place : {Vec3(0.0), Vec3(1.3, 0.2, 2.9), Vec3(3.0), Vec3(-5.0, 1.5, 1e9)}) {
        const Vec3f e = reader.at_index(place);
        for (int c = 0; c < 3; ++c) {
          const bool is_number = !std::isnan(e[c]) && e[c] <= light.detail.ceiling;
          fuzz::require(is_number || light.detail.empty(), "light is a number below its ceiling");
        }
      }
    });
    if (refused) return;
  }
}

void check_copy(const LightFile& light, const std::string& path) {
  if (fuzz::refused([&] { write_light(light, path, "left-posterior-superior"); })) return;
  LightFile again;
  fuzz::require(!fuzz::refused([&] { again = read_light(path); }), "a light that is written can be read");
  fuzz::require(again.grid.values.size() == light.grid.values.size() && again.grid.channels == light.grid.channels &&
                    again.inner.has_value() == light.inner.has_value() &&
                    again.grid.detail.numbers() == light.grid.detail.numbers(),
                "a light that is written is what was read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::TemporaryFolder folder;
  static const Volume volume = sample_analytic_field("gyroid", 4);
  const std::string path = folder.write("light.nrrd", fuzz::text_of(data, size));
  LightFile light;
  if (fuzz::refused([&] { light = read_light(path); })) return 0;
  fuzz::require(light.grid.values.size() <= size * 1032, "light is from the file");
  (void)fuzz::refused([&] { require_light_of(light, volume, path); });
  (void)fuzz::refused([&] { (void)surface_colour(light, 0.5f); });
  (void)fuzz::refused([&] { (void)light_bounces(light); });
  (void)fuzz::refused([&] { (void)side_towards(light, OuterSide::kHigher); });
  (void)fuzz::refused([&] {
    if (const auto scene = light_scene(light)) require_valid(*scene);
  });
  check_readings(volume, light.grid);
  if (light.inner) check_readings(volume, *light.inner);
  check_copy(light, folder.file("copy.nrrd"));
  return 0;
}
