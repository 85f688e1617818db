#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/release.h>
#include <isolux/core/run.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pass_levels.h"
#include "wide/draw_corners.h"

namespace isolux {

/// Isovalues at the centres of texels. \throw Cancelled
[[nodiscard]] std::vector<float> isovalues_at(const Volume& volume, const Lattice& texels, const Run& run);

/// Whose light the end of a ray reads: one of the eight texels around it, drawn by a weight, so that the mean over the
/// draws is an interpolant of them. Where the sites sit at the texels the target is a site (an unlit texel stands for
/// the nearest lit one, counted in steps across faces), else a texel.
///
/// The weight is trilinear and, unless the light read has slopes, falls with what lies between the isovalues of the
/// ray and of the texel (a bilateral weight: Tomasi & Manduchi, "Bilateral filtering for gray and color images", 1998;
/// here the range is the isovalue). A ray ends on its own level set; the light of the level sets around, which lie more
/// open on one side and less on the other, does not cancel out, and reflections multiply what is left of it.
class LinkTargets {
 public:
  /// How a texel's weight depends on its isovalue.
  enum class Weights : std::uint8_t { kTrilinear, kByIsovalue };

  /// Texels, whoever the sites are. By isovalue, these are the field's at the centres. \throw InvalidInput, Cancelled
  LinkTargets(const Volume& volume, const Lattice& texels, Weights weights, const Run& run);
  /// Sites where these sit at the texels, and then by their isovalues; else texels, trilinear. \pre the sites outlive
  /// this, in place. \throw InvalidInput, Cancelled
  LinkTargets(const Volume& volume, const Sites& sites, const Lattice& texels, const Run& run);
  LinkTargets(const LinkTargets&) = delete;
  LinkTargets& operator=(const LinkTargets&) = delete;

  /// From here on sites in pockets, from which nothing leads out of the box, read sites in pockets alone, and all
  /// others those outside; who finds none of its kind at a ray's end reads itself. With an albedo near 1 the least that
  /// is read across would light a pocket as if it were open. For sites at texels, in volumes of fewer than 2^32 - 1
  /// grid points; volume and sites outlive this. \throw Cancelled
  void part_pockets(const Volume& volume, const Sites& sites, OuterSide outer, const Run& run);

  [[nodiscard]] bool are_sites() const { return are_sites_; }
  [[nodiscard]] const Lattice& texels() const { return texels_; }

  /// Uniform numbers for the draws of one site, as fractions of 2^32.
  struct Draws {
    std::uint32_t start[3];
  };
  [[nodiscard]] static Draws draws_of(std::uint64_t seed, std::size_t site);

  /// Where a ray ends, in the volume's index space.
  struct End {
    Vec3f index;
    std::uint32_t ray;  ///< its number in the site's sequence
  };
  /// Appends the targets of rays of one site, at `from` in the volume's index space, in their order. \pre not let go
  void append_targets(std::span<const End> ends, const Vec3f& from, float isovalue, const Draws& draws,
                      std::vector<std::uint32_t>& targets) const;

  /// Lets go what append_targets() reads, 8 bytes a texel, and where there are pockets one more and 2 a grid point of
  /// the volume, once no more links are traced.
  void let_texels_go() {
    pass_levels_.reset();
    release(in_pocket_);
    release(site_of_texel_);
    release(own_isovalues_);
    isovalues_ = {};
  }

 private:
  /// Places of some ends and the numbers of their draws, no more than a part takes; what is read there is asked for.
  void ask_for(std::span<const End> ends, const Draws& draws, wide::CornerDraws& part) const;
  void draw_texels(wide::CornerDraws& part, std::size_t count, float isovalue, bool in_pocket,
                   std::uint32_t* texels) const;
  /// The texel whose centre the place is within rounding; kNoLabel if there is none.
  [[nodiscard]] std::uint32_t texel_at(const Vec3f& index) const;
  /// False if the sites do not sit at the texels, one each at most.
  [[nodiscard]] bool find_sites(const Sites& sites, const Run& run);

  Lattice texels_;
  IndexToWorld to_texel_;
  wide::PointGrid points_{};               ///< the texels, from the volume's index space
  std::array<std::uint32_t, 8> corner_{};  ///< of eight texels, less the lowest; bits: 1 is x, 2 is y, 4 is z
  bool are_sites_ = false;
  std::vector<std::uint32_t> site_of_texel_;  ///< empty if a site's number is its texel's, or the sites sit elsewhere
  std::vector<float> own_isovalues_;
  std::optional<PassLevels> pass_levels_;  ///< if any site is in a pocket
  std::vector<std::uint8_t> in_pocket_;    ///< whether a texel's site is, or who stands for it; empty if none is
  std::span<const float> isovalues_{};     ///< of the texels, or of who stands for them; empty: weights are trilinear
};

}  // namespace isolux
