#include "mesh_light.h"

#include <isolux/core/parallel.h>
#include <isolux/core/random.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace isolux::bench {
namespace {

/// A direction about n with density cos/pi (Malley's method; frame by Duff et al. 2017).
Vec3f cosine_direction(const Vec3f& n, RandomStream& random) {
  const float radius = std::sqrt(random.uniform_float());
  const float angle = 2.0f * std::numbers::pi_v<float> * random.uniform_float();
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z);
  const float b = n.x * n.y * a;
  const Vec3f u(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  const Vec3f v(b, sign + n.y * n.y * a, -n.y);
  const float up = std::sqrt(std::fmax(0.0f, 1.0f - radius * radius));
  return radius * std::cos(angle) * u + radius * std::sin(angle) * v + up * n;
}

}  // namespace

std::vector<float> light_vertices(const EmbreeMesh& embree, EmbreeCall call, RayQuestion question, const IsoMesh& mesh,
                                  std::size_t count, int rays, const Run& run) {
  float size = 0.0f;
  for (const auto vertex : mesh.vertices()) {
    for (int a = 0; a < 3; ++a) size = std::max(size, std::fabs(mesh.point(vertex)[unsigned(a)]));
  }
  const float offset = 1e-5f * size;
  std::vector<float> light(count);
  constexpr std::size_t kRun = 16;
  const std::size_t left_out = (mesh.n_vertices() - count) / std::max<std::size_t>(block_count(count, kRun), 1);
  parallel_blocks(count, kRun, run, {}, [&](const Block& block) {
    const auto n = std::size_t(rays);
    std::vector<Vec3f> origins(n);
    std::vector<Vec3f> directions(n);
    std::vector<std::uint8_t> hits(n);
    std::vector<float> distances(n);
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const auto vertex = mesh.vertex_handle(unsigned(i + block.index * left_out));
      const auto& p = mesh.point(vertex);
      const auto& m = mesh.normal(vertex);
      const Vec3f normal(m[0], m[1], m[2]);
      RandomStream random(run.seed, i);
      for (std::size_t r = 0; r < n; ++r) {
        directions[r] = cosine_direction(normal, random);
        origins[r] = Vec3f(p[0], p[1], p[2]) + offset * normal;
      }
      std::ptrdiff_t open = 0;
      if (question == RayQuestion::kAnyHit) {
        embree.occluded(call, origins, directions, offset, hits);
        open = std::count(hits.begin(), hits.end(), std::uint8_t(0));
      } else {
        embree.first_hits(call, origins, directions, offset, distances);
        open = std::count(distances.begin(), distances.end(), std::numeric_limits<float>::infinity());
      }
      light[i] = float(open) / float(rays);
    }
  });
  return light;
}

}  // namespace isolux::bench
