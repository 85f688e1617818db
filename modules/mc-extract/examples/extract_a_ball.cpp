#include <isolux/mc_extract.h>

#include <cstdio>
#include <glm/geometric.hpp>

int main() {
  isolux::Volume volume;
  volume.values = isolux::Grid<float>({.size = {32, 32, 32}, .frame = {}});
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i)
        volume.values(i, j, k) = float(-glm::distance(isolux::Vec3(i, j, k), isolux::Vec3(15.5)));

  const auto extractor = isolux::extractors().create("marching_cubes");
  const isolux::IsoMesh mesh = extractor->extract(volume, {.isovalue = -10.0f}, {});
  const isolux::MeshMeasures measures = isolux::measure_mesh(mesh);
  std::printf("%zu triangles, volume %.1f, Euler number %d\n", mesh.n_faces(), measures.volume.value(),
              int(measures.euler_number));

  isolux::IsoExtractor sweep(volume);  // many isovalues: keeps its index, its buffers and the mesh's memory
  isolux::IndexedMesh drawn;
  for (float isovalue = -14.0f; isovalue < -2.0f; isovalue += 3.0f) {
    sweep.extract({.isovalue = isovalue}, {}, drawn);
    std::printf("%g: %zu triangles\n", double(isovalue), drawn.triangles.size());
  }
}
