#include "row_march.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace isolux::mc {

namespace {

/// Slabs a task takes: a layer of bricks.
constexpr std::size_t kBlock = BrickIndex::kHeight;

VertexFrame vertex_frame(const Lattice& lattice, const LevelSet& level_set) {
  VertexFrame frame{};
  Mat3 to_normal = lattice.frame.gradient_to_world();
  double largest = 0.0;
  for (int a = 0; a < 3; ++a)
    for (int w = 0; w < 3; ++w) largest = std::max(largest, std::fabs(to_normal[a][w]));
  // Only directions matter; of about one, squares stay in a float's range.
  to_normal *= 1.0 / largest;
  const double sign = level_set.outer == OuterSide::kLower ? -1.0 : 1.0;
  for (int w = 0; w < 3; ++w) {
    frame.origin[w] = float(lattice.frame.origin[w]);
    for (int a = 0; a < 3; ++a) {
      frame.axes[a][w] = float(lattice.frame.axes[a][w]);
      frame.outwards[a][w] = float(sign * to_normal[a][w]);
      frame.along_edge[a][w] = float(glm::normalize(to_normal[a])[w]);
    }
  }
  frame.margin = level_set.margin;
  return frame;
}

}  // namespace

RowMarch::RowMarch(const Volume& volume) : lattice_(volume.lattice()), slabs_(std::size_t(lattice_.size.z)) {
  const Index3 size = lattice_.size;
  if (std::max(size.x, size.y) > 65536 || std::size_t(size.x) * std::size_t(size.y) > std::size_t(1) << 29)
    throw InvalidInput(
        fmt::format("a volume of {}x{}x{} grid points: marching cubes takes at most 65536 along x and y and "
                    "2^29 a plane",
                    size.x, size.y, size.z));
  march_.values = volume.values.values().data();
  march_.nx = size.x;
  march_.ny = size.y;
  march_.nz = size.z;
  march_.words = (size.x + 63) / 64;
  const std::size_t rows = std::size_t(size.y) * std::size_t(size.z);
  bits_.resize(rows * std::size_t(march_.words));
  active_.resize(rows * std::size_t(march_.words));
  rows_.resize(rows);
  march_.bits = bits_.data();
  march_.rows = rows_.data();
  march_.active = active_.data();
  march_.slabs = slabs_.data();
}

MeshSize RowMarch::count(const ExtractSettings& settings, const Run& run, const BrickIndex* index,
                         Connectivity connectivity) {
  const LevelSet level_set(lattice_, settings);
  march_.isovalue = settings.isovalue;
  march_.outer = settings.outer;
  frame_ = vertex_frame(lattice_, level_set);
  mirrored_ = level_set.mirrored;
  if (index != nullptr)
    classify_active(settings, run, *index);
  else
    classify_all(run);
  count_active(run, index, connectivity);
  return number_slabs();
}

void RowMarch::classify_all(const Run& run) {
  parallel_blocks(std::size_t(march_.nz), kBlock, run, "", [&](const Block& block) {
    for (int k = int(block.begin); k < int(block.end); ++k)
      for (int j = 0; j < march_.ny; ++j) classify_row(march_, j, k);
  });
}

void RowMarch::classify_active(const ExtractSettings& settings, const Run& run, const BrickIndex& index) {
  brick_rows_ = index.rows();
  const std::size_t words = std::size_t(march_.words);
  activity_.resize(std::size_t(index.layers()) * std::size_t(index.rows()) * words);
  parallel_blocks(std::size_t(index.layers()), 8, run, "", [&](const Block& block) {
    for (int layer = int(block.begin); layer < int(block.end); ++layer)
      for (int row = 0; row < index.rows(); ++row)
        index.find_active(settings, row, layer, march_.words,
                          &activity_[(std::size_t(layer) * std::size_t(index.rows()) + std::size_t(row)) * words]);
  });
  parallel_blocks(std::size_t(index.layers()), 1, run, "", [&](const Block& block) {
    for (int row = 0; row < index.rows(); ++row) classify_brick_row(settings, index, row, int(block.begin));
  });
}

std::uint8_t RowMarch::activity(int word, int row, int layer) const {
  if (word < 0 || row < 0 || layer < 0) return 0;
  return activity_[(std::size_t(layer) * std::size_t(brick_rows_) + std::size_t(row)) * std::size_t(march_.words) +
                   std::size_t(word)];
}

