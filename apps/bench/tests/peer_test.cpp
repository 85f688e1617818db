#include <gtest/gtest.h>
#include <isolux/mc_extract/extractor.h>
#include <isolux/volume_io/analytic_fields.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "peer_embree.h"

namespace isolux::bench {
namespace {

class EmbreeCalls : public testing::TestWithParam<EmbreeCall> {};

TEST_P(EmbreeCalls, FindASphereWhereItIs) {
  constexpr float kRadius = 0.3f;
  const Volume volume = sample_analytic_field("sphere", 65);
  const IsoMesh mesh = extractors().create()->extract(volume, {.isovalue = -kRadius}, {});
  const auto embree = EmbreeMesh::build(mesh);
  if (embree == nullptr) GTEST_SKIP() << "Embree is " << embree_version();
  // More than a packet and not a whole number of them; from outside, past the sphere or into it.
  constexpr int kRays = 37;
  std::vector<Vec3f> origins;
  std::vector<Vec3f> directions(kRays, Vec3f(0.0f, 0.0f, 1.0f));
  for (int i = 0; i < kRays; ++i) origins.emplace_back(0.51f, 0.03f + 0.0257f * float(i), 0.05f);
  std::vector<std::uint8_t> hits(kRays);
  std::vector<float> distances(kRays);
  embree->occluded(GetParam(), origins, directions, 1e-4f, hits);
  embree->first_hits(GetParam(), origins, directions, 1e-4f, distances);
  int met = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const float squared = 0.01f * 0.01f + (origins[i].y - 0.5f) * (origins[i].y - 0.5f);
    const float way = kRadius * kRadius - squared;
    if (std::fabs(way) < 0.003f) continue;  // triangles lie within the sphere
    met += way > 0.0f ? 1 : 0;
    EXPECT_EQ(hits[i], way > 0.0f ? 1 : 0) << i;
    if (way > 0.0f)
      EXPECT_NEAR(distances[i], 0.45f - std::sqrt(way), 2e-3f) << i;
    else
      EXPECT_EQ(distances[i], std::numeric_limits<float>::infinity()) << i;
  }
  EXPECT_GT(met, 20);
}

INSTANTIATE_TEST_SUITE_P(Bench, EmbreeCalls,
                         testing::Values(EmbreeCall::kPacketsOf8, EmbreeCall::kPacketsOf16, EmbreeCall::kStream));

}  // namespace
}  // namespace isolux::bench
