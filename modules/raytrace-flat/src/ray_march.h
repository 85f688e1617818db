#pragma once

#include <isolux/core/field.h>
#include <isolux/core/grid.h>
#include <isolux/raytrace_flat/flat_tracer.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include <array>
#include <limits>
#include <optional>

#include "cell_cubic.h"
#include "macrocells.h"

namespace isolux {

/// Where nothing stops a ray.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The walk of a ray through bricks and cells (a 3D-DDA, Amanatides & Woo 1987) up to its first root. What
/// LevelSetIntersector and the backend `scalar` share; see LevelSetIntersector for the meaning of the queries.
class RayMarch {
 public:
  explicit RayMarch(const Volume& volume);
  /// Without macrocells: nothing is built, and a ray looks into every cell on its way. The values must outlive it.
  explicit RayMarch(GridView<const float> values);

  /// \param limit hits beyond this t do not count
  [[nodiscard]] std::optional<LevelSetHit> next_hit(const Vec3& origin, const Vec3& direction, double isovalue,
                                                    OuterSide outer, RootWish wish, double limit,
                                                    TraceCounters& counters) const;
  /// The hit of next_hit, known to lie in the cell that the ray is in at t > 0; none if it is not there. Cheaper.
  [[nodiscard]] std::optional<LevelSetHit> hit_in_cell(const Vec3& origin, const Vec3& direction, double isovalue,
                                                       OuterSide outer, double t, TraceCounters& counters) const;
  [[nodiscard]] std::optional<LevelSetHit> first_hit(const Vec3& origin, const Vec3& direction, double isovalue,
                                                     TraceCounters& counters) const;

 private:
  struct Ray;
  struct Step;
  struct Part;
  [[nodiscard]] bool make_ray(const Vec3& origin, const Vec3& direction, double limit, Ray& ray) const;
  [[nodiscard]] bool start_on_level(const Vec3& origin, const Vec3& direction, double isovalue, OuterSide outer,
                                    double limit, Ray& ray) const;
  [[nodiscard]] std::optional<LevelSetHit> march(Ray& ray, RootWish wish, TraceCounters& counters) const;
  /// The shift of the largest brick about the ray's cell that cannot hold the level set, 0 if there is none.
  [[nodiscard]] int free_brick(Ray& ray, TraceCounters& counters) const;
  void plan(Ray& ray, Step& step, TraceCounters& counters) const;
  [[nodiscard]] std::optional<LevelSetHit> visit_cell(Ray& ray, const Step& step, RootWish wish,
                                                      TraceCounters& counters) const;
  [[nodiscard]] Part part_in_cell(const Ray& ray, const Step& step) const;
  [[nodiscard]] std::optional<double> test_cell(Ray& ray, const Part& part, CellCorners& corners, RootWish wish) const;
  [[nodiscard]] bool advance(Ray& ray, const Step& step) const;
  void load(const Ray& ray, CellCorners& corners) const;
  [[nodiscard]] std::array<double, 3> start_in_cell(const Ray& ray) const;

  Lattice lattice_;
  const float* data_;
  std::optional<Macrocells> macrocells_;
  double rounding_;  ///< what a coordinate in the box can be wrong by
};

}  // namespace isolux
