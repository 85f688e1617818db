#include "row_march.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "layer_pipeline.h"

namespace isolux::mc {

namespace {

/// Slabs of a layer of bricks.
constexpr int kLayer = BrickIndex::kHeight;

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
    frame.margin[w] = level_set.margin[w];
    for (int a = 0; a < 3; ++a) {
      frame.axes[a][w] = float(lattice.frame.axes[a][w]);
      frame.outwards[a][w] = float(sign * to_normal[a][w]);
      frame.along_edge[a][w] = float(glm::normalize(to_normal[a])[w]);
    }
  }
  return frame;
}

/// Makes room for `size` elements and keeps those there are. Of the whole work a part `done` has come, so memory for
/// the rest is reserved too; what is never touched costs nothing.
template <class T>
void grow(LargeVector<T>& vector, std::size_t size, double done) {
  if (vector.capacity() < size) {
    constexpr double kMost = 256.0;
    LargeVector<T> larger;
    larger.reserve(std::max(vector.capacity() * 3 / 2, std::size_t(double(size) * std::min(3.0 / done, kMost))));
    larger.resize(vector.size());
    std::copy(vector.begin(), vector.end(), larger.begin());
    vector.swap(larger);
  }
  vector.resize(size);
}

}  // namespace

void require_countable(const MeshSize& size, float isovalue) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (3 * size.triangles > kMost || 2 * size.edges > kMost)
    throw InvalidInput(
        fmt::format("the level set {} has {} triangles and more: a mesh is limited to 2^31 triangle corners and "
                    "half-edges",
                    isovalue, size.triangles));
}

RowMarch::RowMarch(const VolumeView& volume, double dense)
    : lattice_(volume.lattice()), dense_(dense), slabs_(std::size_t(lattice_.size.z)) {
  const Index3 size = lattice_.size;
  if (std::max(size.x, size.y) > 65536 || std::size_t(size.x) * std::size_t(size.y) > std::size_t(1) << 29)
    throw InvalidInput(
        fmt::format("a volume of {}x{}x{} grid points: marching cubes takes at most 65536 along x and y and "
                    "2^29 a plane",
                    size.x, size.y, size.z));
  march_.voxels = volume.voxels();
  march_.nx = size.x;
  march_.ny = size.y;
  march_.nz = size.z;
  march_.words = (size.x + 63) / 64;
  const std::size_t rows = std::size_t(size.y) * std::size_t(size.z);
  bits_.resize(rows * std::size_t(march_.words) + 1);
  bits_.back() = 0;
  active_.resize(rows * std::size_t(march_.words));
  rows_.resize(rows);
  march_.bits = bits_.data();
  march_.rows = rows_.data();
  march_.active = active_.data();
  march_.slabs = slabs_.data();
}

int RowMarch::layer_count() const { return (march_.nz + kLayer - 1) / kLayer; }

const CaseTable& RowMarch::cases() const {
  return case_table(mirrored_ ? CaseTable::Winding::kInwards : CaseTable::Winding::kOutwards);
}

RowMarch::Slabs RowMarch::slabs_of(int layer) const {
  return {.begin = layer * kLayer, .end = std::min((layer + 1) * kLayer, march_.nz)};
}

void RowMarch::march(const ExtractSettings& settings, const Run& run, const BrickIndex* index, IndexedMesh& mesh) {
  begin(settings, run, index);
  mesh.positions.clear();
  mesh.normals.clear();
  mesh.triangles.clear();
  int numbered = 0;
  const auto resize = [&] {
    const double done = double(numbered) / layer_count();
    grow(mesh.positions, size_.vertices, done);
    grow(mesh.normals, size_.vertices, done);
    grow(mesh.triangles, size_.triangles, done);
  };
  // Looked up only while nothing is written: the vectors themselves change with every layer.
  float* positions = nullptr;
  float* normals = nullptr;
  Triangle* triangles = nullptr;
  const auto locate = [&] {
    positions = reinterpret_cast<float*>(mesh.positions.data());
    normals = reinterpret_cast<float*>(mesh.normals.data());
    triangles = mesh.triangles.data();
  };
  locate();
  LayerPipeline pipeline(layer_count(),
                         {.classify = [&](int layer) { classify_layer(layer); },
                          .count = [&](int layer) { count_layer(layer, Connectivity::kIndexed); },
                          .number =
                              [&](int layer) {
                                number_layer(layer);
                                numbered = layer + 1;
                                if (size_.vertices > std::min(mesh.positions.capacity(), mesh.normals.capacity()) ||
                                    size_.triangles > mesh.triangles.capacity())
                                  return true;
                                resize();
                                return false;
                              },
                          .grow =
                              [&] {
                                resize();
                                locate();
                              },
                          .write = [&](int layer) { write_vertices(layer, positions, normals); },
                          .connect =
                              [&](int layer) {
                                const Slabs slabs = slabs_of(layer);
                                for (int k = slabs.begin; k < slabs.end; ++k)
                                  make_triangles(march_, k, cases(), triangles);
                              }});
  pipeline.run(run);
}

