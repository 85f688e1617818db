#include "surface_builder.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>

#include "cap_box.h"

namespace isolux::mc {

namespace {
constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();
}

void require_plane(const Index3& size) {
  if (std::size_t(size.x) * std::size_t(size.y) <= std::size_t(1) << 29) return;
  throw InvalidInput(
      fmt::format("a volume of {}x{}x{} grid points: marching takes at most 2^29 a plane", size.x, size.y, size.z));
}

SurfaceBuilder::SurfaceBuilder(const VolumeView& volume, const ExtractSettings& settings, SlabRange slabs)
    : slabs_(slabs),
      volume_(volume),
      field_(field_of(volume)),
      lattice_(volume.lattice()),
      level_set_(lattice_, settings),
      gradient_to_world_(lattice_.frame.gradient_to_world()) {
  const std::size_t points = std::size_t(lattice_.size.x) * lattice_.size.y;
  for (auto& plane : edge_vertices_) plane.assign(points * 8, kNoVertex);
  for (auto& plane : inside_) plane.resize(points);
  classify_plane(slabs.first);
}

SurfaceBuilder::Field SurfaceBuilder::field_of(const VolumeView& volume) {
  return std::visit(
      [&]<class Value>(std::span<const Value> values) -> Field {
        return TrilinearFieldOf<Value>(volume.lattice(), values);
      },
      volume.voxels());
}

void SurfaceBuilder::classify_plane(int k) {
  std::vector<std::uint8_t>& inside = inside_[k & 1];
  std::visit(
      [&](const auto& values) {
        const auto plane = values.subspan(std::size_t(k) * inside.size(), inside.size());
        std::ranges::transform(plane, inside.begin(),
                               [&](auto value) { return std::uint8_t(level_set_.inside(float(value))); });
      },
      volume_.voxels());
}

void SurfaceBuilder::begin_slab(int k) {
  std::ranges::fill(edge_vertices_[(k + 1) & 1], kNoVertex);
  classify_plane(k + 1);
}

int SurfaceBuilder::inside_corners(const Index3& cell) const {
  const std::size_t row = std::size_t(lattice_.size.x);
  const std::size_t point = std::size_t(cell.y) * row + std::size_t(cell.x);
  int inside = 0;
  for (int z = 0; z < 2; ++z) {
    const std::uint8_t* plane = inside_[(cell.z + z) & 1].data() + point;
    inside |= (plane[0] | plane[1] << 1 | plane[row] << 2 | plane[row + 1] << 3) << (4 * z);
  }
  return inside;
}

std::uint32_t SurfaceBuilder::edge_vertex(const Index3& low, int direction) {
  const std::size_t point = std::size_t(low.y) * lattice_.size.x + low.x;
  std::uint32_t& id = edge_vertices_[low.z & 1][point * 8 + direction];
  if (id != kNoVertex) return id;
  const Index3 step(direction & 1, direction >> 1 & 1, direction >> 2);
  const float a = value(low);
  const float b = value(low + step);
  // Where the field has no gradient the edge itself still tells which way is up.
  const bool rises = level_set_.inside(b) == (level_set_.outer == OuterSide::kLower);
  const Vec3 uphill = Vec3(step) * (rises ? 1.0 : -1.0);
  id = push(Vec3(low) + double(level_set_.fraction(a, b, direction)) * Vec3(step), uphill);
  if (step.z == 0 && low.z == slabs_.first) block_.bottom.push_back({point * 8 + std::size_t(direction), id});
  if (step.z == 0 && low.z == slabs_.last) block_.top.push_back({point * 8 + std::size_t(direction), id});
  return id;
}

std::uint32_t SurfaceBuilder::add_vertex(const Vec3& index) {
  return push(index, std::visit([&](const auto& field) { return field.cell_gradient(index); }, field_));
}

std::uint32_t SurfaceBuilder::push(const Vec3& index, const Vec3& uphill) {
  Vec3 normal = std::visit(
      [&](const auto& field) { return field.normal(index, level_set_.outer, GradientKind::kCentralDifferences); },
      field_);
  const double length = glm::dot(normal, normal);
  if (!(length > 0.5)) {
    const Vec3 outwards = gradient_to_world_ * uphill * (level_set_.outer == OuterSide::kLower ? -1.0 : 1.0);
    const double size = glm::length(outwards);
    normal = size > 0.0 && size < std::numeric_limits<double>::infinity() ? outwards / size : Vec3(0.0, 0.0, 1.0);
  }
  block_.mesh.positions.emplace_back(lattice_.frame.world(index));
  block_.mesh.normals.emplace_back(normal);
  return std::uint32_t(block_.mesh.positions.size() - 1);
}

void SurfaceBuilder::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (level_set_.mirrored) std::swap(b, c);
  block_.mesh.triangles.push_back({a, b, c});
}

}  // namespace isolux::mc
