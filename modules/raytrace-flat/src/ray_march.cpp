#include "ray_march.h"

#include <algorithm>
#include <cmath>

#include "box_entry.h"

namespace isolux {
namespace {

constexpr std::size_t kNoBrick = std::numeric_limits<std::size_t>::max();

// Below this part of the largest component a direction's component is zero: its inverse would not be finite.
constexpr double kSmallestComponent = 1e-290;

}  // namespace

/// A ray on its way. Positions and directions are in index space, the direction's largest component is 1.
struct RayMarch::Ray {
  double origin[3];
  double direction[3];
  double inverse[3];       ///< of the direction, infinite where that is zero
  double plane_origin[3];  ///< origin, or a place behind every plane where the direction is zero
  int forward[3];          ///< 1 towards higher indices, else 0
  int cell[3];
  bool on_plane[3] = {false, false, false};  ///< at t the ray enters its cell through the plane it moves away from
  double t = 0.0;
  double limit = kInfinity;
  double scale = 1.0;   ///< length of the caller's direction in ours
  double offset = 0.0;  ///< the caller's t at our t = 0
  double level = 0.0;
  double inner = 1.0;             ///< +1 if the side the ray must not enter has the higher values, else -1
  bool fresh = false;             ///< still at its start on the level set: the root there is known
  std::size_t brick = kNoBrick;   ///< of 4^3 cells, known to be worth entering
  std::size_t eighth = kNoBrick;  ///< of 2^3 cells, too
};

/// From the ray's place to the next plane: through a brick that cannot hold the level set, or through one cell.
struct RayMarch::Step {
  int shift;
  int plane[3];
  double plane_t[3];
  double t;
};

/// The part of a ray within one cell, in the cell's own coordinates.
struct RayMarch::Part {
  std::array<double, 3> enter;
  std::array<double, 3> leave;
  double length;  ///< in t
};

RayMarch::RayMarch(GridView<const float> values)
    : lattice_(values.lattice()),
      data_(values.values().data()),
      rounding_(0x1p-51 * std::max({lattice_.size.x, lattice_.size.y, lattice_.size.z})) {}

RayMarch::RayMarch(const Volume& volume) : RayMarch(volume.values.view()) { macrocells_.emplace(volume); }

bool RayMarch::make_ray(const Vec3& origin, const Vec3& direction, double limit, Ray& ray) const {
  const double largest = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  if (!(largest > 0.0) || !std::isfinite(largest)) return false;
  ray.scale = largest;
  ray.limit = limit * largest;
  for (int a = 0; a < 3; ++a) {
    const double o = std::clamp(origin[a], 0.0, double(lattice_.size[a] - 1));
    double d = direction[a] / largest;
    if (std::fabs(d) < kSmallestComponent) d = 0.0;
    const bool backward = d < 0.0;
    // A start on a face belongs to the cell that the ray goes into.
    ray.cell[a] = backward ? int(std::ceil(o)) - 1 : int(o);
    if (d == 0.0) ray.cell[a] = std::min(ray.cell[a], lattice_.size[a] - 2);
    if (ray.cell[a] < 0 || ray.cell[a] > lattice_.size[a] - 2) return false;
    ray.origin[a] = o;
    ray.direction[a] = d;
    ray.inverse[a] = d == 0.0 ? kInfinity : 1.0 / d;
    ray.plane_origin[a] = d == 0.0 ? -1.0 : o;
    ray.forward[a] = backward ? 0 : 1;
  }
  return true;
}

void RayMarch::load(const Ray& ray, CellCorners& corners) const {
  const float* p = data_ + lattice_.offset(ray.cell[0], ray.cell[1], ray.cell[2]);
  const std::ptrdiff_t y = lattice_.size.x;
  const std::ptrdiff_t z = y * lattice_.size.y;
  corners = {p[0], p[1], p[y], p[y + 1], p[z], p[z + 1], p[y + z], p[y + z + 1]};
}

std::array<double, 3> RayMarch::start_in_cell(const Ray& ray) const {
  return {ray.origin[0] - ray.cell[0], ray.origin[1] - ray.cell[1], ray.origin[2] - ray.cell[2]};
}

// Bricks of 4^3 cells are asked first: their table is small enough to stay in a near cache. Only then is it worth
// looking at their eighths, or at the larger bricks around them.
int RayMarch::free_brick(Ray& ray, TraceCounters& counters) const {
  if (!macrocells_) return 0;
  const auto out_of_reach = [&ray](const Macrocells::Level& level, std::size_t b) {
    return ray.inner > 0.0 ? double(level.high[b]) < ray.level : double(level.low[b]) > ray.level;
  };
  const auto& [eighths, bricks, blocks] = macrocells_->levels();
  const std::size_t brick = bricks.offset(ray.cell);
  if (brick != ray.brick) {
    if (out_of_reach(bricks, brick)) return out_of_reach(blocks, blocks.offset(ray.cell)) ? blocks.shift : bricks.shift;
    ray.brick = brick;
    ++counters.macrocells;
  }
  const std::size_t eighth = eighths.offset(ray.cell);
  if (eighth == ray.eighth) return 0;
  if (out_of_reach(eighths, eighth)) return eighths.shift;
  ray.eighth = eighth;
  return 0;
}

void RayMarch::plan(Ray& ray, Step& step, TraceCounters& counters) const {
  step.shift = free_brick(ray, counters);
  step.t = kInfinity;
  for (int a = 0; a < 3; ++a) {
    step.plane[a] = ((ray.cell[a] >> step.shift) + ray.forward[a]) << step.shift;
    step.plane_t[a] = (step.plane[a] - ray.plane_origin[a]) * ray.inverse[a];
    step.t = std::min(step.t, step.plane_t[a]);
  }
  // Roundings must not turn the ray back.
  step.t = std::max(step.t, ray.t);
}

// Exact on the planes that the ray crosses, so that both neighbours of a face see one place there.
RayMarch::Part RayMarch::part_in_cell(const Ray& ray, const Step& step) const {
  Part part;
  const double end = std::min(step.t, ray.limit);
  part.length = end - ray.t;
  for (int a = 0; a < 3; ++a) {
    const auto axis = std::size_t(a);
    const double base = ray.origin[a] - ray.cell[a];
    const double near = ray.forward[a] != 0 ? 0.0 : 1.0;
    part.enter[axis] = ray.on_plane[a] ? near : std::clamp(base + ray.t * ray.direction[a], 0.0, 1.0);
    part.leave[axis] = step.plane_t[a] <= end ? 1.0 - near : std::clamp(base + end * ray.direction[a], 0.0, 1.0);
  }
  return part;
}

// The place s on the part at which the level set is met.
std::optional<double> RayMarch::test_cell(Ray& ray, const Part& part, CellCorners& g, RootWish wish) const {
  for (double& v : g) v = ray.inner * (v - ray.level);
  const auto b = segment_cubic(g, part.enter, part.leave);
  if (!ray.fresh) {
    if (b[0] >= 0.0) return 0.0;
    return first_root(b, wish);
  }
  const DeflatedRoot root = deflated_root(b);
  ray.fresh = root.kind == DeflatedRoot::Kind::kFlat;
  if (root.kind == DeflatedRoot::Kind::kBlocked) return 0.0;
  if (root.kind == DeflatedRoot::Kind::kHit) return root.s;
  return std::nullopt;
}

std::optional<LevelSetHit> RayMarch::visit_cell(Ray& ray, const Step& step, RootWish wish,
                                                TraceCounters& counters) const {
  ++counters.cells;
  CellCorners corners;
  load(ray, corners);
  // Both bounds by plain comparisons: which corner is the largest is too random for branches.
  double low = corners[0];
  double high = corners[0];
  for (const double v : corners) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  const bool reached = ray.inner > 0.0 ? high >= ray.level : low <= ray.level;
  if (!reached) {
    ray.fresh = false;
    return std::nullopt;
  }
  const Part part = part_in_cell(ray, step);
  // A first interval as short as the rounding of a coordinate tells nothing: the next cell is then the first.
  if (ray.fresh && part.length <= rounding_) return std::nullopt;
  ++counters.cubics;
  const auto s = test_cell(ray, part, corners, wish);
  if (!s) return std::nullopt;
  LevelSetHit hit;
  for (int a = 0; a < 3; ++a) {
    const auto axis = std::size_t(a);
    hit.position[a] = ray.cell[a] + ((1.0 - *s) * part.enter[axis] + *s * part.leave[axis]);
  }
  hit.t = ray.offset + (ray.t + *s * part.length) / ray.scale;
  return hit;
}

// False where the ray leaves the box or its limit behind.
bool RayMarch::advance(Ray& ray, const Step& step) const {
  ray.t = step.t;
  if (!(ray.t < ray.limit)) return false;
  for (int a = 0; a < 3; ++a) {
    int& cell = ray.cell[a];
    ray.on_plane[a] = step.plane_t[a] <= step.t;
    if (ray.on_plane[a]) {
      cell = step.plane[a] + ray.forward[a] - 1;
    } else if (step.shift > 0 && ray.direction[a] != 0.0) {
      // Never back, and never out of the brick.
      const int low = ray.forward[a] != 0 ? cell : (cell >> step.shift) << step.shift;
      const int high = ray.forward[a] != 0 ? step.plane[a] - 1 : cell;
      cell = std::clamp(int(ray.origin[a] + step.t * ray.direction[a]), low, high);
    }
    // The last bricks may reach over the box's end.
    if (cell < 0 || cell > lattice_.size[a] - 2) return false;
  }
  return true;
}

std::optional<LevelSetHit> RayMarch::march(Ray& ray, RootWish wish, TraceCounters& counters) const {
  Step step;
  do {
    plan(ray, step, counters);
    if (step.shift > 0) {
      ray.fresh = false;
    } else if (auto hit = visit_cell(ray, step, wish, counters)) {
      ++counters.hits;
      return hit;
    }
  } while (advance(ray, step));
  return std::nullopt;
}

bool RayMarch::start_on_level(const Vec3& origin, const Vec3& direction, double isovalue, OuterSide outer, double limit,
                              Ray& ray) const {
  if (!make_ray(origin, direction, limit, ray)) return false;
  ray.inner = outer == OuterSide::kLower ? 1.0 : -1.0;
  // A site's isovalue is a float: the ray follows the level set that its start lies on exactly. Where the start is on
  // {f = isovalue} as well as double precision can tell, it follows that one, so that corners and plateaus of just this
  // value are met as such.
  CellCorners corners;
  load(ray, corners);
  double largest = 0.0;
  for (const double v : corners) largest = std::max(largest, std::fabs(v));
  const double start = cell_value(corners, start_in_cell(ray));
  ray.level = std::fabs(start - isovalue) <= 0x1p-46 * largest ? isovalue : start;
  return true;
}

std::optional<LevelSetHit> RayMarch::next_hit(const Vec3& origin, const Vec3& direction, double isovalue,
                                              OuterSide outer, RootWish wish, double limit,
                                              TraceCounters& counters) const {
  ++counters.rays;
  Ray ray;
  if (!start_on_level(origin, direction, isovalue, outer, limit, ray)) return std::nullopt;
  ray.fresh = true;
  return march(ray, wish, counters);
}

std::optional<LevelSetHit> RayMarch::hit_in_cell(const Vec3& origin, const Vec3& direction, double isovalue,
                                                 OuterSide outer, double t, TraceCounters& counters) const {
  Ray ray;
  if (!start_on_level(origin, direction, isovalue, outer, kInfinity, ray)) return std::nullopt;
  double entry[3];
  for (int a = 0; a < 3; ++a) {
    const double x = ray.origin[a] + t * ray.scale * ray.direction[a];
    ray.cell[a] = std::clamp(int(x), 0, lattice_.size[a] - 2);
    entry[a] = ray.direction[a] == 0.0 ? 0.0 : (ray.cell[a] + 1 - ray.forward[a] - ray.origin[a]) * ray.inverse[a];
    ray.t = std::max(ray.t, entry[a]);
  }
  if (ray.t == 0.0) return std::nullopt;
  for (int a = 0; a < 3; ++a) ray.on_plane[a] = entry[a] == ray.t;
  Step step;
  plan(ray, step, counters);
  return visit_cell(ray, step, RootWish::kPlace, counters);
}

std::optional<LevelSetHit> RayMarch::first_hit(const Vec3& origin, const Vec3& direction, double isovalue,
                                               TraceCounters& counters) const {
  ++counters.rays;
  const auto entry = enter_box(origin, direction, lattice_.size);
  if (!entry) return std::nullopt;
  Vec3 start = origin + entry->t * direction;
  const int face = entry->axis;
  if (face >= 0) start[face] = direction[face] > 0.0 ? 0.0 : double(lattice_.size[face] - 1);
  Ray ray;
  if (!make_ray(start, direction, kInfinity, ray)) return std::nullopt;
  ray.offset = entry->t;
  ray.level = isovalue;
  CellCorners corners;
  load(ray, corners);
  for (double& v : corners) v -= isovalue;
  const double value = cell_value(corners, start_in_cell(ray));
  if (value == 0.0) {
    ++counters.hits;
    return LevelSetHit{.t = entry->t, .position = {ray.origin[0], ray.origin[1], ray.origin[2]}};
  }
  ray.inner = value < 0.0 ? 1.0 : -1.0;
  return march(ray, RootWish::kPlace, counters);
}

}  // namespace isolux
