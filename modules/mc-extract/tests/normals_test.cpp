// Vertex normals against those of the fields themselves, and what they fall back to.
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "fields.h"
#include "mesh_laws.h"

namespace isolux {
namespace {

using namespace isolux::testing;

constexpr double kPi = std::numbers::pi;

struct SmoothField {
  const char* name;
  double (*value)(const Vec3& p);
  float isovalue;
};

double gyroid_value(const Vec3& p) {
  const Vec3 x = p * 4.0 * kPi;
  return std::sin(x.x) * std::cos(x.y) + std::sin(x.y) * std::cos(x.z) + std::sin(x.z) * std::cos(x.x);
}
double sphere_value(const Vec3& p) { return -glm::distance(p, Vec3(0.5)); }
double torus_value(const Vec3& p) { return -std::hypot(std::hypot(p.x - 0.5, p.y - 0.5) - 0.28, p.z - 0.5); }
/// Marschner & Lobb 1994: its shortest wave, at the box's faces, is 6.7 voxels of 128^3 long.
double marschner_lobb_value(const Vec3& p) {
  const Vec3 q = 2.0 * p - 1.0;
  const double wave = std::cos(12.0 * kPi * std::cos(kPi * std::hypot(q.x, q.y) / 2.0));
  return (1.0 - std::sin(kPi * q.z / 2.0) + 0.25 * (1.0 + wave)) / 2.5;
}
/// The density of a 3d_z2 orbital: from 1 to nothing, with nodes.
double hydrogen_value(const Vec3& p) {
  const Vec3 q = (2.0 * p - 1.0) * 20.0;
  const double angular = 3.0 * q.z * q.z - glm::dot(q, q);
  return angular * angular * std::exp(-2.0 / 3.0 * glm::length(q)) / (4.0 * 1296.0 * std::exp(-4.0));
}

const SmoothField kMildFields[] = {
    {"gyroid", gyroid_value, 0.3f}, {"sphere", sphere_value, -0.3f}, {"torus", torus_value, -0.1f}};
/// Those with waves of few voxels, or surfaces that meet the box's faces aslant.
const SmoothField kHardFields[] = {
    {"marschner-lobb", marschner_lobb_value, 0.3f}, {"marschner-lobb", marschner_lobb_value, 0.5f},
    {"marschner-lobb", marschner_lobb_value, 0.7f}, {"hydrogen", hydrogen_value, 0.05f},
    {"hydrogen", hydrogen_value, 0.002f},           {"cut sphere", sphere_value, -0.6f}};

/// Angle between the mesh's normals and those of the field itself, root mean square.
double normal_error_degrees(const IsoMesh& mesh, const SmoothField& field) {
  double sum = 0.0;
  for (const auto v : mesh.vertices()) {
    constexpr double kStep = 1e-5;  // error of second order: 1e-7 of a degree
    const Vec3 p = point(mesh, v);
    Vec3 gradient(0.0);
    for (int a = 0; a < 3; ++a) {
      Vec3 step(0.0);
      step[a] = kStep;
      gradient[a] = field.value(p + step) - field.value(p - step);
    }
    const double cosine = glm::dot(-glm::normalize(gradient), normal(mesh, v));
    const double degrees = std::acos(std::min(1.0, cosine)) * 180.0 / kPi;
    sum += degrees * degrees;
  }
  return std::sqrt(sum / double(mesh.n_vertices()));
}

IsoMesh extract(const Volume& volume, const ExtractSettings& settings, const char* backend = "marching_cubes") {
  return extractors().create(backend)->extract(volume, settings, {});
}

Volume with_noise(Volume volume, double sigma) {
  RandomStream random(31, 0);
  // A sum of four uniform numbers of variance 1/12 each.
  for (float& value : volume.values.values()) {
    double sum = -2.0;
    for (int n = 0; n < 4; ++n) sum += double(random.uniform_float());
    value += float(sigma * std::sqrt(3.0) * sum);
  }
  return volume;
}

TEST(Normals, OfMildFieldsAreRightToHalfADegree) {
  for (const SmoothField& field : kMildFields) {
    const Volume volume = sampled(Index3(128), unit_cube(128), field.value);
    EXPECT_LT(normal_error_degrees(extract(volume, {.isovalue = field.isovalue}), field), 0.5) << field.name;
  }
}

TEST(AccurateNormals, OfSmoothFieldsAreRightToHalfADegree) {
  for (const auto& fields : {std::span<const SmoothField>(kMildFields), std::span<const SmoothField>(kHardFields)}) {
    for (const SmoothField& field : fields) {
      const Volume volume = sampled(Index3(128), unit_cube(128), field.value);
      const IsoMesh mesh = extract(volume, {.isovalue = field.isovalue, .normals = NormalKind::kAccurate});
      // What was asked for, the box's faces included; it is .34 at most.
      EXPECT_LT(normal_error_degrees(mesh, field), 0.5) << field.name << " " << field.isovalue;
    }
  }
}

TEST(AccurateNormals, OfEveryBackendAreRightToHalfADegree) {
  // Vertices on diagonals of cells and inside them among them.
  const SmoothField field = {"marschner-lobb", marschner_lobb_value, 0.5f};
  const Volume volume = sampled(Index3(128), unit_cube(128), field.value);
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends()) {
    IsoMesh mesh = extract(volume, {.isovalue = 0.5f}, info.name.c_str());
    EXPECT_GT(normal_error_degrees(mesh, field), 2.0) << info.name;
    set_accurate_normals(volume, OuterSide::kLower, {}, mesh);
    EXPECT_LT(normal_error_degrees(mesh, field), 0.5) << info.name;
  }
}

TEST(AccurateNormals, AreExactForPolynomialsUpToTheBoxsFaces) {
  // Of degree five on each axis: the six or seven voxels of the second stencil hold it, those at faces too.
  const SmoothField field = {"quintic",
                             [](const Vec3& p) {
                               const Vec3 q = 2.0 * p - 1.0;
                               return q.x * q.x * q.x * q.x * q.x - q.y * q.y * q.y * q.x + q.z * q.z + 0.5 * q.y * q.z;
                             },
                             0.1f};
  const Volume volume = sampled(Index3(24), unit_cube(24), field.value);
  const IsoMesh mesh = extract(volume, {.isovalue = 0.1f, .normals = NormalKind::kAccurate});
  // Floats: 2^-24 of a value of 1 and a slope of .04 a voxel at the least, times 30 for nine points from one side.
  EXPECT_LT(normal_error_degrees(mesh, field), 0.05);
}

TEST(AccurateNormals, AreNoNoisierThanCentralDifferences) {
  for (const SmoothField& field : {kMildFields[0], kMildFields[1]}) {
    const Volume smooth = sampled(Index3(64), unit_cube(64), field.value);
    for (const double sigma : {0.003, 0.03}) {
      const Volume volume = with_noise(smooth, sigma);
      const double central = normal_error_degrees(extract(volume, {.isovalue = field.isovalue}), field);
      const double accurate =
          normal_error_degrees(extract(volume, {.isovalue = field.isovalue, .normals = NormalKind::kAccurate}), field);
      // Taken everywhere the second stencil would double the error, and more at the box's faces. The smaller noise is
      // hardly told from the field: a third more.
      EXPECT_LT(accurate, (sigma < 0.01 ? 1.5 : 1.02) * central) << field.name << " " << sigma;
    }
  }
}

TEST(AccurateNormals, FollowTheFrameAndTheOuterSide) {
  Volume volume = sampled(Index3(40), unit_cube(40), gyroid_value);
  Lattice lattice = volume.lattice();
  lattice.frame = {.origin = Vec3(5.0, -7.0, 11.0), .axes = Mat3(0.3, 0.1, 0.0, -0.2, 0.5, 0.1, 0.0, 0.1, -0.9)};
  const IsoMesh plain = extract(volume, {.isovalue = 0.3f, .normals = NormalKind::kAccurate});
  volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    const IsoMesh moved = extract(volume, {.isovalue = 0.3f, .outer = outer, .normals = NormalKind::kAccurate});
    if (outer == OuterSide::kHigher) {
      // Values equal to the isovalue aside, the other outer side has the same vertices.
      ASSERT_EQ(moved.n_vertices(), plain.n_vertices());
    }
    for (const auto v : moved.vertices()) {
      const Vec3 turned = glm::normalize(lattice.frame.gradient_to_world() * normal(plain, v));
      const double sign = outer == OuterSide::kLower ? 1.0 : -1.0;
      // Coordinates in floats of about 20 units: 1e-6 units of steps of .3.
      EXPECT_LT(glm::distance(sign * turned, normal(moved, v)), 1e-3);
    }
  }
}