MeshSize RowMarch::count(const ExtractSettings& settings, const Run& run, const BrickIndex* index,
                         const VertexRoom& room) {
  begin(settings, run, index);
  const auto fits = [&](int layer) {
    const Slab& last = slabs_[std::size_t(slabs_of(layer).end) - 1];
    return std::size_t(last.first.vertex_z) + last.total.vertex_z <= room.vertices;
  };
  std::function<void(int)> write;
  if (room.vertices > 0)
    write = [&](int layer) {
      if (fits(layer)) write_vertices(layer, room.positions, room.normals);
    };
  LayerPipeline pipeline(layer_count(), {.classify = [&](int layer) { classify_layer(layer); },
                                         .count = [&](int layer) { count_layer(layer, Connectivity::kHalfEdges); },
                                         .number =
                                             [&](int layer) {
                                               number_layer(layer);
                                               return false;
                                             },
                                         .grow = {},
                                         .write = write,
                                         .connect = {}});
  pipeline.run(run);
  layers_with_vertices_ = 0;
  while (layers_with_vertices_ < layer_count() && fits(layers_with_vertices_)) ++layers_with_vertices_;
  return size_;
}

void RowMarch::begin(const ExtractSettings& settings, const Run& run, const BrickIndex* index) {
  const LevelSet level_set(lattice_, settings);
  settings_ = settings;
  march_.isovalue = settings.isovalue;
  march_.outer = settings.outer;
  frame_ = vertex_frame(lattice_, level_set);
  mirrored_ = level_set.mirrored;
  size_ = {};
  index_ = index;
  if (index == nullptr) return;
  active_words_.find(*index, settings, run, march_.words);
  if (active_words_.share() > dense_) index_ = nullptr;
}

void RowMarch::classify_layer(int layer) {
  if (index_ == nullptr) {
    const Slabs slabs = slabs_of(layer);
    for (int k = slabs.begin; k < slabs.end; ++k)
      for (int j = 0; j < march_.ny; ++j) classify_row(march_, j, k);
    return;
  }
  for (int row = 0; row < index_->rows(); ++row)
    if (active_words_.reaches_row(row, layer)) classify_brick_row(row, layer);
}

void RowMarch::classify_brick_row(int row, int layer) {
  const BrickRows rows{.first_row = row * kLayer,
                       .last_row = std::min((row + 1) * kLayer, march_.ny),
                       .first_plane = layer * kLayer,
                       .last_plane = std::min((layer + 1) * kLayer, march_.nz)};
  for (int word = 0; word < march_.words; ++word) {
    // A word's cells reach to the first grid points of its upper neighbours.
    int reached = 0;
    for (int n = 0; n < 4; ++n) {
      reached |= active_words_.own(word, row - (n & 1), layer - (n >> 1));
      reached |= active_words_.own(word - 1, row - (n & 1), layer - (n >> 1));
    }
    if (reached == 0) continue;
    const int own = active_words_.own(word, row, layer);
    const int first_brick = word * BrickIndex::kBricksPerWord;
    const int bricks = std::min(BrickIndex::kBricksPerWord, index_->bricks_in_row() - first_brick);
    std::uint64_t uniform = 0;
    for (int b = 0; b < bricks; ++b)
      if ((own >> b & 1) == 0 && index_->inside(settings_, first_brick + b, row, layer))
        uniform |= ((std::uint64_t(1) << BrickIndex::kWidth) - 1) << (BrickIndex::kWidth * b);
    const int valid = march_.nx - 64 * word;
    if (valid < 64) uniform &= (std::uint64_t(1) << valid) - 1;
    classify_bricks(march_, rows, word, unsigned(own), uniform);
  }
}

void RowMarch::count_layer(int layer, Connectivity connectivity) {
  const Slabs slabs = slabs_of(layer);
  if (index_ == nullptr) {
    for (int k = slabs.begin; k < slabs.end; ++k) count_slab(march_, k, nullptr, 0, connectivity);
    return;
  }
  std::vector<std::uint32_t> candidates;
  for (int row = 0; row < index_->rows(); ++row) {
    if (!active_words_.row_is_active(row, layer)) continue;
    for (int j = row * kLayer; j < std::min((row + 1) * kLayer, march_.ny); ++j)
      for (int word = 0; word < march_.words; ++word)
        if (active_words_.own(word, row, layer) != 0) candidates.push_back(pack_word(j, word));
  }
  candidates.push_back(0);  // so that data() is something even where nothing is a candidate
  for (int k = slabs.begin; k < slabs.end; ++k)
    count_slab(march_, k, candidates.data(), candidates.size() - 1, connectivity);
}

void RowMarch::number_layer(int layer) {
  const Slabs slabs = slabs_of(layer);
  for (int k = slabs.begin; k < slabs.end; ++k) {
    Slab& slab = slabs_[std::size_t(k)];
    const Counts& total = slab.total;
    slab.first.vertex_x = std::uint32_t(size_.vertices);
    slab.first.vertex_y = slab.first.vertex_x + total.vertex_x;
    slab.first.vertex_z = slab.first.vertex_y + total.vertex_y;
    size_.vertices += std::size_t(total.vertex_x) + total.vertex_y + total.vertex_z;
    slab.first.face_x = std::uint32_t(size_.edges);
    slab.first.face_y = slab.first.face_x + total.face_x;
    slab.first.face_z = slab.first.face_y + total.face_y;
    slab.first.inner = slab.first.face_z + total.face_z;
    size_.edges += std::size_t(total.face_x) + total.face_y + total.face_z + total.inner;
    slab.first.triangle = std::uint32_t(size_.triangles);
    size_.triangles += total.triangle;
  }
  require_countable(size_, march_.isovalue);
}

void RowMarch::write_vertices(int layer, float* positions, float* normals) const {
  const Slabs slabs = slabs_of(layer);
  for (int k = slabs.begin; k < slabs.end; ++k) make_vertices(march_, k, frame_, positions, normals);
}

}  // namespace isolux::mc
