// Rays per second of flattened lighting: 64 cosine-distributed rays a site, sites all over the volume, each ray
// confined to its own level set; against Embree on the triangles of one of these level sets. Axes: volume, question.
// ISOLUX_DATA adds real volumes. Run on one pinned core; the rates are of CPU time.
#include <benchmark/benchmark.h>
#include <isolux/core/random.h>
#include <isolux/raytrace_flat/gather.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#if defined(ISOLUX_BENCH_EMBREE)
#include <embree3/rtcore.h>
#include <isolux/mc_extract/extractor.h>
#endif

namespace {

using namespace isolux;

struct Case {
  std::string name;
  std::string source;
  float isovalue;  ///< of the mesh
};

std::vector<Case> cases() {
  std::vector<Case> all = {{"gyroid_64", "gen:gyroid:64", 0.1f},
                           {"gyroid_128", "gen:gyroid:128", 0.1f},
                           {"gyroid_256", "gen:gyroid:256", 0.1f},
                           {"marschner_lobb_256", "gen:marschner-lobb:256", 0.5f}};
  if (const char* folder = std::getenv("ISOLUX_DATA")) {
    all.push_back({"bonsai", std::string(folder) + "/bonsai.nrrd", 40.0f});
    all.push_back({"engine", std::string(folder) + "/engine.nrrd", 110.0f});
  }
  if (std::getenv("ISOLUX_STRESS") != nullptr) all.push_back({"gyroid_512", "gen:gyroid:512", 0.1f});
  return all;
}

const Volume& volume_of(const Case& test) {
  static std::map<std::string, Volume> volumes;
  const auto found = volumes.find(test.source);
  return found != volumes.end() ? found->second : volumes.emplace(test.source, read_volume(test.source)).first->second;
}

/// Sites uniform in the volume, of a sixteenth of the isovalues around the middle: what a bake with one site a voxel
/// would have in sixteen of its 255 buckets, thinned out.
Sites bake_sites(const Volume& volume, std::size_t count) {
  const TrilinearField field(volume);
  const Vec3 extent(volume.lattice().size - 1);
  RandomStream random(7, 0);
  const auto place = [&] {
    return Vec3f(Vec3(random.uniform_double(), random.uniform_double(), random.uniform_double()) * extent);
  };
  const auto normal = [&](const Vec3f& p) {
    return field.normal(Vec3(p), OuterSide::kLower, GradientKind::kCentralDifferences);
  };
  std::vector<float> values;
  while (values.size() < 20000) {
    const Vec3f p = place();
    if (normal(p) != Vec3(0.0)) values.push_back(float(field.value(Vec3(p))));
  }
  std::sort(values.begin(), values.end());
  const float low = values[values.size() / 2];
  const float high = values[values.size() / 2 + values.size() / 16];
  Sites sites;
  while (sites.size() < count) {
    const Vec3f p = place();
    const auto value = float(field.value(Vec3(p)));
    if (value < low || value > high) continue;
    const Vec3 n = normal(p);
    if (n == Vec3(0.0)) continue;
    sites.positions.push_back(p);
    sites.isovalues.push_back(value);
    sites.normals.emplace_back(n);
  }
  return sites;
}

void gather_rays(benchmark::State& state, const Case& test, RayQuestion question, int threads) {
  const Volume& volume = volume_of(test);
  // From 256^3 on as dense, so that occupancies weigh the same.
  const std::size_t count = volume.lattice().count();
  const std::size_t bake = std::min(count / 16, std::max<std::size_t>(262144, count / 64));
  const Sites sites = bake_sites(volume, bake);
  Run run;
  run.threads = threads;
  TraceCounters counters;
  for (auto _ : state)
    counters = gather(volume, sites, {.rays = 64, .question = question}, run, [](const GatheredRays&) {});
  const auto rays = double(counters.rays);
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["hits"] = double(counters.hits) / rays;
  state.counters["proven"] = double(counters.proven) / rays;
  state.counters["leaps"] = double(counters.macrocells) / rays;
  state.counters["cells"] = double(counters.cells) / rays;
}

#if defined(ISOLUX_BENCH_EMBREE)

/// The triangles of one level set in a scene of Embree's.
class EmbreeMesh {
 public:
  explicit EmbreeMesh(const IsoMesh& mesh)
      : device_(rtcNewDevice("threads=1,set_affinity=0")), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.n_vertices()));
    for (const auto v : mesh.vertices())
      for (int a = 0; a < 3; ++a) *points++ = mesh.point(v)[std::size_t(a)];
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
  ~EmbreeMesh() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;
  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

struct SurfacePoint {
  Vec3f position;  ///< world
  Vec3f normal;
};

std::vector<SurfacePoint> surface_points(const IsoMesh& mesh, std::size_t count) {
  // Vertices, evenly chosen: they come in the order of their cells, hence coherent in memory as a Morton order is.
  std::vector<SurfacePoint> points;
  const std::size_t step = std::max<std::size_t>(1, mesh.n_vertices() / count);
  for (std::size_t v = 0; v < mesh.n_vertices(); v += step) {
    const auto handle = mesh.vertex_handle(unsigned(v));
    const auto p = mesh.point(handle);
    const auto n = mesh.normal(handle);
    points.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}});
  }
  return points;
}