TEST(AccurateNormals, AreUnitVectorsWhateverTheVoxels) {
  const float inf = std::numeric_limits<float>::infinity();
  const float big = std::numeric_limits<float>::max();
  const float odd[] = {std::numeric_limits<float>::quiet_NaN(), inf, -inf, big, -big, 1e-45f};
  const Registry<Extractor> registry = extractors();
  for (int seed = 0; seed < 40; ++seed) {
    // Smooth data with some odd voxels, so that stencils of every kind meet them; small grids among them.
    Volume volume = sampled(seed % 2 == 0 ? random_size(seed) : Index3(20), {}, [](const Vec3& p) {
      return std::sin(0.3 * p.x) + std::cos(0.4 * p.y) - std::sin(0.2 * p.z);
    });
    RandomStream random(23, seed);
    for (float& value : volume.values.values())
      if (random.next_bits() % 50 == 0) value = odd[random.next_bits() % 6];
    for (const BackendInfo& info : registry.backends()) {
      const auto mesh = extract(volume, {.isovalue = 0.4f, .normals = NormalKind::kAccurate}, info.name.c_str());
      ASSERT_TRUE(normals_are_unit(mesh)) << info.name << " " << seed;
    }
  }
}

TEST(AccurateNormals, StayCentralWhereThereIsNoGradient) {
  // Plateaus with steps between them: nothing is smooth, and beside one step all differences are as large.
  const Volume steps = sampled(Index3(24), {}, [](const Vec3& p) { return p.x < 11.5 ? 1.0 : 0.0; });
  EXPECT_TRUE(isolux::testing::identical(extract(steps, {.isovalue = 0.5f}),
                                         extract(steps, {.isovalue = 0.5f, .normals = NormalKind::kAccurate})));
  const Volume small = noise(Index3(2, 3, 4), 5);
  EXPECT_TRUE(isolux::testing::identical(extract(small, {.isovalue = 0.5f}),
                                         extract(small, {.isovalue = 0.5f, .normals = NormalKind::kAccurate})));
}

