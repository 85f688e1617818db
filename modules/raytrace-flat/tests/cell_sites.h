// Sites where a bake has them by default.
#pragma once

#include <isolux/core/field.h>
#include <isolux/core/lattice.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <vector>

namespace isolux::test {

/// Sites at the centres of a volume's cells; `texel` gets each one's place in the grid.
[[nodiscard]] inline Sites cell_sites(const Volume& volume, OuterSide outer, std::vector<std::size_t>& texel) {
  const Lattice texels = cell_lattice(volume.lattice());
  const TrilinearField field(volume);
  Sites sites;
  for (int k = 0; k < texels.size.z; ++k) {
    for (int j = 0; j < texels.size.y; ++j) {
      for (int i = 0; i < texels.size.x; ++i) {
        const Vec3 p(i + 0.5, j + 0.5, k + 0.5);
        const Vec3 normal = field.normal(p, outer, GradientKind::kCentralDifferences);
        if (normal == Vec3(0.0)) continue;
        sites.positions.emplace_back(p);
        sites.isovalues.push_back(float(field.value(p)));
        sites.normals.emplace_back(normal);
        texel.push_back(texels.offset(i, j, k));
      }
    }
  }
  return sites;
}

}  // namespace isolux::test
