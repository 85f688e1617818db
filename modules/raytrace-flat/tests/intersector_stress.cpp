// Random and nasty ray/cell cases against the long-double oracle. ISOLUX_STRESS=full runs 10^7 of them.
#include <gtest/gtest.h>
#include <isolux/raytrace_flat/level_set_intersector.h>

#include <iomanip>
#include <sstream>
#include <string>

#include "analytic_volume.h"
#include "physics_support.h"
#include "root_oracle.h"

namespace isolux::test {
namespace {

enum class Values { kUniform, kSmallWhole, kMostlyConstant, kSaddles, kHugeAndTiny, kTiny, kHuge, kSmooth, kLast };
enum class Origins { kAnywhere, kOnFace, kOnEdge, kAtVoxel, kHalves, kLast };
enum class Directions { kAnywhere, kAlongAxis, kInFace, kDiagonal, kFlat, kToVoxel, kGrazing, kLast };

float corner_value(Values kind, RandomStream& random) {
  const double u = random.uniform_double();
  switch (kind) {
    case Values::kSmallWhole:
      return float(int(u * 4.0));
    case Values::kMostlyConstant:
      return u < 0.8 ? 1.0f : float(int(u * 30.0) % 3);
    case Values::kSaddles:
      return float((random.next_bits() & 1u) != 0 ? 1.0 + 1e-3 * u : -1.0 - 1e-3 * u);
    case Values::kHugeAndTiny:
      return float((u - 0.5) * ((random.next_bits() & 1u) != 0 ? 1e30 : 1e-30));
    case Values::kTiny:
      return float(u * 1e-30);
    case Values::kHuge:
      return float((u - 0.5) * 1e30);
    default:
      return float(u);
  }
}

Volume random_volume(Values kind, Index3 size, RandomStream& random) {
  if (kind != Values::kSmooth)
    return sampled({.size = size, .frame = {}}, [&](const Vec3&) { return corner_value(kind, random); });
  const Vec3 wave = 2.0 * random_direction(random);
  return sampled({.size = size, .frame = {}}, [&](const Vec3& p) {
    return std::sin(wave.x * p.x) + std::sin(wave.y * p.y + wave.z * p.z) + 1e-3 * random.uniform_double();
  });
}

Vec3 random_origin(Origins kind, Index3 size, RandomStream& random) {
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = double(float(random.uniform_double() * (size[a] - 1)));
  const int axis = int(random.next_bits() % 3);
  for (int a = 0; a < 3; ++a) {
    const bool whole =
        kind == Origins::kAtVoxel || (kind == Origins::kOnFace && a == axis) || (kind == Origins::kOnEdge && a != axis);
    if (whole) p[a] = std::round(p[a]);
    if (kind == Origins::kHalves) p[a] = std::round(2.0 * p[a]) / 2.0;
  }
  return p;
}

Vec3 random_ray(Directions kind, const Vec3& origin, const Volume& volume, RandomStream& random) {
  const Index3 size = volume.lattice().size;
  Vec3 d = random_direction(random);
  const int axis = int(random.next_bits() % 3);
  switch (kind) {
    case Directions::kAlongAxis:
      d = Vec3(0.0);
      d[axis] = (random.next_bits() & 1u) != 0 ? 1.0 : -1.0;
      break;
    case Directions::kInFace:
      d[axis] = 0.0;
      break;
    case Directions::kDiagonal:
      for (int a = 0; a < 3; ++a) d[a] = std::copysign(1.0, d[a]);
      break;
    case Directions::kFlat:
      d.z /= 20.0;
      break;
    case Directions::kToVoxel:
      for (int a = 0; a < 3; ++a) d[a] = double(random.next_bits() % std::uint32_t(size[a])) - origin[a];
      break;
    case Directions::kGrazing: {
      const Vec3 gradient = TrilinearField(volume).cell_gradient(origin);
      const double length = glm::length(gradient);
      if (length > 0.0)
        d -= gradient / length * (glm::dot(d, gradient / length) + 1e-5 * (random.uniform_double() - 0.7));
      break;
    }
    default:
      break;
  }
  return d;
}

struct Tally {
  long cases = 0;
  long undecided = 0;
  long missed = 0;
  long false_hits = 0;
  long misplaced = 0;
  std::string first_wrong;

