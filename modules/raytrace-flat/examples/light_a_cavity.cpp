// Lights three places in a hollow sphere whose level sets are open where the box cuts them.
#include <isolux/raytrace_flat.h>

#include <cstdio>
#include <glm/geometric.hpp>

int main() {
  using namespace isolux;
  Volume volume;
  volume.values = Grid<float>({.size = Index3(65), .frame = {.origin = Vec3(-1.0), .axes = Mat3(1.0 / 32)}});
  for (int k = 0; k < 65; ++k)
    for (int j = 0; j < 65; ++j)
      for (int i = 0; i < 65; ++i) volume.values(i, j, k) = float(glm::length(volume.lattice().frame.world({i, j, k})));

  const TrilinearField field(volume);
  Sites sites;
  for (const float radius : {1.1f, 1.2f, 1.3f}) {
    const Vec3 place = volume.lattice().frame.index(Vec3(radius) / std::sqrt(3.0));
    sites.positions.emplace_back(place);
    sites.isovalues.push_back(float(field.value(Vec3(sites.positions.back()))));
    sites.normals.emplace_back(field.normal(place, OuterSide::kLower, GradientKind::kCentralDifferences));
  }
  Scene scene;  // a uniform white environment, outer side lower
  scene.albedo = {.keys = {{1.0f, Vec3f(0.8f)}}};
  const auto tracer = tracers().create("scalar", {{"roulette_depth", "5"}});
  const TraceResult lit = tracer->trace(volume, scene, sites, {.rays = 1024, .bounces = kAllBounces}, Run{});
  for (std::size_t i = 0; i < lit.samples.size(); ++i) {
    const double h = double(lit.samples.sites.isovalues[i]);
    const double open = 3.0 * (1.0 - 1.0 / h);  // the part of the sphere that the box cuts off
    std::printf("level set %.3f: e = %.4f, exactly %.4f\n", h, double(lit.samples.radiance[i]),
                open / (1.0 - 0.8 * (1.0 - open)));
  }
}
