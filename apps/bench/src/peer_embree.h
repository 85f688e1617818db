#pragma once

#include <isolux/core/vec.h>
#include <isolux/mc_extract/iso_mesh.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isolux::bench {

/// Embree's version and how it is used, or that it is not in this build.
[[nodiscard]] std::string embree_version();

/// How rays are handed to Embree: the ways that its documentation has for many incoherent rays. Which is the fastest
/// depends on the processor, so the suites measure all and take the best.
enum class EmbreeCall : std::uint8_t { kPacketsOf8, kPacketsOf16, kStream };

/// "packets of 8", ...
[[nodiscard]] std::string_view embree_call_name(EmbreeCall call);

/// Embree's tree over a triangle mesh, as its documentation recommends for speed: a static high-quality tree, rays
/// flagged as incoherent.
class EmbreeMesh {
 public:
  /// Null where Embree is not in this build.
  [[nodiscard]] static std::unique_ptr<EmbreeMesh> build(const IsoMesh& mesh);
  virtual ~EmbreeMesh() = default;

  [[nodiscard]] virtual double build_seconds() const = 0;
  /// 1 for every ray that hits the mesh beyond `near` along it. Single-threaded; callable from many threads.
  /// \param directions unit
  virtual void occluded(EmbreeCall call, std::span<const Vec3f> origins, std::span<const Vec3f> directions, float near,
                        std::span<std::uint8_t> hits) const = 0;
  /// The distance of the first triangle that a ray hits beyond `near`; infinity for rays that hit none. As occluded().
  virtual void first_hits(EmbreeCall call, std::span<const Vec3f> origins, std::span<const Vec3f> directions,
                          float near, std::span<float> distances) const = 0;
};

}  // namespace isolux::bench
