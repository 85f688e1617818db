// The contract of the stage, for every backend of the catalogue.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "fields.h"
#include "hosts_floats.h"
#include "mesh_laws.h"
#include "stress.h"
#include "surface_builder.h"

namespace isolux {
namespace {

using namespace isolux::testing;
using test::trials;

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends())
    if (info.unavailable.empty()) names.push_back(info.name);
  return names;
}

class EveryExtractor : public ::testing::TestWithParam<std::string> {
 protected:
  IsoMesh extract(const Volume& volume, const ExtractSettings& settings, const isolux::Run& run = {}) const {
    return extractor_->extract(volume, settings, run);
  }
  IsoMesh extract(const Volume& volume, float isovalue) const { return extract(volume, {.isovalue = isovalue}); }

 private:
  std::unique_ptr<Extractor> extractor_ = extractors().create(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Backends, EveryExtractor, ::testing::ValuesIn(backend_names()),
                         [](const auto& backend) { return backend.param; });

TEST_P(EveryExtractor, MakesClosedSpheresOfEulerNumberTwo) {
  const IsoMesh mesh = extract(ball(32), -0.3f);
  EXPECT_EQ(euler_number(mesh), 2);
  EXPECT_EQ(boundary_edges(mesh), 0);
}

TEST_P(EveryExtractor, ConvergesToAreaAndVolumeAtSecondOrder) {
  double last_area = 0.0;
  double last_volume = 0.0;
  for (const int n : {17, 33, 65}) {
    const IsoMesh mesh = extract(ball(n), -0.37f);
    const double pi = std::acos(-1.0);
    const double area_error = std::fabs(area(mesh) - 4.0 * pi * 0.37 * 0.37);
    const double volume_error = std::fabs(enclosed_volume(mesh) - 4.0 / 3.0 * pi * 0.37 * 0.37 * 0.37);
    if (n > 17) {
      // Second order is a factor of 4; how the grid meets the sphere moves it a little.
      EXPECT_GT(last_area / area_error, 3.3) << n;
      EXPECT_GT(last_volume / volume_error, 3.3) << n;
    }
    last_area = area_error;
    last_volume = volume_error;
  }
}

TEST_P(EveryExtractor, FacesAndNormalsLookToTheOuterSide) {
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    for (const NormalKind normals : {NormalKind::kGradient, NormalKind::kFaces}) {
      const IsoMesh mesh = extract(ball(24), {.isovalue = -0.3f, .outer = outer, .normals = normals});
      const double sign = outer == OuterSide::kLower ? 1.0 : -1.0;
      EXPECT_GT(sign * enclosed_volume(mesh), 0.1);
      for (const auto v : mesh.vertices()) {
        const Vec3 radial = glm::normalize(point(mesh, v) - Vec3(0.5));
        // Slivers turn face normals by some degrees; central differences are right to a degree here.
        EXPECT_GT(sign * glm::dot(radial, normal(mesh, v)), normals == NormalKind::kGradient ? 0.999 : 0.9);
      }
    }
  }
}

TEST_P(EveryExtractor, MakesAManifoldOfNoise) {
  const int count = trials(1000);
  for (int seed = 0; seed < count; ++seed) {
    const Volume volume = noise(random_size(seed), seed);
    IsoMesh mesh = extract(volume, 0.5f);
    ASSERT_TRUE(is_manifold(mesh)) << seed;
    ASSERT_TRUE(is_open_only_at_the_box(mesh, volume.lattice())) << seed;
    ASSERT_TRUE(openmesh_accepts(mesh)) << seed;
    ASSERT_TRUE(normals_are_unit(mesh)) << seed;
  }
}

