#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace isolux {

using Vec3 = glm::dvec3;    ///< positions and directions in computations
using Vec3f = glm::vec3;    ///< positions and directions in storage
using Mat3 = glm::dmat3;    ///< column major: m[axis] is the image of the axis
using Index3 = glm::ivec3;  ///< grid indices and sizes, x fastest in memory

}  // namespace isolux
