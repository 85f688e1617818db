#pragma once

#include <isolux/core/field.h>
#include <isolux/core/registry.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/indexed_mesh.h>
#include <isolux/mc_extract/iso_mesh.h>

#include <cstddef>
#include <cstdint>

namespace isolux {

/// Where vertex normals come from.
enum class NormalKind : std::uint8_t {
  kGradient,  ///< minus (or plus) the interpolated central differences of the field: smooth, independent of the
              ///< triangles, and those that the light is computed with
  kFaces,     ///< area-weighted mean of the adjacent triangles' normals
  kAccurate   ///< of a gradient of higher order, where the data are smooth: see set_accurate_normals
};

/// What becomes of a level set where it meets the box.
enum class CapKind : std::uint8_t {
  kNone,  ///< it ends there: boundary edges on the box's faces
  kBox    ///< the inner side's part of the box's faces is added: the mesh encloses what is inside, and is closed.
          ///< Vertices on the rim belong to both, or the mesh would not be closed, and have the surface's normal, of
          ///< whatever kind; the cap's others have the box's (cap_vertices.h).
};

struct ExtractSettings {
  float isovalue = 0.0f;
  OuterSide outer = OuterSide::kLower;
  NormalKind normals = NormalKind::kGradient;
  CapKind cap = CapKind::kNone;
  /// Connected components of fewer triangles (a cap's count) are left out; 0 keeps all.
  std::size_t min_component = 0;
};

/// The mc-extract stage: one level set as a mesh. Backends are immutable and callable from many threads.
class Extractor {
 public:
  static constexpr std::string_view kStage = "extractor";
  virtual ~Extractor() = default;

  /// The level set {f = isovalue}, open where it meets the box's faces (see `cap`); empty where there is none. Always
  /// an oriented 2-manifold: an edge inside the box has two faces, a vertex one fan. No triangle has zero area, as far
  /// as float coordinates can tell: a vertex that would lie on a grid point is kept 2^-10 of an edge away from it. \pre
  /// require_usable(volume). \throw Cancelled; InvalidInput if the mesh would not fit 2^31 half-edges, or the
  /// volume has more than 2^29 grid points a plane; marching_cubes also takes at most 65536 along x and y.
  [[nodiscard]] virtual IsoMesh extract(const VolumeView& volume, const ExtractSettings& settings,
                                        const Run& run) const = 0;
};

/// The arrays of a half-edge mesh; vertices and faces keep their order.
[[nodiscard]] IndexedMesh indexed_mesh(const IsoMesh& mesh);

/// marching_cubes, marching_tetrahedra, ...
[[nodiscard]] Registry<Extractor> extractors();

}  // namespace isolux
