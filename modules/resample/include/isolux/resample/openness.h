#pragma once

#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <vector>

namespace isolux {

/// How open the level sets are in front of their sites: one, two and four mean grid spacings along the outer normal, -1
/// (closed) to 1 (open), 0 where there is no gradient. The openness with which a texels' own light (TexelLight::kOwn)
/// is read between them. Sites need positions, isovalues and normals.
[[nodiscard]] std::vector<Vec3f> openness_before(const Volume& volume, const Sites& sites);

}  // namespace isolux