void RowMarch::classify_brick_row(const ExtractSettings& settings, const BrickIndex& index, int row, int layer) {
  constexpr int kHeight = BrickIndex::kHeight;
  const BrickRows rows{.first_row = row * kHeight,
                       .last_row = std::min((row + 1) * kHeight, march_.ny),
                       .first_plane = layer * kHeight,
                       .last_plane = std::min((layer + 1) * kHeight, march_.nz)};
  for (int word = 0; word < march_.words; ++word) {
    // A word's cells reach to the first grid points of its upper neighbours.
    int reached = 0;
    for (int n = 0; n < 4; ++n) {
      reached |= activity(word, row - (n & 1), layer - (n >> 1));
      reached |= activity(word - 1, row - (n & 1), layer - (n >> 1));
    }
    if (reached == 0) continue;
    const int own = activity(word, row, layer);
    const int first_brick = word * BrickIndex::kBricksPerWord;
    const int bricks = std::min(BrickIndex::kBricksPerWord, index.bricks_in_row() - first_brick);
    std::uint64_t uniform = 0;
    for (int b = 0; b < bricks; ++b)
      if ((own >> b & 1) == 0 && index.inside(settings, first_brick + b, row, layer))
        uniform |= ((std::uint64_t(1) << BrickIndex::kWidth) - 1) << (BrickIndex::kWidth * b);
    const int valid = march_.nx - 64 * word;
    if (valid < 64) uniform &= (std::uint64_t(1) << valid) - 1;
    classify_bricks(march_, rows, word, unsigned(own), uniform);
  }
}

void RowMarch::count_active(const Run& run, const BrickIndex* index, Connectivity connectivity) {
  parallel_blocks(std::size_t(march_.nz), kBlock, run, "", [&](const Block& block) {
    std::vector<std::uint32_t> candidates;
    if (index != nullptr) {
      const int layer = int(block.begin / kBlock);
      for (int j = 0; j < march_.ny; ++j)
        for (int word = 0; word < march_.words; ++word)
          if (activity(word, j / BrickIndex::kHeight, layer) != 0) candidates.push_back(pack_word(j, word));
      candidates.push_back(0);  // so that data() is something even where nothing is a candidate
    }
    for (int k = int(block.begin); k < int(block.end); ++k) {
      if (index != nullptr)
        count_slab(march_, k, candidates.data(), candidates.size() - 1, connectivity);
      else
        count_slab(march_, k, nullptr, 0, connectivity);
    }
  });
}

MeshSize RowMarch::number_slabs() {
  MeshSize size;
  for (Slab& slab : slabs_) {
    const Counts& total = slab.total;
    slab.first.vertex_x = std::uint32_t(size.vertices);
    slab.first.vertex_y = slab.first.vertex_x + total.vertex_x;
    slab.first.vertex_z = slab.first.vertex_y + total.vertex_y;
    size.vertices += std::size_t(total.vertex_x) + total.vertex_y + total.vertex_z;
    slab.first.face_x = std::uint32_t(size.edges);
    slab.first.face_y = slab.first.face_x + total.face_x;
    slab.first.face_z = slab.first.face_y + total.face_y;
    slab.first.inner = slab.first.face_z + total.face_z;
    size.edges += std::size_t(total.face_x) + total.face_y + total.face_z + total.inner;
    slab.first.triangle = std::uint32_t(size.triangles);
    size.triangles += total.triangle;
  }
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (3 * size.triangles > kMost || 2 * size.edges > kMost)
    throw InvalidInput(
        fmt::format("the level set {} has {} triangles: a mesh is limited to 2^31 triangle corners and "
                    "half-edges",
                    march_.isovalue, size.triangles));
  return size;
}

void RowMarch::write_vertices(const Run& run, float* positions, float* normals) const {
  parallel_blocks(std::size_t(march_.nz), kBlock, run, "", [&](const Block& block) {
    for (int k = int(block.begin); k < int(block.end); ++k) make_vertices(march_, k, frame_, positions, normals);
  });
}

void RowMarch::write_triangles(const Run& run, Triangle* triangles) const {
  const CaseTable& cases = case_table(mirrored_ ? CaseTable::Winding::kInwards : CaseTable::Winding::kOutwards);
  parallel_blocks(std::size_t(march_.nz), kBlock, run, "", [&](const Block& block) {
    for (int k = int(block.begin); k < int(block.end); ++k) make_triangles(march_, k, cases, triangles);
  });
}

void RowMarch::write_half_edges(const Run& run, const HalfEdgeArrays& out) const {
  const CaseTable& cases = case_table(mirrored_ ? CaseTable::Winding::kInwards : CaseTable::Winding::kOutwards);
  parallel_blocks(std::size_t(march_.nz), kBlock, run, "", [&](const Block& block) {
    for (int k = int(block.begin); k < int(block.end); ++k) make_half_edges(march_, k, cases, out);
  });
  link_border(run, out);
}

}  // namespace isolux::mc
