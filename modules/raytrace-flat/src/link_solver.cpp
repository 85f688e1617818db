#include "link_solver.h"

#include <isolux/core/error.h>
#include <isolux/core/field.h>
#include <isolux/core/parallel.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "anderson.h"

namespace isolux {
namespace {

constexpr std::size_t kSitesABlock = 8192;

}  // namespace

TargetLight LightLinks::Solver::before_last(const SolveSettings& settings, std::span<const float> start,
                                            Solution& solution) {
  e_ = straight_.radiance;
  if (settings.bounces != kAllBounces) {
    for (int b = 1; b < settings.bounces; ++b) reflect(e_).swap(e_);
    solution.sweeps = settings.bounces;
    return at_targets(e_);
  }
  if (start.size() == e_.size()) std::copy(start.begin(), start.end(), e_.begin());
  Anderson anderson(run_);
  while (solution.sweeps < settings.most_sweeps) {
    ++solution.sweeps;
    solution.change = anderson.step(e_, reflect(e_));
    if (run_.progress) run_.progress("bounces", double(solution.sweeps) / double(settings.most_sweeps));
    if (solution.change <= settings.tolerance) break;
  }
  return at_targets(e_);
}

std::vector<float> LightLinks::Solver::reflect(const std::vector<float>& e) {
  const TargetLight light = at_targets(e);
  const std::size_t stride = light.stride();
  const std::size_t channels = light.channels;
  std::vector<float> next(straight_.size() * stride, 0.0f);
  for (const LinkRound& round : links_.rounds_->all) add_targets(round, stride, light.values, next, run_);
  std::vector<float> sloped;
  if (light.sloped) next.swap(sloped), next.resize(e.size());
  const std::vector<float>& sums = light.sloped ? sloped : next;
  parallel_blocks(straight_.size(), kSitesABlock, run_, "", [&](const Block& block) {
    for (std::size_t site = block.begin; site < block.end; ++site) {
      const float isovalue = straight_.sites.isovalues[site];
      const Vec3f albedo = scene_.albedo.at(isovalue) / float(links_.rays_[site]);
      for (std::size_t c = 0; c < channels; ++c) {
        float sum = sums[site * stride + c];
        if (light.sloped) sum += sums[site * stride + channels + c] * (isovalue - light.isovalue);
        next[site * channels + c] = straight_.radiance[site * channels + c] + albedo[int(c)] * sum;
      }
    }
  });
  return next;
}

TargetLight LightLinks::Solver::at_targets(const std::vector<float>& e) {
  const auto channels = std::size_t(straight_.channels);
  if (reads_sites()) return {.values = e, .channels = channels};
  if (!to_grid_) throw InvalidInput("the sites do not sit at the texels: bounces want a way from samples to a grid");
  seen_.radiance = e;
  IlluminationGrid grid = to_grid_(seen_);
  if (grid.lattice.size != links_.rounds_->targets->texels().size || grid.channels != straight_.channels)
    throw InvalidInput("the grid of reflected light is not of the links' texels and the scene's channels");
  if (!grid.detail.slopes.empty()) return sloped(grid);
  light_ = std::move(grid.values);
  return {.values = light_, .channels = channels};
}

TargetLight LightLinks::Solver::sloped(const IlluminationGrid& grid) {
  if (texels_.empty()) measure_texels();
  const auto channels = std::size_t(grid.channels);
  const std::vector<float>& slopes = grid.detail.slopes;
  light_.resize(2 * grid.values.size());
  parallel_blocks(texels_.size(), kSitesABlock, run_, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t from = t * channels + c;
        const std::size_t to = 2 * t * channels + c;
        light_[to] = grid.values[from] - slopes[from] * texels_[t];
        light_[to + channels] = slopes[from];
      }
    }
  });
  return {.values = light_, .channels = channels, .sloped = true, .isovalue = middle_};
}

void LightLinks::Solver::measure_texels() {
  double sum = 0.0;
  for (const float isovalue : straight_.sites.isovalues) sum += double(isovalue);
  middle_ = float(sum / double(std::max<std::size_t>(straight_.size(), 1)));
  const TrilinearField field(links_.volume_);
  const Lattice& texels = links_.rounds_->targets->texels();
  const IndexToWorld to_volume = index_to_index(texels, links_.volume_.lattice());
  const auto nx = std::size_t(texels.size.x);
  const auto ny = std::size_t(texels.size.y);
  texels_.resize(texels.count());
  parallel_blocks(texels_.size(), kSitesABlock, run_, "", [&](const Block& block) {
    for (std::size_t t = block.begin; t < block.end; ++t) {
      const Vec3 centre = to_volume.world({double(t % nx), double(t / nx % ny), double(t / (nx * ny))});
      texels_[t] = float(field.value(centre) - double(middle_));
    }
  });
}

}  // namespace isolux
