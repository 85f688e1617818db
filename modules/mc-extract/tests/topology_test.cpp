// marching_cubes_topological against a count that knows nothing of cases: the trilinear interpolant sampled so finely
// that marching cubes of the samples has its topology.
#include <gtest/gtest.h>
#include <isolux/mc_extract.h>

#include <cstdlib>
#include <iostream>

#include "fields.h"
#include "mesh_laws.h"
#include "trilinear_cell.h"

namespace isolux {
namespace {

using namespace isolux::testing;

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

int stress() {
  const char* factor = std::getenv("ISOLUX_STRESS");
  return factor != nullptr ? std::max(1, std::atoi(factor)) : 1;
}

/// Every other volume alternates in sign as a chessboard does, more or less: that is where the hard cases are.
Volume hard_case(const Index3& size, std::uint64_t seed) {
  Volume volume = noise(size, seed + 1000);
  if (seed % 2 != 0) return volume;
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i)
        volume.values(i, j, k) = 0.5f + ((i + j + k) % 2 == 0 ? 0.6f : -0.6f) * (volume.values(i, j, k) - 0.1f);
  return volume;
}

/// How many of `count` volumes have another topology than their refinement, first coarsely, then ever finer where they
/// disagree: what a sampling can decide, it decides right at some step. Prints how many each step left.
int disagreements(const char* what, int count, const Index3& size, std::span<const int> factors) {
  const auto extractor = extractors().create("marching_cubes_topological");
  const ExtractSettings settings{.isovalue = 0.5f};
  const isolux::Run run{.threads = 1};
  std::vector<int> left(factors.size(), 0);
  for (int seed = 0; seed < count; ++seed) {
    const Volume volume = hard_case(size, std::uint64_t(seed));
    const Topology expected = topology(extractor->extract(volume, settings, run));
    for (std::size_t step = 0; step < factors.size(); ++step) {
      IsoMesh fine;
      const Volume samples = refined(volume, factors[step]);
      IsoExtractor(samples, run, IsoExtractor::Index::kNone).extract(settings, run, fine);
      if (topology(fine) == expected) break;
      ++left[step];
    }
  }
  std::cout << count << " random " << what << ":";
  for (std::size_t step = 0; step < factors.size(); ++step)
    std::cout << ' ' << left[step] << " differ at " << factors[step] << " steps a cell"
              << ",;"[step + 1 == factors.size()];
  std::cout << std::endl;
  return left.back();
}

TEST(Topology, OfCellsIsTheInterpolants) {
  // Necks thinner than 1/200 of a cell are beyond the finest sampling: about one random cell in thousands.
  const int count = 1000 * stress();
  EXPECT_LE(disagreements("cells", count, Index3(2), std::array{12, 48, 200}), 1 + count / 1000);
}

TEST(Topology, OfVolumesIsTheInterpolants) {
  // 27 cells each, so 27 times as many chances of such a neck, and steps that are coarser.
  const int count = 100 * stress();
  EXPECT_LE(disagreements("volumes of 27 cells", count, Index3(4), std::array{12, 60, 120}), 1 + count / 50);
}

TEST(Topology, EveryTunnelHasItsRing) {
  int tunnels = 0;
  for (int seed = 0; seed < 20000 * stress(); ++seed) {
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
  // Two opposite corners inside, near enough to the level for the middle to be inside too.
  Volume volume = sampled(Index3(2), {}, [](const Vec3& /*p*/) { return -1.0; });
  for (const float corner : {2.0f, 4.0f}) {
    volume.values(0, 0, 0) = corner;
    volume.values(1, 1, 1) = corner;
    const IsoMesh mesh = extractors().create("marching_cubes_topological")->extract(volume, {.isovalue = 0.0f}, {});
    // F on the diagonal is -1 + (corner + 1)(t^3 + (1 - t)^3), least in the middle: -1 + (corner + 1)/4.
    EXPECT_EQ(topology(mesh), (corner > 3.0f ? Topology{1, 0} : Topology{2, 2}));
  }
}

}  // namespace
}  // namespace isolux
