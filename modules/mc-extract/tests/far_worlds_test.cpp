// Worlds whose origin is so far away that floats resolve them coarsely: what stays whole and how far vertices give way.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include "fields.h"
#include "mesh_laws.h"
#include "stress.h"

namespace isolux {
namespace {

using namespace isolux::testing;
using test::trials;

Volume placed(const Volume& volume, const IndexToWorld& frame) {
  Volume moved = volume;
  moved.values = Grid<float>(Lattice{.size = volume.lattice().size, .frame = frame},
                             {volume.values.values().begin(), volume.values.values().end()});
  return moved;
}

Mat3 turned() { return Mat3(glm::rotate(glm::dmat4(1.0), 0.7, Vec3(1.0, 2.0, -0.5))); }
Mat3 scaled(double x, double y, double z) { return {Vec3(x, 0.0, 0.0), Vec3(0.0, y, 0.0), Vec3(0.0, 0.0, z)}; }

/// Floats resolve their voxels to between 1/1000 and 1/70, in some directions alone or in all.
std::vector<IndexToWorld> far_frames() {
  const Mat3 sheared(Vec3(1.0, 0.0, 0.0), Vec3(0.8, 0.6, 0.0), Vec3(-0.3, 0.5, 0.9));
  return {{.origin = Vec3(1e4, 0.0, 0.0), .axes = scaled(0.3, 1.0, 2.0)},
          {.origin = Vec3(-2e4, 0.0, 3e4), .axes = scaled(0.5, 1.0, -0.4)},
          {.origin = Vec3(0.0, 1e5, 0.0), .axes = scaled(0.02, 1.0, 0.5)},
          {.origin = Vec3(5e4, -5e4, 5e4), .axes = turned() * scaled(0.5, 1.0, 1.0)},
          {.origin = Vec3(1e5, 0.0, 0.0), .axes = turned()},
          {.origin = Vec3(5e4, 0.0, 0.0), .axes = sheared},
          {.origin = Vec3(0.0, 3e4, 3e4), .axes = turned() * sheared}};
}

/// Any oblique frame, at such a distance that the coarsest axis has between 1/128 and 1/4096 of a voxel a float.
IndexToWorld random_far_frame(std::uint64_t seed, const Index3& size) {
  RandomStream random(seed, 5);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform_double(); };
  IndexToWorld frame;
  do {
    for (int a = 0; a < 3; ++a)
      frame.axes[a] = Vec3(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)) * std::exp2(between(-3.0, 3.0));
  } while (std::fabs(glm::determinant(frame.axes)) <
           0.1 * glm::length(frame.axes[0]) * glm::length(frame.axes[1]) * glm::length(frame.axes[2]));
  for (int w = 0; w < 3; ++w) frame.origin[w] = random.next_bits() % 2 == 0 ? 0.0 : between(-1e9, 1e9);
  const Vec3 resolution = vertex_resolution({.size = size, .frame = frame});
  const double coarsest = std::max({resolution.x, resolution.y, resolution.z});
  frame.origin *= std::exp2(-between(7.0, 12.0)) / coarsest;
  return frame;
}

class FarExtractor : public ::testing::TestWithParam<std::string> {
 protected:
  IsoMesh extract(const Volume& volume, const ExtractSettings& settings) const {
    return extractor_->extract(volume, settings, {});
  }

 private:
  std::unique_ptr<Extractor> extractor_ = extractors().create(GetParam());
};

std::vector<std::string> all_extractors() {
  std::vector<std::string> names;
  const Registry<Extractor> registry = extractors();
  for (const BackendInfo& info : registry.backends())
    if (info.unavailable.empty()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Backends, FarExtractor, ::testing::ValuesIn(all_extractors()),
                         [](const auto& backend) { return backend.param; });

TEST_P(FarExtractor, MakesNoEmptyTriangles) {
  for (int seed = 0; seed < trials(100); ++seed) {
    const Volume ties = noise(random_size(seed), seed, 3);
    std::vector<IndexToWorld> frames = far_frames();
    frames.push_back(random_far_frame(seed, ties.lattice().size));
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      const Volume volume = placed(ties, frames[frame]);
      IsoMesh open = extract(volume, {.isovalue = 1.0f});
      ASSERT_TRUE(is_manifold(open)) << seed << ' ' << frame;
      ASSERT_EQ(zero_area_triangles(open), 0) << seed << ' ' << frame;
    }
  }
}

