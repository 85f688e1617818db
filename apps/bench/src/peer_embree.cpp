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
    RTCIntersectContext query = incoherent();
    // A ray that was stopped comes back with tfar = -infinity.
    const auto keep = [&](std::size_t r, float far) { hits[r] = far < 0.0f ? 1 : 0; };
    const Rays rays{origins, directions, near};
    if (call == EmbreeCall::kStream) {
      std::vector<RTCRay> all = ray_list(rays);
      rtcOccluded1M(scene_, &query, all.data(), unsigned(all.size()), sizeof(RTCRay));
      for (std::size_t r = 0; r < all.size(); ++r) keep(r, all[r].tfar);
    } else if (call == EmbreeCall::kPacketsOf8) {
      packets<8, RTCRay8>(
          rays, [&](const int* valid, auto& packet) { rtcOccluded8(valid, scene_, &query, &packet); }, keep);
    } else {
      packets<16, RTCRay16>(
          rays, [&](const int* valid, auto& packet) { rtcOccluded16(valid, scene_, &query, &packet); }, keep);
    }
  }

  void first_hits(EmbreeCall call, std::span<const Vec3f> origins, std::span<const Vec3f> directions, float near,
                  std::span<float> distances) const override {
    RTCIntersectContext query = incoherent();
    const auto keep = [&](std::size_t r, float far) { distances[r] = far; };
    const Rays rays{origins, directions, near};
    if (call == EmbreeCall::kStream) {
      const std::vector<RTCRay> all = ray_list(rays);
      std::vector<RTCRayHit> found(all.size());
      for (std::size_t r = 0; r < all.size(); ++r) found[r] = {.ray = all[r], .hit = nothing_hit<RTCHit>()};
      rtcIntersect1M(scene_, &query, found.data(), unsigned(found.size()), sizeof(RTCRayHit));
      for (std::size_t r = 0; r < all.size(); ++r) keep(r, found[r].ray.tfar);
    } else if (call == EmbreeCall::kPacketsOf8) {
      packets<8, RTCRay8>(
          rays,
          [&](const int* valid, auto& packet) {
            RTCRayHit8 found{.ray = packet, .hit = nothing_hit<RTCHit8>()};
            rtcIntersect8(valid, scene_, &query, &found);
            packet = found.ray;
          },
          keep);
    } else {
      packets<16, RTCRay16>(
          rays,
          [&](const int* valid, auto& packet) {
            RTCRayHit16 found{.ray = packet, .hit = nothing_hit<RTCHit16>()};
            rtcIntersect16(valid, scene_, &query, &found);
            packet = found.ray;
          },
          keep);
    }
  }

 private:
  struct Rays {
    std::span<const Vec3f> origins;
    std::span<const Vec3f> directions;
    float near;
  };

  static RTCIntersectContext incoherent() {
    RTCIntersectContext query;
    rtcInitIntersectContext(&query);
    query.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return query;
  }

  /// RTC_INVALID_GEOMETRY_ID in every place.
  template <class Hit>
  static Hit nothing_hit() {
    Hit hit;
    std::memset(&hit, 0xFF, sizeof(hit));
    return hit;
  }

  /// Calls keep(ray, tfar) for what query(valid, packet) leaves of packets of the rays.
  template <std::size_t kWidth, class Packet, class Query, class Keep>
  static void packets(const Rays& rays, const Query& query, const Keep& keep) {
    for (std::size_t first = 0; first < rays.origins.size(); first += kWidth) {
      const std::size_t count = std::min(kWidth, rays.origins.size() - first);
      alignas(64) std::array<int, kWidth> valid{};
      Packet packet{};
      for (std::size_t r = 0; r < count; ++r) {
        const Vec3f& o = rays.origins[first + r];
        const Vec3f& d = rays.directions[first + r];
        valid[r] = -1;
        packet.org_x[r] = o.x;
        packet.org_y[r] = o.y;
        packet.org_z[r] = o.z;
        packet.dir_x[r] = d.x;
        packet.dir_y[r] = d.y;
        packet.dir_z[r] = d.z;
        packet.tnear[r] = rays.near;
        packet.tfar[r] = std::numeric_limits<float>::infinity();
        packet.mask[r] = ~0u;
      }
      query(valid.data(), packet);
      for (std::size_t r = 0; r < count; ++r) keep(first + r, packet.tfar[r]);
    }
  }

  static std::vector<RTCRay> ray_list(const Rays& rays) {
    std::vector<RTCRay> list(rays.origins.size());
    for (std::size_t r = 0; r < list.size(); ++r) {
      const Vec3f& o = rays.origins[r];
      const Vec3f& d = rays.directions[r];
      list[r] = {.org_x = o.x,
                 .org_y = o.y,
                 .org_z = o.z,
                 .tnear = rays.near,
                 .dir_x = d.x,
                 .dir_y = d.y,
                 .dir_z = d.z,
                 .time = 0.0f,
                 .tfar = std::numeric_limits<float>::infinity(),
                 .mask = ~0u,
                 .id = 0,
                 .flags = 0};
    }
    return list;
  }

  RTCDevice device_;
  RTCScene scene_;
  double build_seconds_ = 0.0;
};

}  // namespace

std::unique_ptr<EmbreeMesh> EmbreeMesh::build(const IsoMesh& mesh) { return std::make_unique<Embree3Mesh>(mesh); }

std::string embree_version() {
  return fmt::format("{}, high build quality, incoherent rays in the fastest of its calls", RTC_VERSION_STRING);
}
#else
std::unique_ptr<EmbreeMesh> EmbreeMesh::build(const IsoMesh& /*mesh*/) { return nullptr; }

std::string embree_version() { return "not in this build"; }
#endif

}  // namespace isolux::bench
