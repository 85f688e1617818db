#include "resampling_choice.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

// docs/resampling.md has the curves behind these.
constexpr double kFitSites = 8.0;   // a texel
constexpr double kFineSites = 2.0;  // a texel without slopes
// All isovalues: the most texels that eight numbers a voxel have room for with slopes. Finer ones tell level sets apart
// themselves.
constexpr double kSlopedTexels = 1.6;
// Known isovalues: the most texels that bricks of one number a voxel of the whole volume have room for, of a single one
// without slopes and of a tenth of all with them.
constexpr double kOneIsovalueTexels = 1.7;
constexpr double kRangeTexels = 1.15;
constexpr double kKnownSites = 16.0;             // a crossed cell
constexpr const char* kWeakSlopePrior = "0.01";  // where sites a cell are many
/// A cell that a level set only just cuts may get no site; its texels are next to lit ones.
constexpr int kFilledLayers = 2;

bool one_isovalue(const BakeSettings& settings) {
  return settings.isovalues && settings.isovalues->low == settings.isovalues->high;
}

}  // namespace

void choose_resampling(BakeSettings& settings) {
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
  const bool one = one_isovalue(settings);
  const bool range = settings.isovalues && !one;
  if (settings.texels_a_cell == 0.0) {
    settings.texels_a_cell = 1.0;
    if (fit && !settings.texels) settings.texels_a_cell = one ? kOneIsovalueTexels : range ? kRangeTexels : 1.0;
  }
  if (!fit) return;
  // All sites of one isovalue say nothing of how light changes with it.
  const bool fine = settings.texels_a_cell > (range ? kRangeTexels : kSlopedTexels);
  Settings& options = settings.resampler.settings;
  if (fine || one) options.try_emplace("slopes", "false");
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
