#pragma once

#include <isolux/core/vec.h>
#include <isolux/mc_extract/iso_mesh.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace isolux::bench {

/// Embree's version and how it is used, or that it is not in this build.
[[nodiscard]] std::string embree_version();

/// Embree's tree over a triangle mesh, as its documentation recommends for speed: a static high-quality tree, rays in
/// packets of 16 for any hit, incoherent.
class EmbreeMesh {
 public:
  /// Null where Embree is not in this build.
  [[nodiscard]] static std::unique_ptr<EmbreeMesh> build(const IsoMesh& mesh);
  virtual ~EmbreeMesh() = default;

  [[nodiscard]] virtual double build_seconds() const = 0;
  /// 1 for every ray that hits the mesh beyond `near` along it. Single-threaded; callable from many threads.
  /// \param directions unit
  virtual void occluded(std::span<const Vec3f> origins, std::span<const Vec3f> directions, float near,
                        std::span<std::uint8_t> hits) const = 0;
};

}  // namespace isolux::bench
