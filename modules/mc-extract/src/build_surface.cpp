#include <isolux/core/parallel.h>

#include <algorithm>

#include "cap_box.h"
#include "surface_builder.h"

namespace isolux::mc {

namespace {

/// Slabs of a block: few enough to keep threads busy, many enough for the planes that two blocks make to be few.
constexpr int kSlabs = 16;

SurfaceBlock build_block(const VolumeView& volume, const ExtractSettings& settings, SlabRange slabs, const Run& run,
                         const AddCell& add_cell) {
  SurfaceBuilder surface(volume, settings, slabs);
  const Index3 cells = volume.lattice().size - 1;
  for (int k = slabs.first; k < slabs.last; ++k) {
    throw_if_stopped(run);
    surface.begin_slab(k);
    for (int j = 0; j < cells.y; ++j) {
      for (int i = 0; i < cells.x; ++i) {
        const int inside = surface.inside_corners({i, j, k});
        if (inside != 0 && inside != 255) add_cell(surface, {i, j, k}, inside);
      }
    }
  }
  SurfaceBlock block = surface.take();
  std::ranges::sort(block.bottom, {}, &SharedVertex::edge);
  std::ranges::sort(block.top, {}, &SharedVertex::edge);
  return block;
}

/// The vertices of a block by their numbers in the whole mesh. Those on its first plane are the last block's: both
/// blocks have met every crossed edge of the plane between them.
std::vector<std::uint32_t> number_vertices(const SurfaceBlock& block, std::uint32_t next,
                                           const std::vector<std::uint32_t>& top_below) {
  constexpr std::uint32_t kOwn = 0xffffffff;
  std::vector<std::uint32_t> numbers(block.mesh.positions.size(), kOwn);
  for (std::size_t v = 0; v < top_below.size(); ++v) numbers[block.bottom[v].id] = top_below[v];
  for (std::uint32_t& number : numbers)
    if (number == kOwn) number = next++;
  return numbers;
}

}  // namespace

IndexedMesh build_surface(const VolumeView& volume, const ExtractSettings& settings, const Run& run,
                          const AddCell& add_cell) {
  require_plane(volume.lattice().size);
  const int slabs = volume.lattice().size.z - 1;
  std::vector<SurfaceBlock> blocks(block_count(std::size_t(slabs), kSlabs));
  parallel_blocks(std::size_t(slabs), kSlabs, run, "extract", [&](const Block& block) {
    blocks[block.index] = build_block(volume, settings, {int(block.begin), int(block.end)}, run, add_cell);
  });
  IndexedMesh mesh;
  std::vector<std::uint32_t> top_below;
  for (SurfaceBlock& block : blocks) {
    const auto next = std::uint32_t(mesh.positions.size());
    const std::vector<std::uint32_t> numbers = number_vertices(block, next, top_below);
    for (std::size_t v = 0; v < numbers.size(); ++v) {
      if (numbers[v] < next) continue;
      mesh.positions.push_back(block.mesh.positions[v]);
      mesh.normals.push_back(block.mesh.normals[v]);
    }
    for (const Triangle& t : block.mesh.triangles)
      mesh.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
    top_below.clear();
    for (const SharedVertex& v : block.top) top_below.push_back(numbers[v.id]);
    block = {};
  }
  finish_mesh(mesh, volume, settings, run);
  return mesh;
}

}  // namespace isolux::mc
