#pragma once

#include <isolux/core/field.h>
#include <isolux/core/lattice.h>
#include <isolux/core/sample_set.h>
#include <isolux/core/volume.h>
#include <isolux/raytrace_flat/scene.h>

#include <cstddef>
#include <vector>

namespace isolux {

/// The texels that points are read from, much as fill_unlit() leaves them: one without light of its own has that of the
/// lit ones around it.
struct TexelsAround {
  struct Part {
    std::size_t point;
    std::size_t site;
    double weight;  ///< of the site's light in the trilinear reading
    double own;     ///< of that, where it is the light of the site's own texel
  };
  Sites sites;  ///< the texels with light of their own, each once
  std::vector<Part> parts;
  std::vector<double> rest;  ///< the share of each point's reading that none of them has: what is filled from afar
};

/// `points` in the index space of `volume`.
[[nodiscard]] TexelsAround texels_around(const Volume& volume, OuterSide outer, const Lattice& texels,
                                         const Sites& points, GradientKind gradient);

/// What reading between texels says at each point.
struct Readings {
  std::vector<double> light;     ///< as SampleSet::radiance
  std::vector<double> variance;  ///< of that by rays
  std::vector<Vec3> openness;    ///< of the texels, read like their light; empty if it is not asked for
  double own = 0.0;              ///< the share of all readings that is texels' own light, not filled
};

/// `texels` are the traced sites of `around`, at least one, whose mean stands for what is filled from afar. `openness`
/// is before them, or empty, and `usual_openness` for texels without light of their own: nothing is taken off these.
[[nodiscard]] Readings read_between(const TexelsAround& around, const SampleSet& texels,
                                    const std::vector<Vec3f>& openness, const Vec3& usual_openness);

}  // namespace isolux