TEST(AccurateNormals, LeaveTheCapsCornersAlone) {
  const Volume volume = gyroid(30);
  const ExtractSettings central{.isovalue = 0.3f, .cap = CapKind::kBox};
  ExtractSettings accurate = central;
  accurate.normals = NormalKind::kAccurate;
  const IsoMesh expected = extract(volume, central);
  const IsoMesh mesh = extract(volume, accurate);
  ASSERT_EQ(mesh.n_vertices(), expected.n_vertices());
  int corners = 0;
  for (const auto v : mesh.vertices()) {
    const Vec3 index = volume.lattice().frame.index(point(mesh, v));
    if (glm::distance(index, glm::round(index)) > 1e-4) continue;  // float coordinates
    EXPECT_EQ(mesh.normal(v), expected.normal(v));
    ++corners;
  }
  EXPECT_GT(corners, 100);
}

TEST(AccurateNormals, DoNotDependOnThreadsOrTheKindOfMesh) {
  const Volume volume = sampled(Index3(64), unit_cube(64), marschner_lobb_value);
  const ExtractSettings settings{.isovalue = 0.5f, .normals = NormalKind::kAccurate};
  IsoExtractor extractor(volume);
  IndexedMesh one;
  extractor.extract(settings, {.threads = 1}, one);
  IndexedMesh three;
  extractor.extract(settings, {.threads = 3}, three);
  IsoMesh half_edges;
  extractor.extract(settings, {.threads = 3}, half_edges);
  EXPECT_EQ(one.normals, three.normals);
  EXPECT_EQ(one.normals, indexed_mesh(half_edges).normals);
}

}  // namespace
}  // namespace isolux
