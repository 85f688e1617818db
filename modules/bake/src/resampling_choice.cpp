#include "resampling_choice.h"

#include <cmath>

namespace isolux {
namespace {

// docs/resampling.md has the curves behind these.
constexpr double kFitSites = 8.0;   // a texel and cell
constexpr double kFineSites = 2.0;  // a texel
// One isovalue: the most texels that bricks of one number a voxel of the whole volume have room for.
constexpr double kOneIsovalueTexels = 1.7;
constexpr double kOneIsovalueSites = 16.0;  // a crossed cell
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
  if (settings.texels_a_cell == 0.0) settings.texels_a_cell = fit && one_isovalue(settings) ? kOneIsovalueTexels : 1.0;
  if (!fit) return;
  // Finer texels tell level sets apart themselves; all sites of one isovalue say nothing of how light changes with it.
  const bool fine = settings.texels_a_cell > 1.0;
  if (fine || one_isovalue(settings)) settings.resampler.settings.try_emplace("slopes", "false");
  if (settings.sites_a_cell != 0.0) return;
  if (fine && one_isovalue(settings)) {
    settings.sites_a_cell = kOneIsovalueSites;
  } else {
    settings.sites_a_cell = fine ? kFineSites * std::pow(settings.texels_a_cell, 3) : kFitSites;
  }
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
