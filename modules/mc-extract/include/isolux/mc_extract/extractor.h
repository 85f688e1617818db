#pragma once

#include <isolux/core/field.h>
#include <isolux/core/registry.h>
#include <isolux/core/run.h>
#include <isolux/core/volume.h>
#include <isolux/mc_extract/iso_mesh.h>

namespace isolux {

/// Where vertex normals come from.
enum class NormalKind {
  kGradient,  ///< minus (or plus) the interpolated central differences of the field: smooth, independent of the
              ///< triangles
  kFaces      ///< area-weighted mean of the adjacent triangles' normals
};

struct ExtractSettings {
  float isovalue = 0.0f;
  OuterSide outer = OuterSide::kLower;
  NormalKind normals = NormalKind::kGradient;
};

/// The mc-extract stage: one level set as a mesh. Backends are immutable and callable from many threads.
class Extractor {
 public:
  static constexpr std::string_view kStage = "extractor";
  virtual ~Extractor() = default;

  /// The level set {f = isovalue}, open where it meets the box's faces; empty where there is none.
  /// \pre require_usable(volume). \throw Cancelled; InvalidInput if the mesh would not fit 2^31 half-edges.
  [[nodiscard]] virtual IsoMesh extract(const Volume& volume, const ExtractSettings& settings,
                                        const Run& run) const = 0;
};

/// marching_cubes, marching_tetrahedra, ...
[[nodiscard]] Registry<Extractor> extractors();

}  // namespace isolux
