#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace isolux {

/// Whose light the end of a ray reads: one of the eight texels around it, drawn by its trilinear weight, so that the
/// mean over the draws is the trilinear interpolant. Where the sites sit at the texels the target is a site (an unlit
/// texel stands for the nearest lit one, counted in steps across faces), else a texel.
class LinkTargets {
 public:
  /// Texels, whoever the sites are. \throw InvalidInput
  LinkTargets(const Volume& volume, const Lattice& texels);
  /// Sites where these sit at the texels. \throw InvalidInput, Cancelled
  LinkTargets(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run);

  [[nodiscard]] bool are_sites() const { return !site_of_texel_.empty(); }
  [[nodiscard]] const Lattice& texels() const { return texels_; }

  /// Uniform numbers for the draws of one site, as fractions of 2^32.
  struct Draws {
    std::uint32_t start[3];
  };
  [[nodiscard]] static Draws draws_of(std::uint64_t seed, std::size_t site);

  /// The target of ray `ray` that ends at `index`, a place in the volume's index space.
  [[nodiscard]] std::uint32_t target(const Vec3& index, const Draws& draws, std::uint32_t ray) const;

 private:
  /// The texel whose centre the place is within rounding; kNoLabel if there is none.
  [[nodiscard]] std::uint32_t texel_at(const Vec3f& index) const;

  Lattice texels_;
  IndexToWorld to_texel_;
  std::vector<std::uint32_t> site_of_texel_;  ///< empty if the sites do not sit at the texels
};

}  // namespace isolux
