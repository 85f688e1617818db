#include "need_steps.h"

#include <algorithm>
#include <array>
#include <bit>

namespace isolux {
namespace {

constexpr float kMostRaysATexel = 0x1p18f;
/// Variances of nets fall as rays^-1.5 where light has edges.
constexpr double kDoubling = 0.354;
/// Rough light that is interpolated: a third of its difference from its surroundings if smooth, all of it at edges.
constexpr double kInterpolated = 0.33;
/// What is left of a rough difference at half the distance, squared: between smooth light (1/16) and edges (1/2).
constexpr double kHalved = 0.2;
/// The mean over the surroundings has noise of its own.
constexpr double kNoiseLeft = 0.07;
constexpr std::size_t kFewestSteps = 50;  ///< one of so many

/// A cell that could be refined, or a texel whose rays could be doubled.
struct Step {
  std::uint32_t at = 0;    ///< number of the cell in its level, or the texel's place in texels()
  std::int32_t level = 0;  ///< of the cell; kDoubles for a texel
  float gain = 0.0f;       ///< of squared error, over all texels concerned
  float rays = 0.0f;
};
constexpr std::int32_t kDoubles = -1;

/// Rises with the gain for a ray, in steps of a sixteenth: the upper bits of a positive float.
std::size_t rank_of(const Step& step) { return std::bit_cast<std::uint32_t>(step.gain / step.rays) >> 19; }
constexpr std::size_t kRanks = std::size_t(1) << 13;

struct Sums {
  double squared = 0.0;  ///< error
  double texels = 0.0;
  double single = 0.0;  ///< of them, those that are traced each
};

std::vector<Step> refinements(const TexelPyramid& pyramid, Sums& sums) {
  std::vector<Step> steps;
  pyramid.for_each_cell([&](const TexelPyramid::Cell& cell, const CellFigures& figures) {
    const auto texels = double(pyramid.texels_of(cell));
    const double before = squared_error(figures, cell.level);
    sums.squared += texels * before;
    sums.texels += texels;
    if (cell.level + 1 == TexelPyramid::kLevels) {
      sums.single += texels;
      return;
    }
    CellFigures finer = figures;
    finer.roughness *= kHalved;
    const double gain = texels * (before - squared_error(finer, cell.level + 1));
    if (gain > 0.0) steps.push_back({pyramid.number_of(cell), cell.level, float(gain), 7.0f * float(kRaysByNeed)});
  });
  return steps;
}

void add_doublings(const TexelPyramid& pyramid, const Run& run, std::vector<Step>& steps) {
  const std::span<const std::uint32_t> rays = pyramid.traced().rays;
  pyramid.for_each_traced(run, [&](std::size_t place, int level, const CellFigures& figures) {
    const double texels =
        double(TexelPyramid::stride(level)) * TexelPyramid::stride(level) * TexelPyramid::stride(level);
    CellFigures more = figures;
    more.noise *= kDoubling;
    const double gain = texels * (squared_error(figures, level) - squared_error(more, level));
    if (gain > 0.0 && float(rays[place]) < kMostRaysATexel)
      steps.push_back({std::uint32_t(place), kDoubles, float(gain), float(rays[place])});
  });
}

/// The rank from which on steps are taken.
std::size_t lowest_rank(const std::vector<Step>& steps, double wanted_gain) {
  std::vector<double> gains(kRanks, 0.0);
  std::vector<std::size_t> counts(kRanks, 0);
  for (const Step& step : steps) {
    gains[rank_of(step)] += double(step.gain);
    ++counts[rank_of(step)];
  }
  double gained = 0.0;
  std::size_t taken = 0;
  std::size_t rank = kRanks;
  while (rank > 0 && (gained < wanted_gain || taken < steps.size() / kFewestSteps + 1)) {
    --rank;
    gained += gains[rank];
    taken += counts[rank];
  }
  return rank;
}

}  // namespace

double squared_error(const CellFigures& figures, int level) {
  const bool traced = level + 1 == TexelPyramid::kLevels;
  return figures.kept() * figures.noise + kNoiseLeft * figures.noise +
         (traced ? 0.0 : kInterpolated * figures.roughness);
}

NeedSteps choose_steps(const TexelPyramid& pyramid, double goal, const Run& run) {
  Sums sums;
  std::vector<Step> steps = refinements(pyramid, sums);
  add_doublings(pyramid, run, steps);
  const std::size_t lowest = lowest_rank(steps, (1.0 - goal) * sums.squared);
  NeedSteps chosen;
  for (const Step& step : steps) {
    if (rank_of(step) < lowest) continue;
    if (step.level == kDoubles) {
      chosen.doubled.push_back(step.at);
    } else {
      chosen.refined.push_back(pyramid.cell_of(step.level, step.at));
      if (step.level + 2 == TexelPyramid::kLevels) sums.single += double(pyramid.texels_of(chosen.refined.back()));
    }
  }
  chosen.single_part = sums.texels > 0.0 ? sums.single / sums.texels : 0.0;
  return chosen;
}

}  // namespace isolux
