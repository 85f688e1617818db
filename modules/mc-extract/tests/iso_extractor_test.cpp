// The fast marching cubes against the plain one, and its index, buffers and instruction sets against each other.
#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <isolux/mc_extract.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "build_mesh.h"
#include "fields.h"
#include "mesh_laws.h"
#include "plain_marching_cubes.h"
#include "row_march.h"
#include "wide_targets.h"

namespace isolux {
namespace {

using namespace isolux::testing;

IndexedMesh indexed(const Volume& volume, const ExtractSettings& settings,
                    IsoExtractor::Index index = IsoExtractor::Index::kNone) {
  IndexedMesh mesh;
  IsoExtractor(volume, {}, index).extract(settings, {}, mesh);
  return mesh;
}

/// A triangle by its corners' places to 1/64 of a grid step and smaller, the smallest first: alike for two numberings.
using Corner = std::tuple<float, float, float>;
std::vector<std::array<Corner, 3>> sorted_triangles(const IndexedMesh& mesh) {
  std::vector<std::array<Corner, 3>> result;
  for (const Triangle& t : mesh.triangles) {
    std::array<Corner, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const Vec3f p = glm::round(mesh.positions[t[i]] * 4096.0f);
      corners[i] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Values in steps of 1/256, so that positions are the same in float and in double at the rounding above but for ties.
Volume stepped_noise(const Index3& size, std::uint64_t seed) { return noise(size, seed, 256); }

TEST(IsoExtractor, AgreesWithThePlainWay) {
  for (int seed = 0; seed < 50; ++seed) {
    const Index3 size = seed % 5 == 0 ? Index3(63 + seed, 3, 4) : random_size(seed);
    const Volume volume = stepped_noise(size, seed);
    const ExtractSettings settings{.isovalue = 100.5f, .outer = seed % 2 == 0 ? OuterSide::kLower : OuterSide::kHigher};
    const IndexedMesh plain = plain_marching_cubes(volume, settings);
    const IndexedMesh fast = indexed(volume, settings);
    ASSERT_EQ(fast.positions.size(), plain.positions.size());
    ASSERT_EQ(fast.triangles.size(), plain.triangles.size());
    // Both turn corners the same way round, so a mesh matches as a whole when its triangles do. Where rounding to the
    // grid of 1/4096 falls differently in float and double, positions differ by one unit: compare those by distance.
    const auto a = sorted_triangles(plain);
    const auto b = sorted_triangles(fast);
    std::size_t differing = 0;
    for (std::size_t t = 0; t < a.size(); ++t) differing += a[t] != b[t] ? 1 : 0;
    EXPECT_LE(differing, a.size() / 20) << seed;
  }
}

TEST(IsoExtractor, HasThePlainWaysNormals) {
  const Volume volume = gyroid(40);
  const IndexedMesh mesh = indexed(volume, {.isovalue = 0.3f});
  const TrilinearField field(volume);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 index = volume.lattice().frame.index(Vec3(mesh.positions[v]));
    const Vec3 n = field.normal(index, OuterSide::kLower, GradientKind::kCentralDifferences);
    EXPECT_LT(glm::distance(n, Vec3(mesh.normals[v])),
              2e-4);  // differences of floats, at most 2^-24 of 1.5 a step of .1
  }
}

TEST(RowMarch, GivesTheSameBySparseAndDensePasses) {
  // Small volumes have too many mixed bricks for the sparse way to be taken by itself.
  for (const Volume& volume : {gyroid(70), ball(81), noise(Index3(33, 9, 18), 3), noise(Index3(130, 5, 66), 4, 8)}) {
    const mc::BrickIndex index(volume, {});
    mc::RowMarch sparse(volume, 1.0);
    mc::RowMarch dense(volume, 0.0);
    for (const float part : {0.1f, 0.3f, 0.5f, 0.9f}) {
      const ValueRange range = value_range(volume);
      const ExtractSettings settings{.isovalue = range.low + part * (range.high - range.low)};
      IndexedMesh a;
      IndexedMesh b;
      sparse.march(settings, {}, &index, a);
      dense.march(settings, {}, &index, b);
      EXPECT_TRUE(identical(a, b)) << part;
    }
  }
}

TEST(RowMarch, RefusesMeshesBeyondThirtyTwoBits) {
  constexpr std::size_t kCorners = (std::size_t(1) << 31) / 3;
  EXPECT_NO_THROW(mc::require_countable({.vertices = 1, .edges = 1, .triangles = kCorners}, 0.5f));
  EXPECT_THROW(mc::require_countable({.vertices = 1, .edges = 1, .triangles = kCorners + 1}, 0.5f), InvalidInput);
  EXPECT_THROW(mc::require_countable({.vertices = 1, .edges = std::size_t(1) << 30, .triangles = 1}, 0.5f),
               InvalidInput);
}

TEST(IsoExtractor, GivesTheSameWithAndWithoutTheIndex) {
  std::vector<Volume> volumes = {gyroid(70), ball(81), noise(Index3(33, 9, 18), 3), noise(Index3(130, 5, 6), 4, 8)};
  volumes.push_back(
      sampled(Index3(100, 37, 50), {}, [](const Vec3& p) { return p.x == 77 && p.y == 20 ? 1.0 : -1.0; }));
  for (const Volume& volume : volumes) {
    const ValueRange range = value_range(volume);
    IsoExtractor with(volume);
    IsoExtractor without(volume, {}, IsoExtractor::Index::kNone);
    for (const OuterSide outer : {OuterSide::kLower, OuterSide::kHigher}) {
      for (const float part : {-0.1f, 0.0f, 0.1f, 0.5f, 0.9f, 1.0f, 1.1f}) {
        const ExtractSettings settings{.isovalue = range.low + part * (range.high - range.low), .outer = outer};
        IndexedMesh a;
        IndexedMesh b;
        with.extract(settings, {}, a);
        without.extract(settings, {}, b);
        EXPECT_TRUE(identical(a, b)) << part;
        IsoMesh c;
        IsoMesh d;
        with.extract(settings, {}, c);
        without.extract(settings, {}, d);
        EXPECT_TRUE(identical(c, d)) << part;
        EXPECT_TRUE(is_manifold(c)) << part;
      }
    }
  }
}

TEST(IsoExtractor, UsesAMeshAgainWithoutATrace) {
  const Volume volume = gyroid(50);
  IsoExtractor extractor(volume);
  IsoMesh kept;
  IndexedMesh kept_indexed;
  for (const float isovalue : {0.0f, 1.2f, -0.5f, 9.0f, 0.7f, 0.0f}) {
    const ExtractSettings settings{.isovalue = isovalue};
    extractor.extract(settings, {}, kept);
    extractor.extract(settings, {}, kept_indexed);
    EXPECT_TRUE(identical(kept, extractors().create("marching_cubes")->extract(volume, settings, {})));
    EXPECT_TRUE(identical(kept_indexed, indexed(volume, settings)));
    EXPECT_TRUE(is_manifold(kept));
  }
}

TEST(IsoExtractor, UsesAMeshAgainWhereItRebuilds) {
  const Volume volume = gyroid(20);
  IsoExtractor extractor(volume);
  IsoMesh kept;
  for (const float isovalue : {0.0f, 1.2f, 9.0f, 0.7f}) {
    for (const CapKind cap : {CapKind::kBox, CapKind::kNone}) {
      const ExtractSettings settings{.isovalue = isovalue, .cap = cap, .min_component = 3};
      extractor.extract(settings, {}, kept);
      EXPECT_TRUE(identical(kept, extractors().create("marching_cubes")->extract(volume, settings, {}))) << isovalue;
      EXPECT_TRUE(is_manifold(kept));
    }
  }
}

// With fewer edges a mesh may have more vertices, and so on.
TEST(IsoExtractor, UsesAMeshAgainWhateverItHasMoreOf) {
  int grown[3] = {};
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Volume volume = noise(Index3(8, 6, 5), seed, 256);
    IsoExtractor extractor(volume);
    IsoMesh kept;
    for (int step = 0; step < 200; ++step) {
      const ExtractSettings settings{.isovalue = float(step * 37 % 256)};
      IsoMesh expected;
      extractor.extract(settings, {}, expected);
      const bool more[3] = {expected.n_vertices() > kept.n_vertices(), expected.n_edges() > kept.n_edges(),
                            expected.n_faces() > kept.n_faces()};
      for (int i = 0; i < 3; ++i) grown[i] += more[i] && !more[(i + 1) % 3] ? 1 : 0;
      extractor.extract(settings, {}, kept);
      ASSERT_TRUE(identical(kept, expected)) << seed << ' ' << step;
    }
  }
  EXPECT_GT(grown[0], 0);  // vertices without edges
  EXPECT_GT(grown[2], 0);  // triangles without vertices
}

TEST(IsoExtractor, WritesOverAMeshThatIsTooSmall) {
  // Vertices of the first layers are written where the last mesh's lay, and moved when it has to grow. So large that
  // each array has pages of 2 MB.
  const Volume volume = gyroid(160);
  for (const int threads : {1, 3}) {
    IsoExtractor extractor(volume);
    for (const float small : {1.45f, 1.2f, 0.9f}) {
      IsoMesh kept;
      extractor.extract({.isovalue = small}, {.threads = threads}, kept);
      IsoMesh expected;
      extractor.extract({.isovalue = 0.1f}, {.threads = threads}, expected);
      ASSERT_LT(kept.n_vertices(), expected.n_vertices());
      extractor.extract({.isovalue = 0.1f}, {.threads = threads}, kept);
      EXPECT_TRUE(identical(kept, expected)) << small;
    }
  }
}

TEST(IsoExtractor, BothMeshesAreOne) {
  const Volume volume = noise(Index3(20, 70, 11), 8);
  for (const NormalKind normals : {NormalKind::kGradient, NormalKind::kFaces}) {
    const ExtractSettings settings{.isovalue = 0.6f, .normals = normals};
    IsoMesh mesh;
    IsoExtractor(volume).extract(settings, {}, mesh);
    const IndexedMesh expected = indexed(volume, settings);
    const IndexedMesh actual = indexed_mesh(mesh);
    EXPECT_EQ(actual.positions, expected.positions);
    EXPECT_EQ(actual.normals, expected.normals);
    EXPECT_EQ(actual.triangles, expected.triangles);
  }
}

TEST(IsoExtractor, GivesTheSameBitsOnEveryInstructionSet) {
  // Rows of less and of more than a word, and of several vectors' words.
  for (const Volume& volume :
       {noise(Index3(75, 20, 13), 21), noise(Index3(60, 9, 5), 23, 3), noise(Index3(600, 5, 4), 24)}) {
    const ExtractSettings settings{.isovalue = volume.values(0, 0, 0)};
    for (const IsoExtractor::Index index : {IsoExtractor::Index::kBricks, IsoExtractor::Index::kNone}) {
      const IndexedMesh expected = indexed(volume, settings, index);
      test::on_every_target([&] { EXPECT_TRUE(identical(expected, indexed(volume, settings, index))); });
    }
  }
}

TEST(IsoExtractor, RefusesPlanesBeyondThirtyTwoBits) {
  Volume volume;
  volume.values = Grid<float>(Lattice{.size = Index3(70000, 2, 2), .frame = {}});
  EXPECT_THROW(IsoExtractor{volume}, InvalidInput);
}

}  // namespace
}  // namespace isolux
