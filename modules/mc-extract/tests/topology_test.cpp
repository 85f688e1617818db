// marching_cubes_topological against a count that knows nothing of cases: the
// trilinear interpolant sampled so finely that marching cubes of the samples
// has its topology.
// First of what a unity build compiles with write_mesh_test.cpp, which says why.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <iostream>

#include "cube.h"
#include "fields.h"
#include "mesh_laws.h"
#include "stress.h"
#include "trilinear_cell.h"

namespace isolux {
namespace {

using namespace isolux::testing;
using test::trials;

struct Topology {
  std::size_t components;
  std::int64_t euler_number;
  bool operator==(const Topology&) const = default;
};

Topology topology(const IsoMesh& mesh) {
  const MeshMeasures measures = measure_mesh(mesh);
  return {measures.components, measures.euler_number};
}

/// The interpolant at `factor` times as many grid steps.
Volume refined(const Volume& volume, int factor) {
  const TrilinearField field(volume);
  return sampled((volume.lattice().size - 1) * factor + 1, {.origin = Vec3(0.0), .axes = Mat3(1.0 / factor)},
                 [&](const Vec3& p) { return field.value(p); });
}

/// Every other volume alternates in sign as a chessboard does, more or less:
/// that is where the hard cases are.
Volume hard_case(const Index3& size, std::uint64_t seed) {
  Volume volume = noise(size, seed + 1000);
  if (seed % 2 != 0) return volume;
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i)
        volume.values(i, j, k) = 0.5f + ((i + j + k) % 2 == 0 ? 0.6f : -0.6f) * (volume.values(i, j, k) - 0.1f);
  return volume;
}

/// Values at the corners of a volume's cells and where the interpolant is
/// stationary on their faces and inside: those at which its level set changes
/// its topology.
std::vector<double> critical_values(const Volume& volume) {
  std::vector<double> values;
  const Index3 cells = volume.lattice().size - 1;
  for (int n = 0; n < cells.x * cells.y * cells.z; ++n) {
    const Index3 low(n % cells.x, n / cells.x % cells.y, n / (cells.x * cells.y));
    std::array<double, 8> f{};
    for (int c = 0; c < 8; ++c) f[c] = volume.values(low.x + (c & 1), low.y + (c >> 1 & 1), low.z + (c >> 2));
    values.insert(values.end(), f.begin(), f.end());
    for (const auto& q : mc::kFaceCorners) {
      // The bilinear saddle lies on the face where the corners of each diagonal
      // are both above those of the other.
      const double twist = f[q[0]] + f[q[2]] - f[q[1]] - f[q[3]];
      const double u = (f[q[0]] - f[q[3]]) / twist;
      const double v = (f[q[0]] - f[q[1]]) / twist;
      if (u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0) values.push_back((f[q[0]] * f[q[2]] - f[q[1]] * f[q[3]]) / twist);
    }
    const mc::TrilinearCell cell(f);
    for (const std::optional<Vec3>& point : cell.critical_points())
      if (point && glm::all(glm::lessThan(glm::abs(*point - 0.5), Vec3(0.5)))) values.push_back(cell.value(*point));
  }
  return values;
}

/// The middle between the two critical values next to an isovalue. The level
/// set there has the same topology and its necks are wider, so that a sampling
/// tells what it cannot tell at the isovalue.
float clearest_isovalue(const Volume& volume, float isovalue) {
  double below = isovalue - 0.05;
  double above = isovalue + 0.05;
  for (const double value : critical_values(volume)) {
    if (value < isovalue) below = std::max(below, value);
    if (value >= isovalue) above = std::min(above, value);
  }
  return float(0.5 * (below + above));
}

/// How many of `count` volumes have another topology than their refinement,
/// first coarsely, then ever finer where they disagree: what a sampling can
/// decide, it decides right at some step. What even the finest has not decided
/// is sampled so at the clearest isovalue of the same topology. Prints how many
/// each step left.
int disagreements(const char* what, int count, const Index3& size, std::span<const int> factors) {
  const auto extractor = extractors().create("marching_cubes_topological");
  const ExtractSettings settings{.isovalue = 0.5f};
  const isolux::Run run{.threads = 1};
  const auto sampled_topology = [&](const Volume& volume, int factor, float isovalue) {
    IsoMesh fine;
    const Volume samples = refined(volume, factor);
    IsoExtractor(samples, run, IsoExtractor::Index::kNone).extract({.isovalue = isovalue}, run, fine);
    return topology(fine);
  };
  std::vector<int> left(factors.size() + 1, 0);
  for (int seed = 0; seed < count; ++seed) {
    const Volume volume = hard_case(size, std::uint64_t(seed));
    const Topology expected = topology(extractor->extract(volume, settings, run));
    std::size_t step = 0;
    while (step < factors.size() && sampled_topology(volume, factors[step], settings.isovalue) != expected)
      ++left[step++];
    if (step < factors.size()) continue;
    const float clearest = clearest_isovalue(volume, settings.isovalue);
    const Topology found = sampled_topology(volume, factors.back(), clearest);
    if (found == expected) continue;
    ++left[step];
    std::cout << what << " " << seed << ": " << expected.components << " components, Euler number "
              << expected.euler_number << "; sampled at " << clearest << ": " << found.components << ", "
              << found.euler_number << '\n';
  }
  std::cout << count << " random " << what << ":";
  for (std::size_t step = 0; step < factors.size(); ++step)
    std::cout << ' ' << left[step] << " differ at " << factors[step] << " steps a cell,";
  std::cout << ' ' << left.back() << " at the clearest isovalue" << std::endl;
  return left.back();
}

TEST(Topology, OfCellsIsTheInterpolants) {
  EXPECT_EQ(disagreements("cells", trials(1000), Index3(2), std::array{12, 48, 200}), 0);
}

TEST(Topology, OfVolumesIsTheInterpolants) {
  EXPECT_EQ(disagreements("volumes of 27 cells", trials(100), Index3(4), std::array{12, 60, 120}), 0);
}

TEST(Topology, EveryTunnelHasItsRing) {
  int tunnels = 0;
  for (int seed = 0; seed < trials(20000); ++seed) {
    RandomStream random(std::uint64_t(seed), 2);
    std::array<double, 8> corners{};
    for (double& corner : corners) corner = 2.0 * random.uniform_double() - 1.0;
    const mc::TrilinearCell cell(corners);
    if (!cell.tunnel()) continue;
    ++tunnels;
    const auto ring = cell.hexagon();
    ASSERT_TRUE(ring) << seed;
    for (std::size_t i = 0; i < 6; ++i) {
      // The points and the straight lines between them lie on the surface.
      EXPECT_NEAR(cell.value((*ring)[i]), 0.0, 1e-9);
      EXPECT_NEAR(cell.value(0.5 * ((*ring)[i] + (*ring)[(i + 1) % 6])), 0.0, 1e-9);
    }
  }
  EXPECT_GT(tunnels, 20);
}

TEST(Topology, ATubeThroughACellIsATube) {
  // Two opposite corners inside, near enough to the level for the middle to be
  // inside too.
  Volume volume = sampled(Index3(2), {}, [](const Vec3& /*p*/) { return -1.0; });
  for (const float corner : {2.0f, 4.0f}) {
    volume.values(0, 0, 0) = corner;
    volume.values(1, 1, 1) = corner;
    const IsoMesh mesh = extractors().create("marching_cubes_topological")->extract(volume, {.isovalue = 0.0f}, {});
    // F on the diagonal is -1 + (corner + 1)(t^3 + (1 - t)^3), least in the
    // middle: -1 + (corner + 1)/4.
    EXPECT_EQ(topology(mesh), (corner > 3.0f ? Topology{1, 0} : Topology{2, 2}));
  }
}

}  // namespace
}  // namespace isolux