  void count(const OracleAnswer& right, const std::optional<LevelSetHit>& found, const Vec3& origin,
             const Vec3& direction) {
    ++cases;
    const double speed = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
    if (!right.decided) {
      ++undecided;
      return;
    }
    if (right.t && found && std::fabs(*right.t - found->t) * speed <= 1e-4) return;
    if (!right.t && !found) return;
    ++(!right.t ? false_hits : !found ? missed : misplaced);
    if (!first_wrong.empty()) return;
    std::ostringstream text;
    text << std::setprecision(17) << "first wrong: case " << cases << " from " << origin.x << ',' << origin.y << ','
         << origin.z << " along " << direction.x << ',' << direction.y << ',' << direction.z << " oracle "
         << (right.t ? *right.t : -1.0) << " found " << (found ? found->t : -1.0);
    first_wrong = text.str();
  }
};

Tally run_cases(Values values, Index3 size, int volumes, int rays_a_volume) {
  Tally tally;
  RandomStream random(7, std::uint64_t(values), std::uint32_t(size.x));
  for (int v = 0; v < volumes; ++v) {
    const Volume volume = random_volume(values, size, random);
    const LevelSetIntersector intersector(volume);
    const TrilinearField field(volume);
    const RootOracle oracle(volume);
    for (int r = 0; r < rays_a_volume; ++r) {
      const auto origins = Origins(random.next_bits() % std::uint32_t(Origins::kLast));
      const auto directions = Directions(random.next_bits() % std::uint32_t(Directions::kLast));
      const Vec3 origin = random_origin(origins, size, random);
      const Vec3 direction = random_ray(directions, origin, volume, random);
      if (direction == Vec3(0.0)) continue;
      const OuterSide outer = (random.next_bits() & 1u) != 0 ? OuterSide::kLower : OuterSide::kHigher;
      if (r % 4 != 0) {
        const auto isovalue = float(field.value(origin));
        tally.count(oracle.next_hit(origin, direction, outer), intersector.next_hit(origin, direction, isovalue, outer),
                    origin, direction);
      } else {
        // Isovalues of corners and others alike.
        const Vec3 elsewhere = random_origin((r & 4) != 0 ? Origins::kAtVoxel : Origins::kAnywhere, size, random);
        const auto isovalue = float(field.value(elsewhere));
        tally.count(oracle.first_hit(origin, direction, double(isovalue)),
                    intersector.first_hit(origin, direction, isovalue), origin, direction);
      }
    }
  }
  return tally;
}

class IntersectorStress : public testing::TestWithParam<Values> {};

TEST_P(IntersectorStress, AgreesWithTheOracleWhereverItDecides) {
  const int cells = full_stress() ? 12'000 : 150;
  // Few cells, so that most rays are decided in their first ones; then enough for macrocells to be skipped.
  for (const Index3 size : {Index3(2, 2, 2), Index3(4, 3, 5), Index3(23, 18, 37)}) {
    const bool large = size.x > 10;
    const Tally tally = run_cases(GetParam(), size, large ? cells / 50 : cells, large ? 1000 : 50);
    EXPECT_EQ(tally.missed, 0) << "of " << tally.cases << ", size " << size.x << "; " << tally.first_wrong;
    EXPECT_EQ(tally.false_hits, 0) << "of " << tally.cases << ", size " << size.x << "; " << tally.first_wrong;
    EXPECT_EQ(tally.misplaced, 0) << "of " << tally.cases << ", size " << size.x << "; " << tally.first_wrong;
    RecordProperty("cases_" + std::to_string(size.x), std::to_string(tally.cases));
    RecordProperty("undecided_" + std::to_string(size.x), std::to_string(tally.undecided));
  }
}

INSTANTIATE_TEST_SUITE_P(Values, IntersectorStress,
                         testing::Values(Values::kUniform, Values::kSmallWhole, Values::kMostlyConstant,
                                         Values::kSaddles, Values::kHugeAndTiny, Values::kTiny, Values::kHuge,
                                         Values::kSmooth),
                         [](const auto& kind) { return "Kind" + std::to_string(int(kind.param)); });

}  // namespace
}  // namespace isolux::test
