#include <isolux/core/error.h>
#include <isolux/core/volume.h>
#include <isolux/render.h>

#include <cstdio>
#include <glm/geometric.hpp>

// Draws a ball under a sky: draw_a_ball [IMAGE.png]
int main(int argc, char** argv) try {
  isolux::Volume volume;
  volume.values = isolux::Grid<float>(isolux::Lattice{.size = {32, 32, 32}, .frame = {}});
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i)
        volume.values(i, j, k) = -float(glm::distance(isolux::Vec3(i, j, k), isolux::Vec3(15.5)));

  const isolux::Camera camera = isolux::orbit_camera(volume.lattice(), 30.0, 20.0, 4.0 / 3.0);
  const isolux::RenderSettings settings{.width = 160, .height = 120, .isovalue = -10.0f};
  const isolux::LightAt sky =
      [](const isolux::SurfacePoint& point) {  // a baked light: LightReader::at_index(point.index)
        return isolux::Vec3f(0.5f + 0.5f * float(point.normal.z));
      };
  const isolux::Image image = render(volume, camera, settings, isolux::global_shader(sky, {}), {});
  std::printf("the middle shows %.3f\n", double(image.at(80, 60).x));
  if (argc > 1) write_png(image, argv[1]);
} catch (const isolux::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