/// 64 cosine directions about +z, the same for each point: their making costs Embree nothing here.
std::vector<Vec3f> hemisphere() {
  std::vector<Vec3f> directions;
  for (int i = 0; i < 64; ++i) {
    const double u = (i % 8 + 0.5) / 8.0;
    const double angle = 2.0 * 3.14159265358979 * (double(i) / 8.0 + 0.5) / 8.0;
    directions.emplace_back(std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1.0 - u));
  }
  return directions;
}

/// Embree's part of a case: the mesh, and what is asked of it.
class EmbreeRays {
 public:
  explicit EmbreeRays(const Case& test)
      : mesh_(extractors().create()->extract(volume_of(test), {.isovalue = test.isovalue}, {})),
        embree_(mesh_),
        points_(surface_points(mesh_, 50000)),
        directions_(hemisphere()),
        offset_(1e-4f * float(glm::length(volume_of(test).lattice().frame.spacing()))) {
    rtcInitIntersectContext(&context_);
    context_.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }

  [[nodiscard]] RTCScene scene() const { return embree_.scene(); }
  [[nodiscard]] RTCIntersectContext* context() { return &context_; }

  /// Calls ask(origin, the 64 directions) for every point.
  template <class Ask>
  void for_each_point(const Ask& ask) const {
    Vec3f directions[64];
    for (const SurfacePoint& point : points_) {
      const Vec3f n = point.normal;
      const float sign = std::copysign(1.0f, n.z);
      const float a = -1.0f / (sign + n.z);
      const float b = n.x * n.y * a;
      const Vec3f x(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
      const Vec3f y(b, sign + n.y * n.y * a, -n.y);
      for (std::size_t i = 0; i < 64; ++i)
        directions[i] = directions_[i].x * x + directions_[i].y * y + directions_[i].z * n;
      ask(point.position + offset_ * n, directions);
    }
  }

  void report(benchmark::State& state, std::size_t hits) const {
    const double rays = 64.0 * double(points_.size());
    state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["hits"] = double(hits) / rays;
    state.counters["triangles"] = double(mesh_.n_faces());
  }

 private:
  IsoMesh mesh_;
  EmbreeMesh embree_;
  std::vector<SurfacePoint> points_;
  std::vector<Vec3f> directions_;
  float offset_;
  RTCIntersectContext context_;
};

void embree_occluded8(benchmark::State& state, const Case& test) {
  EmbreeRays embree(test);
  alignas(64) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
  std::size_t hits = 0;
  for (auto _ : state) {
    hits = 0;
    embree.for_each_point([&](const Vec3f& o, const Vec3f* d) {
      for (std::size_t first = 0; first < 64; first += 8) {
        alignas(64) RTCRay8 rays;
        for (std::size_t i = 0; i < 8; ++i) {
          rays.org_x[i] = o.x;
          rays.org_y[i] = o.y;
          rays.org_z[i] = o.z;
          rays.dir_x[i] = d[first + i].x;
          rays.dir_y[i] = d[first + i].y;
          rays.dir_z[i] = d[first + i].z;
          rays.tnear[i] = 0.0f;
          rays.tfar[i] = INFINITY;
          rays.time[i] = 0.0f;
          rays.mask[i] = ~0u;
          rays.flags[i] = 0;
        }
        rtcOccluded8(valid, embree.scene(), embree.context(), &rays);
        for (const float far : rays.tfar) hits += std::size_t(far < 0.0f);
      }
    });
  }
  embree.report(state, hits);
}

/// The same rays as a stream, 64 at a time.
void embree_stream(benchmark::State& state, const Case& test) {
  EmbreeRays embree(test);
  std::size_t hits = 0;
  for (auto _ : state) {
    hits = 0;
    embree.for_each_point([&](const Vec3f& o, const Vec3f* d) {
      RTCRay rays[64];
      for (std::size_t i = 0; i < 64; ++i)
        rays[i] = {o.x, o.y, o.z, 0.0f, d[i].x, d[i].y, d[i].z, 0.0f, INFINITY, ~0u, 0, 0};
      rtcOccluded1M(embree.scene(), embree.context(), rays, 64, sizeof(RTCRay));
      for (const RTCRay& ray : rays) hits += std::size_t(ray.tfar < 0.0f);
    });
  }
  embree.report(state, hits);
}

#endif

void register_all() {
  for (const Case& test : cases()) {
    const auto add = [&](const std::string& name, auto function) {
      benchmark::RegisterBenchmark((name + "/" + test.name).c_str(), function)->Unit(benchmark::kMillisecond);
    };
    add("any_hit", [test](benchmark::State& s) { gather_rays(s, test, RayQuestion::kAnyHit, 1); });
    add("first_hit", [test](benchmark::State& s) { gather_rays(s, test, RayQuestion::kFirstHit, 1); });
#if defined(ISOLUX_BENCH_EMBREE)
    add("embree_occluded8", [test](benchmark::State& s) { embree_occluded8(s, test); });
    add("embree_stream", [test](benchmark::State& s) { embree_stream(s, test); });
#endif
    benchmark::RegisterBenchmark(("any_hit_two_threads/" + test.name).c_str(),
                                 [test](benchmark::State& s) { gather_rays(s, test, RayQuestion::kAnyHit, 2); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

const bool kRegistered = (register_all(), true);

}  // namespace