TEST_P(EveryExtractor, MakesAManifoldWithoutEmptyTrianglesOfTies) {
  const int count = trials(500);
  for (int seed = 0; seed < count; ++seed) {
    const Volume volume = noise(random_size(seed), seed, 3);
    for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
      IsoMesh mesh = extract(volume, {.isovalue = 1.0f, .outer = outer});
      ASSERT_TRUE(is_manifold(mesh)) << seed;
      ASSERT_TRUE(is_open_only_at_the_box(mesh, volume.lattice())) << seed;
      ASSERT_TRUE(openmesh_accepts(mesh)) << seed;
      ASSERT_TRUE(normals_are_unit(mesh)) << seed;
      ASSERT_EQ(zero_area_triangles(mesh), 0) << seed;
    }
  }
}

TEST_P(EveryExtractor, IsEmptyWhereThereIsNoLevelSet) {
  const Volume flat = sampled(Index3(5), {}, [](const Vec3&) { return 3.0; });
  for (const float isovalue : {2.0f, 3.0f, 4.0f}) EXPECT_EQ(extract(flat, isovalue).n_faces(), 0U) << isovalue;
  EXPECT_EQ(extract(ball(8), 1.0f).n_vertices(), 0U);
  EXPECT_EQ(extract(ball(8), -9.0f).n_vertices(), 0U);
}

TEST_P(EveryExtractor, WorksOnTheSmallestGrid) {
  for (const Index3 size : {Index3(2), Index3(2, 70, 2), Index3(130, 2, 3), Index3(3, 2, 66)}) {
    const Volume volume = noise(size, 7);
    IsoMesh mesh = extract(volume, 0.5f);
    EXPECT_TRUE(is_manifold(mesh));
    EXPECT_TRUE(is_open_only_at_the_box(mesh, volume.lattice()));
    EXPECT_GT(mesh.n_faces(), 0U);
  }
}

TEST_P(EveryExtractor, FollowsTheFrame) {
  const Volume plain = noise(Index3(7, 6, 5), 3);
  const IsoMesh expected = extract(plain, 0.5f);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, Vec3(1.0, 2.0, -0.5));
  for (const Vec3& scale :
       {Vec3(1.0, 2.0, 20.0), Vec3(-1.0, 1.0, 1.0), Vec3(0.5, -3.0, -2.0), Vec3(0.25, 0.25, -0.25)}) {
    Volume moved = plain;
    Lattice lattice = plain.lattice();
    lattice.frame.origin = Vec3(5.0, -7.0, 11.0);
    for (int a = 0; a < 3; ++a) lattice.frame.axes[a] = Mat3(turn)[a] * scale[a];
    moved.values = Grid<float>(lattice, {plain.values.values().begin(), plain.values.values().end()});
    const IsoMesh mesh = extract(moved, 0.5f);
    ASSERT_EQ(mesh.n_vertices(), expected.n_vertices());
    ASSERT_EQ(mesh.n_faces(), expected.n_faces());
    const double size = std::fabs(scale.x) + std::fabs(scale.y) + std::fabs(scale.z);
    for (const auto v : mesh.vertices()) {
      // Coordinates of about 12 units and of some steps, each rounded to float.
      EXPECT_LT(glm::distance(point(mesh, v), lattice.frame.world(point(expected, v))), 2e-6 * (12.0 + 10.0 * size));
      const Vec3 n = glm::normalize(lattice.frame.gradient_to_world() * normal(expected, v));
      EXPECT_GT(glm::dot(n, normal(mesh, v)), 0.9999);
    }
    const double turned = scale.x * scale.y * scale.z < 0.0 ? -1.0 : 1.0;
    const Mat3 area_to_world = lattice.frame.gradient_to_world() * turned;
    for (const auto f : mesh.faces())
      EXPECT_GE(glm::dot(area_to_world * area_vector(expected, f) * turned, area_vector(mesh, f)), -1e-12);
  }
}

