#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/options.h>
#include <isolux/core/parallel.h>
#include <isolux/core/random.h>
#include <isolux/volume_io/analytic_fields.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace isolux {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kLargestSize = 2048;
const Vec3 kCenter(0.5);

// Unit vector from `center` to `p`; zero at the centre itself.
Vec3 radial(const Vec3& p, const Vec3& center) {
  const Vec3 d = p - center;
  const double length = glm::length(d);
  return length > 0.0 ? d / length : Vec3(0.0);
}

double cavity(const Vec3& p) { return glm::distance(p, kCenter); }
Vec3 cavity_gradient(const Vec3& p) { return radial(p, kCenter); }
double sphere(const Vec3& p) { return -cavity(p); }
Vec3 sphere_gradient(const Vec3& p) { return -cavity_gradient(p); }

const std::array<Vec3, 2> kTwoCenters = {Vec3(0.3, 0.5, 0.5), Vec3(0.7, 0.5, 0.5)};

double two_spheres(const Vec3& p) {
  return -std::min(glm::distance(p, kTwoCenters[0]), glm::distance(p, kTwoCenters[1]));
}
Vec3 two_spheres_gradient(const Vec3& p) { return -radial(p, kTwoCenters[p.x < 0.5 ? 0 : 1]); }

constexpr double kBallRadius = 0.1;

double ball_over_plane(const Vec3& p) { return -std::min(p.z, glm::distance(p, kCenter) - kBallRadius); }
Vec3 ball_over_plane_gradient(const Vec3& p) {
  return p.z < glm::distance(p, kCenter) - kBallRadius ? Vec3(0.0, 0.0, -1.0) : -radial(p, kCenter);
}

constexpr double kTorusRadius = 0.28;

double torus(const Vec3& p) {
  const Vec3 d = p - kCenter;
  return -std::hypot(std::hypot(d.x, d.y) - kTorusRadius, d.z);
}
Vec3 torus_gradient(const Vec3& p) {
  const Vec3 outward = radial(Vec3(p.x, p.y, 0.0), Vec3(0.5, 0.5, 0.0));
  return -radial(p, kCenter + kTorusRadius * outward);
}

double gyroid(const Vec3& p) {
  const Vec3 q = 4.0 * kPi * p;
  return std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
}
Vec3 gyroid_gradient(const Vec3& p) {
  const Vec3 q = 4.0 * kPi * p;
  const Vec3 s(std::sin(q.x), std::sin(q.y), std::sin(q.z));
  const Vec3 c(std::cos(q.x), std::cos(q.y), std::cos(q.z));
  return 4.0 * kPi * Vec3(c.x * c.y - s.z * s.x, c.y * c.z - s.x * s.y, c.z * c.x - s.y * s.z);
}

// Marschner & Lobb, "An evaluation of reconstruction filters for volume rendering", Visualization 1994.
constexpr double kAlpha = 0.25;
constexpr double kFrequency = 6.0;

double marschner_lobb(const Vec3& p) {
  const Vec3 q = 2.0 * p - 1.0;
  const double wave = std::cos(2.0 * kPi * kFrequency * std::cos(kPi * std::hypot(q.x, q.y) / 2.0));
  return (1.0 - std::sin(kPi * q.z / 2.0) + kAlpha * (1.0 + wave)) / (2.0 * (1.0 + kAlpha));
}
Vec3 marschner_lobb_gradient(const Vec3& p) {
  const Vec3 q = 2.0 * p - 1.0;
  const double r = std::hypot(q.x, q.y);
  const double phase = 2.0 * kPi * kFrequency * std::cos(kPi * r / 2.0);
  const double wave_slope = std::sin(phase) * 2.0 * kPi * kFrequency * std::sin(kPi * r / 2.0) * kPi / 2.0;
  const Vec3 outward = radial(Vec3(q.x, q.y, 0.0), Vec3(0.0));
  // The factor 2 is dq/dp.
  return 2.0 / (2.0 * (1.0 + kAlpha)) *
         (kAlpha * wave_slope * outward - Vec3(0.0, 0.0, kPi / 2.0 * std::cos(kPi * q.z / 2.0)));
}

// |psi|^2 of the 3d_z2 orbital is (3z^2 - r^2)^2 exp(-2r/3) in Bohr radii, up to a factor; its maximum, at z = 6 on the
// axis, is made 1. On a box of +-20 Bohr radii every level set above .011 is closed.
constexpr double kBohrRadii = 20.0;
const double kHydrogenPeak = 4.0 * std::pow(6.0, 4) * std::exp(-4.0);

