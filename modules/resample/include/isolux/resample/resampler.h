#pragma once

#include <isolux/core/illumination_grid.h>
#include <isolux/core/registry.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstdint>
#include <vector>

namespace isolux {

/// A grid of light in which some texels may have got no value.
struct ResampledGrid {
  IlluminationGrid grid;
  std::vector<std::uint8_t> lit;  ///< one a texel: 1 where grid has a value, 0 where fill_unlit() has to give one
};

/// A grid none of whose texels has light as yet: NaN marks them, and takes no memory beside the values.
[[nodiscard]] IlluminationGrid unlit_grid(const Lattice& texels, int channels);
/// The same said by a byte a texel: what is NaN in such a grid is 0 and not lit. \throw InvalidInput if the grid is not
/// complete
[[nodiscard]] ResampledGrid told_by_bytes(IlluminationGrid marked);

/// The resample stage. Backends are immutable and callable from many threads.
class Resampler {
 public:
  static constexpr std::string_view kStage = "resampler";
  virtual ~Resampler() = default;

  /// The light at the texels of `texels`, a lattice over the box of `volume`. Distances are lengths in world units
  /// along the box's axes. Equal bits for any number of threads. \throw InvalidInput if there are no samples or they do
  /// not suit (numbers that are not finite, arrays of several lengths), or no texels; Cancelled
  [[nodiscard]] virtual ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                                               const Run& run) const = 0;

  /// Whether resample() makes something of lamps' light told apart.
  [[nodiscard]] virtual LampLight lamps() const { return LampLight::kWithin; }

  /// How the rays that make its samples are best spread over the sites.
  [[nodiscard]] virtual RaySpread spread() const { return RaySpread::kEven; }

  /// Whether samples can be put into a grid part by part: what a sample gives to which texel depends on no other one.
  [[nodiscard]] virtual bool takes_parts() const { return false; }
  /// Puts more samples into `texels`, which begins as unlit_grid() of their channels; no two parts have samples for one
  /// texel. All parts together, told_by_bytes(), are what resample() makes of all samples. Of the sites only positions
  /// are looked at, isovalues, normals and variances may be missing. \pre takes_parts() \throw as resample()
  virtual void add_part(const Volume& volume, const SampleSet& samples, IlluminationGrid& texels, const Run& run) const;

  /// Whether what it makes is read with near-field terms (NearFieldTerm), where these help.
  [[nodiscard]] virtual bool has_near_field() const { return false; }

  /// Gives a grid that was made of these samples, and perhaps of others like them, what LightReader wants beyond its
  /// values, once they are what they will be. By default nothing.
  virtual void add_detail(const Volume& /*volume*/, const SampleSet& /*samples*/, ResampledGrid& /*texels*/,
                          const Run& /*run*/) const {}
};

/// brute_force, cell_grid, cgal_kdtree (all Shepard), direct, ...
[[nodiscard]] Registry<Resampler> resamplers();

}  // namespace isolux
