#pragma once

#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/mc_extract/iso_mesh.h>
#include <isolux/raytrace_flat/gather.h>

#include <cstddef>
#include <vector>

#include "peer_embree.h"

namespace isolux::bench {

/// e without bounces under a uniform environment of radiance 1 at `count` vertices of a mesh, by `rays` cosine rays
/// each against the mesh itself: what lighting surfaces one by one does. What Embree is asked changes only the time
/// that it takes. Where these are not all, they are runs of 16
/// from all over the mesh. Rays start a small part of the mesh's size along the normal and along themselves, as usual
/// with triangles.
[[nodiscard]] std::vector<float> light_vertices(const EmbreeMesh& embree, EmbreeCall call, RayQuestion question,
                                                const IsoMesh& mesh, std::size_t count, int rays, const Run& run);

}  // namespace isolux::bench
