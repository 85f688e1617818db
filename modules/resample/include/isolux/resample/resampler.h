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

/// The resample stage. Backends are immutable and callable from many threads.
class Resampler {
 public:
  static constexpr std::string_view kStage = "resampler";
  virtual ~Resampler() = default;

  /// The light at the texels of `texels`, a lattice over the box of `volume`. Distances are lengths in world units
  /// along the box's axes. Equal bits for any number of threads. \throw InvalidInput if there are no samples or they do
  /// not suit; Cancelled
  [[nodiscard]] virtual ResampledGrid resample(const Volume& volume, const SampleSet& samples, const Lattice& texels,
                                               const Run& run) const = 0;

  /// Gives a grid that resample() made of these samples what LightReader wants beyond its values, once they are what
  /// they will be. By default nothing.
  virtual void add_detail(const Volume& /*volume*/, const SampleSet& /*samples*/, ResampledGrid& /*texels*/,
                          const Run& /*run*/) const {}
};

/// brute_force, cell_grid, cgal_kdtree (all Shepard), direct, ...
[[nodiscard]] Registry<Resampler> resamplers();

}  // namespace isolux
