// How long does it take to light all level sets of a volume to an error of .02 (uniform environment, no bounces, one
// texel a cell), and how long does Embree take to light the vertices of ONE isosurface of it to the same error? Axes:
// volume, method (every texel, texels by need, those with all bounces at albedo .8). Counters: the error reached (of
// Embree by two results with independent random numbers), rays, sites. Embree gets the fewest rays, a power of two of a
// low-discrepancy sequence for every vertex, that reach the error; its tree is built beforehand. One thread.
// ISOLUX_STRESS adds 256^3, ISOLUX_DATA real volumes.
#include <benchmark/benchmark.h>
#include <isolux/bake.h>
#include <isolux/core/stopwatch.h>
#include <isolux/volume_io/read.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#if defined(ISOLUX_BENCH_EMBREE)
#include <embree3/rtcore.h>
#include <isolux/core/random.h>
#include <isolux/mc_extract/extractor.h>

#include <array>
#endif

namespace {

using namespace isolux;

constexpr double kError = 0.02;

struct Case {
  std::string name;
  std::string source;
  float isovalue;
};

std::vector<Case> cases() {
  std::vector<Case> all = {{"gyroid_64", "gen:gyroid:64", 0.1f}, {"gyroid_128", "gen:gyroid:128", 0.1f}};
  if (std::getenv("ISOLUX_STRESS") != nullptr) {
    all.push_back({"gyroid_256", "gen:gyroid:256", 0.1f});
    all.push_back({"marschner_lobb_256", "gen:marschner-lobb:256", 0.5f});
    if (const char* folder = std::getenv("ISOLUX_DATA")) {
      all.push_back({"bonsai", std::string(folder) + "/bonsai.nrrd", 40.0f});
      all.push_back({"engine", std::string(folder) + "/engine.nrrd", 110.0f});
    }
  }
  return all;
}

Run one_thread() {
  Run run;
  run.threads = 1;
  return run;
}

void light_all_level_sets(benchmark::State& state, const Case& test, TexelSites texel_sites, int bounces) {
  const Volume volume = read_volume(test.source);
  BakeSettings settings;
  settings.trace.bounces = bounces;
  settings.texel_sites = texel_sites;
  settings.target_rmse = kError;
  BakeResult result;
  for (auto _ : state) result = bake(volume, Scene{}, settings, builtin_stages(), one_thread());
  state.counters["rays"] = double(result.counters.rays);
  state.counters["sites"] = double(result.sites);
  state.counters["rmse"] = result.rmse_estimate;
}

#if defined(ISOLUX_BENCH_EMBREE)

constexpr std::size_t kWidth = 16;

/// One isosurface in a scene of Embree's.
class Surface {
 public:
  explicit Surface(const IsoMesh& mesh)
      : mesh_(mesh), device_(rtcNewDevice("threads=1,set_affinity=0")), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.n_vertices()));
    for (const auto v : mesh.vertices())
      for (std::size_t a = 0; a < 3; ++a) *points++ = mesh.point(v)[a];
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.n_faces()));
    for (const auto f : mesh.faces())
      for (const auto v : mesh.fv_range(f)) *indices++ = unsigned(v.idx());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
  }
  ~Surface() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  /// e of every vertex.
  [[nodiscard]] std::vector<float> light(std::size_t rays, std::uint64_t seed) const {
    std::vector<float> e;
    e.reserve(mesh_.n_vertices());
    for (const auto v : mesh_.vertices()) e.push_back(light_at(v, rays, mix_bits(seed) + std::uint64_t(v.idx())));
    return e;
  }

 private:
  [[nodiscard]] float light_at(IsoMesh::VertexHandle v, std::size_t rays, std::uint64_t key) const {
    const auto p = mesh_.point(v);
    const auto n = mesh_.normal(v);
    // Duff et al., "Building an orthonormal basis, revisited" (2017).
    const float sign = std::copysign(1.0f, n[2]);
    const float a = -1.0f / (sign + n[2]);
    const float b = n[0] * n[1] * a;
    const std::uint64_t bits = mix_bits(key);
    const auto shift_u = std::uint32_t(bits);
    const auto shift_v = std::uint32_t(bits >> 32);
    std::size_t escaped = 0;
    for (std::size_t k = 0; k < rays; k += kWidth) {
      alignas(64) RTCRay16 packet{};
      alignas(64) std::array<int, kWidth> valid{};
      for (std::size_t i = 0; i < kWidth; ++i) {
        // Roberts' additive sequence (2018), shifted: as good as a net at these numbers of rays.
        const auto j = std::uint32_t(k + i);
        const float u = float((shift_u + j * 0xC13FA9A9u) >> 8) * 0x1p-24f;
        const float t = float((shift_v + j * 0x91E10DA5u) >> 8) * 0x1p-24f * 2.0f * std::numbers::pi_v<float>;
        const float r = std::sqrt(u);
        const float x = r * std::cos(t);
        const float y = r * std::sin(t);
        const float z = std::sqrt(1.0f - u);
        packet.org_x[i] = p[0];
        packet.org_y[i] = p[1];
        packet.org_z[i] = p[2];
        packet.dir_x[i] = x * (1.0f + sign * n[0] * n[0] * a) + y * b + z * n[0];
        packet.dir_y[i] = x * sign * b + y * (sign + n[1] * n[1] * a) + z * n[1];
        packet.dir_z[i] = -x * sign * n[0] - y * n[1] + z * n[2];
        packet.tnear[i] = 1e-4f;
        packet.tfar[i] = std::numeric_limits<float>::infinity();
        packet.mask[i] = ~0u;
        valid[i] = k + i < rays ? -1 : 0;
      }
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
      rtcOccluded16(valid.data(), scene_, &context, &packet);
      for (std::size_t i = 0; i < kWidth; ++i) escaped += std::size_t(valid[i] != 0 && packet.tfar[i] >= 0.0f);
    }
    return float(escaped) / float(rays);
  }

  const IsoMesh& mesh_;
  RTCDevice device_;
  RTCScene scene_;
};

