#include "stress_volumes.h"

#include <isolux/core/random.h>
#include <isolux/volume_io/analytic_fields.h>

#include <cmath>

namespace isolux::bench {
namespace {

Volume mapped(const Volume& volume, const std::function<float(int, int, int)>& value) {
  Volume result;
  result.name = volume.name;
  result.values = Grid<float>(volume.lattice());
  const Index3 n = volume.lattice().size;
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) result.values(i, j, k) = value(i, j, k);
    }
  }
  return result;
}

Volume with_frame(const Volume& volume, const IndexToWorld& frame) {
  Volume result = volume;
  const auto values = volume.values.values();
  result.values = Grid<float>(Lattice{.size = volume.lattice().size, .frame = frame}, {values.begin(), values.end()});
  return result;
}

}  // namespace

Volume closed_noise(int n, std::uint64_t seed) {
  const Volume noise = sample_analytic_field("noise", n, {.seed = seed});
  return mapped(noise, [&](int i, int j, int k) {
    const bool shell = i == 0 || j == 0 || k == 0 || i == n - 1 || j == n - 1 || k == n - 1;
    return shell ? 2.0f : noise.values(i, j, k);
  });
}

ValueRange open_gyroid() { return {.low = -1.2f, .high = 1.6f}; }

std::vector<Volume> nasty_volumes() {
  const Volume gyroid = sample_analytic_field("gyroid", 17);
  std::vector<Volume> volumes;
  for (const float scale : {1e30f, 1e-30f, -1e-30f}) {
    volumes.push_back(mapped(gyroid, [&](int i, int j, int k) { return scale * gyroid.values(i, j, k); }));
  }
  // Eight bits at the top of sixteen; two values only; one voxel in nothing.
  volumes.push_back(
      mapped(gyroid, [&](int i, int j, int k) { return 65400.0f + std::round(40.0f * gyroid.values(i, j, k)); }));
  volumes.push_back(mapped(gyroid, [&](int i, int j, int k) { return gyroid.values(i, j, k) > 0.0f ? 1.0f : 0.0f; }));
  volumes.push_back(mapped(gyroid, [](int i, int j, int k) { return i == 8 && j == 8 && k == 8 ? 1.0f : 0.0f; }));
  volumes.push_back(
      with_frame(gyroid, {.origin = Vec3(1e6), .axes = Mat3(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 20))}));
  volumes.push_back(with_frame(gyroid, {.origin = Vec3(0.0), .axes = Mat3(1e-12)}));
  return volumes;
}

std::vector<std::pair<std::string, Transformed>> transformations(const Run& run) {
  constexpr int kPoints = 17;
  const Volume noise = sample_analytic_field("noise", kPoints, run);
  const Volume bytes = mapped(noise, [&](int i, int j, int k) { return std::floor(256.0f * noise.values(i, j, k)); });
  const auto same = [](const Vec3& v) { return v; };
  const auto same_value = [](float h) { return h; };
  std::vector<std::pair<std::string, Transformed>> all;
  all.emplace_back("mirrored in x",
                   Transformed{.volume = bytes,
                               .transformed = mapped(
                                   bytes, [&](int i, int j, int k) { return bytes.values(kPoints - 1 - i, j, k); }),
                               .position = [](const Vec3& p) { return Vec3(kPoints - 1 - p.x, p.y, p.z); },
                               .direction = [](const Vec3& d) { return Vec3(-d.x, d.y, d.z); },
                               .isovalue = same_value});
  all.emplace_back("axes rotated",
                   Transformed{.volume = bytes,
                               .transformed = mapped(bytes, [&](int i, int j, int k) { return bytes.values(j, k, i); }),
                               .position = [](const Vec3& p) { return Vec3(p.z, p.x, p.y); },
                               .direction = [](const Vec3& d) { return Vec3(d.z, d.x, d.y); },
                               .isovalue = same_value});
  for (const float a : {4.0f, -1.0f}) {
    all.emplace_back(
        a > 0.0f ? "f -> 4 f + 8" : "f -> 8 - f, other side",
        Transformed{.volume = bytes,
                    .transformed = mapped(bytes, [&](int i, int j, int k) { return a * bytes.values(i, j, k) + 8.0f; }),
                    .position = same,
                    .direction = same,
                    .isovalue = [a](float h) { return a * h + 8.0f; },
                    .outer = a > 0.0f ? OuterSide::kLower : OuterSide::kHigher});
  }
  return all;
}

}  // namespace isolux::bench