double hydrogen(const Vec3& p) {
  const Vec3 q = (2.0 * p - 1.0) * kBohrRadii;
  const double angular = 3.0 * q.z * q.z - glm::dot(q, q);
  return angular * angular * std::exp(-2.0 / 3.0 * glm::length(q)) / kHydrogenPeak;
}
Vec3 hydrogen_gradient(const Vec3& p) {
  const Vec3 q = (2.0 * p - 1.0) * kBohrRadii;
  const double angular = 3.0 * q.z * q.z - glm::dot(q, q);
  const double decay = std::exp(-2.0 / 3.0 * glm::length(q)) / kHydrogenPeak;
  const Vec3 angular_gradient(-2.0 * q.x, -2.0 * q.y, 4.0 * q.z);
  return 2.0 * kBohrRadii * decay *
         (2.0 * angular * angular_gradient - 2.0 / 3.0 * angular * angular * radial(q, Vec3(0.0)));
}

constexpr std::array<AnalyticField, 8> kFields = {{
    {"sphere", "-|p - c|, c the cube's centre: concentric spheres", sphere, sphere_gradient},
    {"cavity", "|p - c|: spheres seen from inside, closed up to radius .5", cavity, cavity_gradient},
    {"two-spheres", "-min(|p - (.3,.5,.5)|, |p - (.7,.5,.5)|)", two_spheres, two_spheres_gradient},
    {"ball-over-plane", "-min(z, |p - c| - .1)", ball_over_plane, ball_over_plane_gradient},
    {"torus", "minus the distance to the circle of radius .28 about c in the plane z = .5", torus, torus_gradient},
    {"gyroid", "sin X cos Y + sin Y cos Z + sin Z cos X, X = 4 pi x and so on", gyroid, gyroid_gradient},
    {"marschner-lobb", "the test signal of Marschner & Lobb 1994, alpha .25, fM 6", marschner_lobb,
     marschner_lobb_gradient},
    {"hydrogen", "density of a 3d_z2 orbital, maximum 1, +-20 Bohr radii", hydrogen, hydrogen_gradient},
}};

constexpr std::string_view kNoise = "noise";

}  // namespace

std::span<const AnalyticField> analytic_fields() { return kFields; }

const AnalyticField& analytic_field(std::string_view name) {
  std::vector<std::string> names;
  std::string list;
  for (const auto& field : kFields) {
    if (field.name == name) return field;
    names.emplace_back(field.name);
    list += fmt::format("{}, ", field.name);
  }
  names.emplace_back(kNoise);
  const std::string near = nearest_word(name, names);
  throw InvalidInput(fmt::format("no analytic field is called '{}'{}; there are {}{}", name,
                                 near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near), list, kNoise));
}

Lattice unit_cube_lattice(int n) {
  return {.size = Index3(n), .frame = {.origin = Vec3(0.0), .axes = Mat3(1.0 / (n - 1))}};
}

Volume sample_analytic_field(std::string_view name, int n, const Run& run) {
  const AnalyticField* field = name == kNoise ? nullptr : &analytic_field(name);
  if (n < 2 || n > kLargestSize)
    throw InvalidInput(fmt::format("gen:{}:{}: allowed is 2 to {} points an axis", name, n, kLargestSize));
  Volume volume{.values = Grid<float>(unit_cube_lattice(n)),
                .name = fmt::format("gen:{}:{}", name, n),
                .stored_type = ScalarType::kFloat32,
                .space = "3D-right-handed"};
  const auto values = volume.values.values();
  const auto points = std::size_t(n);
  // One block a row.
  parallel_blocks(points * points, 64, run, "read", [&](const Block& rows) {
    for (std::size_t at = rows.begin * points; at < rows.end * points; ++at) {
      if (field == nullptr) {
        values[at] = RandomStream(run.seed, at).uniform_float();
      } else {
        // i / (n - 1), not i times the step: the last point is 1 exactly.
        const Index3 index(int(at % points), int(at / points % points), int(at / points / points));
        const Vec3 p = Vec3(index) / double(n - 1);
        values[at] = float(field->value(p));
      }
    }
  });
  return volume;
}

}  // namespace isolux
