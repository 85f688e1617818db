#include "resampling_choice.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

// docs/measured/resampling.md has the curves behind these.
constexpr double kFitSites = 8.0;   // a cell or texel
constexpr double kFineSites = 2.0;  // a texel without slopes

/// Texels a cell and axis of one kind of light.
struct FitDensity {
  double usual = 1.0;    ///< where the user does not say
  double normals = 1.0;  ///< the most with slopes along the normal: finer ones want the memory for themselves
  double slopes = 1.0;   ///< the most with slopes over the isovalue, likewise
};
// All isovalues: two numbers a voxel, five a texel; 1.58 texels without normals are eight a voxel, and the best of
// them.
constexpr FitDensity kSweep{.usual = 0.73, .normals = 1.4, .slopes = 1.6};
// Known isovalues: bricks of one number a voxel of the whole volume, of a single one (which says nothing of slopes over
// the isovalue) and of a tenth of all.
constexpr FitDensity kOneIsovalue{.usual = 0.97, .normals = 1.5, .slopes = 0.0};
constexpr FitDensity kRange{.usual = 0.8, .normals = 1.15, .slopes = 1.15};
constexpr double kKnownSites = 16.0;             // a crossed cell
constexpr const char* kWeakSlopePrior = "0.01";  // where sites a cell are many
/// A cell that a level set only just cuts may get no site; its texels are next to lit ones.
constexpr int kFilledLayers = 2;

bool one_isovalue(const BakeSettings& settings) {
  return settings.isovalues && settings.isovalues->low == settings.isovalues->high;
}

/// Texels a cell and axis, the axes' geometric mean.
double density_of(const Lattice& volume, const Index3& texels) {
  double density = 1.0;
  for (int a = 0; a < 3; ++a) density *= double(texels[a]) / double(std::max(volume.size[a] - 1, 1));
  return std::round(std::cbrt(density) * 1e6) / 1e6;  // the root's rounding must not cross a limit
}

}  // namespace

void name_resampling(BakeSettings& settings) {
  const bool fit = settings.resampler.name == "fit";
  if (settings.sampler.name.empty()) {
    if (fit) {
      settings.sampler.name = settings.isovalues ? "level_sets" : "stratified";
    } else {
      settings.sampler.name = settings.samples == 0 ? "texels" : "low_discrepancy";
    }
  }
  if (settings.resampler.name.empty())
    settings.resampler.name = settings.sampler.name == "texels" ? "direct" : "cell_grid";
}

void choose_density(BakeSettings& settings, const Lattice& volume) {
  const bool fit = settings.resampler.name == "fit";
  const bool one = one_isovalue(settings);
  const bool range = settings.isovalues && !one;
  const FitDensity& density = one ? kOneIsovalue : range ? kRange : kSweep;
  if (settings.texels_a_cell == 0.0) {
    const bool in_cells = settings.lattice == TexelLattice::kCells;
    if (settings.texels && in_cells)
      settings.texels_a_cell = density_of(volume, *settings.texels);
    else
      settings.texels_a_cell = fit && in_cells ? density.usual : 1.0;
  }
  // An error asked is that of the texels themselves, not of reading between them.
  if (settings.target_rmse > 0.0 && settings.resampler.settings.contains("denoise"))
    settings.resampler.settings.try_emplace("sharpen", "false");
  if (!fit) return;
  const bool fine = settings.texels_a_cell > density.slopes;
  Settings& options = settings.resampler.settings;
  if (settings.texels_a_cell > density.normals) options.try_emplace("normals", "false");
  if (fine) options.try_emplace("slopes", "false");
  if (range || settings.texels_a_cell > 1.0) options.try_emplace("slope_prior", kWeakSlopePrior);
  if (settings.sites_a_cell != 0.0) return;
  settings.sites_a_cell = settings.isovalues
                              ? kKnownSites
                              : (fine ? kFineSites : kFitSites) * std::pow(std::max(1.0, settings.texels_a_cell), 3);
}

double sites_a_texel(const Lattice& volume, const Lattice& texels, const BakeSettings& settings) {
  if (settings.sites_a_cell == 0.0) return 1.0;
  double sites = settings.sites_a_cell;
  for (int a = 0; a < 3; ++a) sites *= double(volume.size[a] - 1) / double(texels.size[a]);
  return sites;
}

FillSettings fill_for(const BakeSettings& settings) {
  if (settings.isovalues && settings.resampler.name == "fit") return {.layers = kFilledLayers};
  return {};
}

}  // namespace isolux