double error_of(const Surface& surface, std::size_t rays) {
  const auto first = surface.light(rays, 1);
  const auto second = surface.light(rays, 2);
  double squares = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) squares += 0.5 * std::pow(double(first[i]) - double(second[i]), 2.0);
  return std::sqrt(squares / double(first.size()));
}

void light_one_isosurface(benchmark::State& state, const Case& test) {
  const Volume volume = read_volume(test.source);
  const IsoMesh mesh = extractors().create()->extract(volume, {.isovalue = test.isovalue}, one_thread());
  const Surface surface(mesh);
  std::size_t rays = kWidth;
  double error = error_of(surface, rays);
  for (; error > kError; error = error_of(surface, rays)) rays *= 2;
  for (auto _ : state) benchmark::DoNotOptimize(surface.light(rays, 1));
  state.counters["rays"] = double(rays) * double(mesh.n_vertices());
  state.counters["sites"] = double(mesh.n_vertices());
  state.counters["rmse"] = error;
}

#endif

const bool kRegistered = [] {
  for (const Case& test : cases()) {
    const auto add = [&](const char* name, TexelSites texel_sites, int bounces) {
      benchmark::RegisterBenchmark((std::string(name) + "/" + test.name).c_str(), light_all_level_sets, test,
                                   texel_sites, bounces)
          ->Unit(benchmark::kSecond)
          ->Iterations(1);
    };
    add("every_texel", TexelSites::kAll, 0);
    add("by_need", TexelSites::kNeeded, 0);
    add("by_need_all_bounces", TexelSites::kNeeded, kAllBounces);
#if defined(ISOLUX_BENCH_EMBREE)
    benchmark::RegisterBenchmark(("one_isosurface_embree/" + test.name).c_str(), light_one_isosurface, test)
        ->Unit(benchmark::kSecond)
        ->Iterations(1);
#endif
  }
  return true;
}();

}  // namespace