TEST_P(FarExtractor, CapsAtTheBox) {
  for (int seed = 0; seed < trials(50); ++seed) {
    const Volume ties = noise(random_size(seed), seed, seed % 2 == 0 ? 0 : 4);
    std::vector<IndexToWorld> frames = far_frames();
    frames.push_back(random_far_frame(seed, ties.lattice().size));
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      IsoMesh closed =
          extract(placed(ties, frames[frame]), {.isovalue = seed % 2 == 0 ? 0.5f : 2.0f, .cap = CapKind::kBox});
      ASSERT_TRUE(is_manifold(closed)) << seed << ' ' << frame;
      ASSERT_TRUE(openmesh_accepts(closed)) << seed << ' ' << frame;
      ASSERT_EQ(boundary_edges(closed), 0) << seed << ' ' << frame;
      ASSERT_EQ(zero_area_triangles(closed), 0) << seed << ' ' << frame;
    }
  }
}

// As UTM coordinates in metres have it.
TEST_P(FarExtractor, RefusesACapThatFloatsDoNotTell) {
  const Volume volume = placed(noise(Index3(12), 3), {.origin = Vec3(5e5, 4.5e6, 0.0), .axes = Mat3(1.0)});
  const auto extractor = extractors().create(GetParam());
  EXPECT_NO_THROW((void)extractor->extract(volume, {.isovalue = 0.5f}, {}));
  EXPECT_THROW((void)extractor->extract(volume, {.isovalue = 0.5f, .cap = CapKind::kBox}, {}), InvalidInput);
}

TEST_P(FarExtractor, MovesVerticesOnlyAlongTheAxisThatIsCoarse) {
  // Steps of y and z, and the places along them, are exact to 2^-18 of a voxel, while along x a float's steps are 1/307
  // of a voxel: the margin there is 16 times as much.
  const Volume ties = noise(Index3(9, 10, 11), 4, 3);
  const IsoMesh near = extract(ties, {.isovalue = 1.0f});
  const Volume far = placed(ties, {.origin = Vec3(1e4, 0.0, 0.0), .axes = scaled(0.3, 1.0, 2.0)});
  const IsoMesh mesh = extract(far, {.isovalue = 1.0f});
  ASSERT_EQ(mesh.n_vertices(), near.n_vertices());
  int shifted = 0;
  for (const auto v : mesh.vertices()) {
    const Vec3 moved = far.lattice().frame.index(point(mesh, v)) - point(near, v);
    EXPECT_LT(std::fabs(moved.x), 0.08);
    // A vertex of a diagonal gives way along all of it, and points inside cells follow their polygon.
    const Vec3 fraction = glm::fract(point(near, v));
    if (int(fraction.x > 1e-5) + int(fraction.y > 1e-5) + int(fraction.z > 1e-5) > 1) continue;
    EXPECT_NEAR(moved.y, 0.0, 2e-6);
    EXPECT_NEAR(moved.z, 0.0, 2e-6);
    shifted += std::fabs(moved.x) > 0.04 ? 1 : 0;
  }
  EXPECT_GT(shifted, 10) << "ties must show the margin along x";
}

TEST(VertexResolution, IsThatOfTheFrame) {
  const auto of = [](const IndexToWorld& frame) {
    return vertex_resolution({.size = Index3(5, 6, 7), .frame = frame});
  };
  const double far = 1e6 * 0x1p-23;
  const Vec3 plain = of({.origin = Vec3(1e6, 0.0, 0.0), .axes = scaled(0.3, 1.0, 2.0)});
  EXPECT_NEAR(plain.x, far / 0.3, 1e-5 * far);
  EXPECT_NEAR(plain.y, 5.0 * 0x1p-23, 1e-12);
  EXPECT_NEAR(plain.z, 6.0 * 0x1p-23, 1e-12);
  // Turned by 45 degrees about z both axes of the plane see the coarse one by 1/sqrt(2).
  const double half = std::sqrt(0.5);
  const Vec3 oblique =
      of({.origin = Vec3(1e6, 0.0, 0.0), .axes = {Vec3(half, half, 0.0), Vec3(-half, half, 0.0), Vec3(0.0, 0.0, 1.0)}});
  EXPECT_NEAR(oblique.x, half * far, 1e-4 * far);
  EXPECT_NEAR(oblique.y, half * far, 1e-4 * far);
  EXPECT_LT(oblique.z, 1e-6);
}

}  // namespace
}  // namespace isolux