TEST_P(EveryExtractor, DoesNotCareWhetherValuesAreNegated) {
  for (int seed = 0; seed < 20; ++seed) {
    const Volume volume = noise(random_size(seed), seed, 5);
    Volume negated = volume;
    for (float& value : negated.values.values()) value = -value;
    EXPECT_TRUE(identical(extract(volume, {.isovalue = 2.0f, .outer = OuterSide::kLower}),
                          extract(negated, {.isovalue = -2.0f, .outer = OuterSide::kHigher})));
  }
}

TEST_P(EveryExtractor, DoesNotCareForScaleAndOffsetOfValues) {
  // Powers of two and small integers, so that every sum is exact and the bits must agree.
  const Volume volume = noise(Index3(9), 5, 64);
  Volume other = volume;
  for (float& value : other.values.values()) value = 4.0f * value + 16.0f;
  EXPECT_TRUE(identical(extract(volume, 31.5f), extract(other, 142.0f)));
}

TEST_P(EveryExtractor, DoesNotDependOnThreads) {
  // More slabs than any backend's threads take at a time, and a last block that is not full.
  const Volume volume = noise(Index3(40, 21, 55), 11);
  IsoMesh one = extract(volume, {.isovalue = 0.4f}, {.threads = 1});
  EXPECT_TRUE(is_manifold(one));
  EXPECT_TRUE(is_open_only_at_the_box(one, volume.lattice()));
  for (const int threads : {2, 3, 8})
    EXPECT_TRUE(identical(one, extract(volume, {.isovalue = 0.4f}, {.threads = threads})));
}

TEST_P(EveryExtractor, NeverMakesANaN) {
  Volume volume = noise(Index3(8), 17);
  RandomStream random(23, 0);
  const float inf = std::numeric_limits<float>::infinity();
  const float big = std::numeric_limits<float>::max();
  const float odd[] = {std::numeric_limits<float>::quiet_NaN(), inf, -inf, big, -big, 1e-45f, 0.5f};
  for (float& value : volume.values.values())
    if (random.next_bits() % 3 == 0) value = odd[random.next_bits() % 7];
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    IsoMesh mesh = extract(volume, {.isovalue = 0.5f, .outer = outer});
    EXPECT_TRUE(is_manifold(mesh));
    EXPECT_TRUE(normals_are_unit(mesh));
    for (const auto v : mesh.vertices()) EXPECT_TRUE(std::isfinite(glm::length(point(mesh, v))));
    const test::HostsFloats hosts;  // nor in a program that traps them
    EXPECT_EQ(extract(volume, {.isovalue = 0.5f, .outer = outer}).n_faces(), mesh.n_faces());
    (void)extract(volume, {.isovalue = 0.5f, .outer = outer, .cap = CapKind::kBox});
  }
}

TEST_P(EveryExtractor, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)extract(ball(16), {.isovalue = -0.3f}, {.stop = source.get_token()}), Cancelled);
}

TEST_P(EveryExtractor, CapsAtTheBox) {
  for (int seed = 0; seed < trials(200); ++seed) {
    Volume volume = noise(random_size(seed), seed, seed % 2 == 0 ? 0 : 4);
    if (seed % 3 == 0) {
      Lattice lattice = volume.lattice();
      lattice.frame.axes[1] = Vec3(0.3, -2.0, 0.1);
      volume.values = Grid<float>(lattice, {volume.values.values().begin(), volume.values.values().end()});
    }
    for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
      const float isovalue = seed % 2 == 0 ? 0.5f : 2.0f;
      IsoMesh mesh = extract(volume, {.isovalue = isovalue, .outer = outer, .cap = CapKind::kBox});
      ASSERT_TRUE(is_manifold(mesh)) << seed;
      ASSERT_TRUE(openmesh_accepts(mesh)) << seed;
      ASSERT_TRUE(normals_are_unit(mesh)) << seed;
      ASSERT_EQ(boundary_edges(mesh), 0) << seed;
      ASSERT_EQ(zero_area_triangles(mesh), 0) << seed;
    }
  }
}

