#include "peer_embree.h"

#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#ifdef ISOLUX_HAS_EMBREE
#include <embree3/rtcore.h>
#include <fmt/format.h>
#endif

namespace isolux::bench {

std::string_view embree_call_name(EmbreeCall call) {
  if (call == EmbreeCall::kStream) return "stream";
  return call == EmbreeCall::kPacketsOf8 ? "packets of 8" : "packets of 16";
}

#ifdef ISOLUX_HAS_EMBREE
namespace {

class Embree3Mesh final : public EmbreeMesh {
 public:
  explicit Embree3Mesh(const IsoMesh& mesh) : device_(rtcNewDevice("threads=0")), scene_(rtcNewScene(device_)) {
    const Stopwatch watch;
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.n_vertices()));
    std::memcpy(points, mesh.points(), mesh.n_vertices() * 3 * sizeof(float));
    auto* triangles = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.n_faces()));
    for (const auto face : mesh.faces()) {
      for (const auto vertex : face.vertices()) *triangles++ = unsigned(vertex.idx());
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    build_seconds_ = watch.seconds();
  }
  ~Embree3Mesh() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Embree3Mesh(const Embree3Mesh&) = delete;
  Embree3Mesh& operator=(const Embree3Mesh&) = delete;

  [[nodiscard]] double build_seconds() const override { return build_seconds_; }

  void occluded(EmbreeCall call, std::span<const Vec3f> origins, std::span<const Vec3f> directions, float near,
                std::span<std::uint8_t> hits) const override {
    RTCIntersectContext query;
    rtcInitIntersectContext(&query);
    query.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    if (call == EmbreeCall::kStream) {
      stream(query, origins, directions, near, hits);
    } else if (call == EmbreeCall::kPacketsOf8) {
      packets<8, RTCRay8>(query, origins, directions, near, hits, rtcOccluded8);
    } else {
      packets<16, RTCRay16>(query, origins, directions, near, hits, rtcOccluded16);
    }
  }

 private:
  template <std::size_t kWidth, class Packet, class Query>
  void packets(RTCIntersectContext& query, std::span<const Vec3f> origins, std::span<const Vec3f> directions,
               float near, std::span<std::uint8_t> hits, Query query_packet) const {
    for (std::size_t first = 0; first < origins.size(); first += kWidth) {
      const std::size_t count = std::min(kWidth, origins.size() - first);
      alignas(64) std::array<int, kWidth> valid{};
      Packet rays{};
      for (std::size_t r = 0; r < count; ++r) {
        const Vec3f& o = origins[first + r];
        const Vec3f& d = directions[first + r];
        valid[r] = -1;
        rays.org_x[r] = o.x;
        rays.org_y[r] = o.y;
        rays.org_z[r] = o.z;
        rays.dir_x[r] = d.x;
        rays.dir_y[r] = d.y;
        rays.dir_z[r] = d.z;
        rays.tnear[r] = near;
        rays.tfar[r] = std::numeric_limits<float>::infinity();
        rays.mask[r] = ~0u;
      }
      query_packet(valid.data(), scene_, &query, &rays);
      // A ray that was stopped comes back with tfar = -infinity.
      for (std::size_t r = 0; r < count; ++r) hits[first + r] = rays.tfar[r] < 0.0f ? 1 : 0;
    }
  }

  void stream(RTCIntersectContext& query, std::span<const Vec3f> origins, std::span<const Vec3f> directions, float near,
              std::span<std::uint8_t> hits) const {
    std::vector<RTCRay> rays(origins.size());
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const Vec3f& o = origins[r];
      const Vec3f& d = directions[r];
      rays[r] = {.org_x = o.x,
                 .org_y = o.y,
                 .org_z = o.z,
                 .tnear = near,
                 .dir_x = d.x,
                 .dir_y = d.y,
                 .dir_z = d.z,
                 .time = 0.0f,
                 .tfar = std::numeric_limits<float>::infinity(),
                 .mask = ~0u,
                 .id = 0,
                 .flags = 0};
    }
    rtcOccluded1M(scene_, &query, rays.data(), unsigned(rays.size()), sizeof(RTCRay));
    for (std::size_t r = 0; r < rays.size(); ++r) hits[r] = rays[r].tfar < 0.0f ? 1 : 0;
  }

  RTCDevice device_;
  RTCScene scene_;
  double build_seconds_ = 0.0;
};

}  // namespace

std::unique_ptr<EmbreeMesh> EmbreeMesh::build(const IsoMesh& mesh) { return std::make_unique<Embree3Mesh>(mesh); }

std::string embree_version() {
  return fmt::format("{}, any hit, high build quality, incoherent rays in the fastest of its calls",
                     RTC_VERSION_STRING);
}
#else
std::unique_ptr<EmbreeMesh> EmbreeMesh::build(const IsoMesh& /*mesh*/) { return nullptr; }

std::string embree_version() { return "not in this build"; }
#endif

}  // namespace isolux::bench
