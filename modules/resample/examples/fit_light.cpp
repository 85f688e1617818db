// Light known at scattered points of a ball's level sets becomes a texture, and is read back at a point of one of them.
#include <isolux/core.h>
#include <isolux/resample.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

int main() {
  isolux::Volume volume;
  volume.values = isolux::Grid<float>(isolux::Lattice{.size = {16, 16, 16}, .frame = {}});
  isolux::SampleSet samples;
  const isolux::Vec3 centre(7.5);
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 16; ++i) volume.values(i, j, k) = -float(glm::length(isolux::Vec3(i, j, k) - centre));

  const isolux::TrilinearField field(volume);
  for (int s = 0; s < 20000; ++s) {
    isolux::RandomStream random(1, std::uint64_t(s));
    isolux::Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = 15.0 * random.uniform_double();
    const auto gradient = isolux::GradientKind::kCentralDifferences;
    const isolux::Vec3 normal = field.normal(p, isolux::OuterSide::kLower, gradient);
    samples.sites.positions.emplace_back(p);
    samples.sites.isovalues.push_back(float(field.value(p)));
    samples.sites.normals.emplace_back(normal);
    samples.radiance.push_back(0.5f + 0.5f * float(normal.z));  // a sky over a black ground
    samples.variance.push_back(0.0f);
  }

  const auto resampler = isolux::resamplers().create("fit");
  const isolux::Lattice texels = isolux::cell_lattice(volume.lattice());
  const isolux::IlluminationGrid light = fill_unlit(resampler->resample(volume, samples, texels, {}), {});
  const isolux::LightReader reader(volume, light);
  const double top = double(reader.at_index({7.5, 7.5, 12.0}).x);
  std::printf("light on top of a ball: %.3f (it is 1)\n", top);
  return std::fabs(top - 1.0) < 0.05 ? 0 : 1;
}
