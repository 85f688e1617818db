#pragma once

#include <isolux/core/field.h>
#include <isolux/core/registry.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/texel_mask.h>

#include <cstddef>
#include <memory>
#include <optional>

namespace isolux {

struct SiteRequest {
  Lattice texels{};                         ///< the grid that the samples are for
  std::size_t count = 0;                    ///< sites wanted; 0: per_texel. `stratified` gives about so many; samplers
                                            ///< that sit at texels ignore both
  double per_texel = 1.0;                   ///< sites a texel of what can be lit
  std::optional<ValueRange> isovalues{};    ///< sites only on level sets within; `level_sets` widens a range
                                            ///< below 1e-3 of the volume's by so much at either end, as
                                            ///< float positions seldom lie on one level set
  std::shared_ptr<const TexelMask> only{};  ///< of `texels`; of samplers that sit at them, sites at these alone
  std::optional<ValueRange> values{};       ///< of the whole volume, where known: saves a pass
  OuterSide outer = OuterSide::kLower;
  GradientKind gradient = GradientKind::kCentralDifferences;
};

/// The stage that chooses sites. Backends are immutable and callable from many threads.
class SiteSampler {
 public:
  static constexpr std::string_view kStage = "sampler";
  virtual ~SiteSampler() = default;

  /// Sites in the box of `volume`, without those that have no normal or lie outside the isovalue range; equal for any
  /// number of threads. bake() refuses sites outside the box and those whose isovalue or normal is no number. \pre
  /// require_usable(volume). \throw Cancelled; InvalidInput for a mask of another size than the texels
  [[nodiscard]] virtual Sites sample(const Volume& volume, const SiteRequest& request, const Run& run) const = 0;
};

/// random, stratified, low_discrepancy, level_sets, texels
[[nodiscard]] Registry<SiteSampler> samplers();

/// Gives positions (index space) their isovalues and normals and drops those without a normal or outside the range: the
/// last step of every sampler, and the way to light given points such as a mesh's vertices.
[[nodiscard]] Sites make_sites(const Volume& volume, std::vector<Vec3f> positions, const SiteRequest& request,
                               const Run& run);

}  // namespace isolux