TEST_P(EveryExtractor, CapsEncloseTheInnerVolume) {
  // Half a box of side 1, on either side of the plane x = 1/2, exact for a linear field.
  const Volume ramp = sampled(Index3(9), unit_cube(9), [](const Vec3& p) { return p.x; });
  for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
    const MeshMeasures half = measure_mesh(extract(ramp, {.isovalue = 0.45f, .outer = outer, .cap = CapKind::kBox}));
    EXPECT_NEAR(half.volume.value(), outer == OuterSide::kLower ? 0.55 : 0.45, 1e-6);  // float coordinates
    EXPECT_NEAR(half.area, 2.0 + 4.0 * half.volume.value(), 1e-5);
    EXPECT_EQ(half.euler_number, 2);
    EXPECT_EQ(half.boundary_edges, 0U);
    EXPECT_EQ(half.components, 1U);
  }
  const MeshMeasures all = measure_mesh(extract(ramp, {.isovalue = -1.0f, .cap = CapKind::kBox}));
  EXPECT_NEAR(all.volume.value(), 1.0, 1e-6);
  EXPECT_EQ(all.euler_number, 2);
}

TEST_P(EveryExtractor, AnOpenSurfaceEnclosesNoVolume) {
  const Volume ramp = sampled(Index3(9), unit_cube(9), [](const Vec3& p) { return p.x; });
  const MeshMeasures open = measure_mesh(extract(ramp, {.isovalue = 0.45f}));
  EXPECT_GT(open.boundary_edges, 0U);
  EXPECT_FALSE(open.volume.has_value());
  EXPECT_NEAR(open.area, 1.0, 1e-5);
  EXPECT_EQ(measure_mesh(IsoMesh()).volume, 0.0);
}

TEST_P(EveryExtractor, LeavesOutSmallComponents) {
  const Volume two = sampled(Index3(24), unit_cube(24), [](const Vec3& p) {
    return std::max(0.3 - glm::distance(p, Vec3(0.35)), 0.1 - glm::distance(p, Vec3(0.85)));
  });
  const IsoMesh both = extract(two, 0.0f);
  EXPECT_EQ(measure_mesh(both).components, 2U);
  const IsoMesh one = extract(two, {.isovalue = 0.0f, .min_component = both.n_faces() / 2});
  EXPECT_EQ(measure_mesh(one).components, 1U);
  EXPECT_EQ(euler_number(one), 2);
  EXPECT_GT(one.n_faces(), both.n_faces() / 2);
  EXPECT_EQ(extract(two, {.isovalue = 0.0f, .min_component = both.n_faces() + 1}).n_faces(), 0U);
}

TEST_P(EveryExtractor, KeepsVerticesOnTheTrilinearSurface) {
  const Volume volume = gyroid(33);
  const TrilinearField field(volume);
  const IsoMesh mesh = extract(volume, 0.2f);
  for (const auto v : mesh.vertices()) {
    const Vec3 index = volume.lattice().frame.index(point(mesh, v));
    const Vec3 along = index - glm::floor(index);
    int off_the_grid = 0;
    for (int a = 0; a < 3; ++a) off_the_grid += std::min(along[a], 1.0 - along[a]) > 1e-4 ? 1 : 0;
    // On grid edges up to the margin of 2^-10 of a step and float rounding; diagonals and points inside cells are
    // interpolated, so wrong by the second order, at most 6 (4 pi/32)^2/8.
    EXPECT_NEAR(field.value(index), 0.2, off_the_grid < 2 ? 1e-3 : 0.12);
  }
}

TEST(SurfaceBuilder, RefusesPlanesOfMorePointsThanItHasNumbersFor) {
  EXPECT_NO_THROW(mc::require_plane({1 << 15, 1 << 14, 2}));
  EXPECT_THROW(mc::require_plane({40000, 30000, 2}), InvalidInput);
}

}  // namespace
}  // namespace isolux
