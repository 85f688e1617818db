#include <isolux/bake.h>
#include <isolux/core/error.h>
#include <isolux/volume_io.h>

#include <cstdio>
#include <utility>

// Lights all level sets of a volume at once: light_a_volume [VOLUME [LIGHT.nrrd]]
int main(int argc, char** argv) try {
  const isolux::Volume volume = isolux::read_volume(argc > 1 ? argv[1] : "gen:two-spheres:16");
  const isolux::Scene scene;  // a white sky and albedo 0.8; read_scene() reads others
  const isolux::Stages stages = isolux::builtin_stages();
  const isolux::BakeSettings settings;  // 64 rays for each texel and all their reflections
  const isolux::Run run;                // all threads, seed 1
  isolux::BakeResult result = bake(volume, scene, settings, stages, run);
  const isolux::LightReader reader(volume, result.light);
  const isolux::Vec3 middle = 0.5 * isolux::Vec3(volume.lattice().size - 1);
  std::printf("%zu sites, error about %.3f, light in the middle %.3f\n", result.sites, result.rmse_estimate,
              double(reader.at_index(middle).x));
  if (argc > 2) write_light(make_light_file(std::move(result), volume, scene, run), argv[2], volume.space, {});
} catch (const isolux::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
