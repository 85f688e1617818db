#include "bake_command.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/machine_memory.h>

#include <utility>

#include "parse.h"
#include "session.h"

namespace isolux {
namespace {

/// What --sites need does not go with: bake() would find out when the volume has been read. Empty if nothing.
std::string against_need(const BakeOptions& options, const BakeSettings& settings) {
  if (settings.sampler.name != "texels") {
    const std::string whose = fmt::format("scattered sites (sampler {}, resampler {}) take a number of rays",
                                          settings.sampler.name, settings.resampler.name);
    if (options.rmse > 0.0) return whose + ", not --rmse";
    if (options.time > 0.0) return whose + ", not --time";
    if (iterates(settings) && settings.trace.bounces != 0) return whose + ", their reflections --bounce-method paths";
    return {};
  }
  if (settings.resampler.name != "direct") return "--resampler " + settings.resampler.name + ": allowed is direct";
  if (options.rmse <= 0.0) return "allowed with --rmse alone, or with scattered sites (--resampler fit, --samples)";
  if (options.time > 0.0) return "with --rmse alone, not --time";
  if (settings.tracer.name != "wide") return "--tracer " + settings.tracer.name + ": allowed is wide";
  if (settings.trace.bounces != 0 && !iterates(settings)) {
    return options.bounce_method.empty()
               ? "a tracer that is named or set follows paths; give --bounce-method iterated too"
               : "--bounce-method paths: allowed is iterated";
  }
  if (!settings.resampler.settings.empty()) return "--set resampler: allowed are the defaults";
  return {};
}

/// \throw UsageError
void require_agreement(const BakeOptions& options, const BakeSettings& settings) {
  const bool at_texels = settings.sampler.name == "texels";
  if (options.samples > 0 && at_texels)
    throw UsageError("--samples: sampler texels has one site at each texel; allowed are the others");
  if (settings.resampler.name == "direct" && !at_texels)
    throw UsageError(fmt::format("--resampler direct: it takes one site at each texel, not those of sampler {}{}",
                                 settings.sampler.name, options.samples > 0 ? " (--samples)" : ""));
  if (settings.lattice == TexelLattice::kVoxels && (options.chooses_texels() || options.texels_a_cell > 0.0))
    throw UsageError(fmt::format("--lattice voxels: it has one texel a voxel, and {} asks for others",
                                 options.chooses_texels() ? "--texels auto" : "--texels-a-cell"));
  const bool is_wide = settings.tracer.name == "wide" && settings.tracer.settings.empty();
  if (iterates(settings) && settings.trace.bounces != 0 && !is_wide)
    throw UsageError(
        fmt::format("--bounce-method iterated: tracer wide with its defaults traces for it, not {}{}; paths take any",
                    settings.tracer.name, settings.tracer.settings.empty() ? "" : " with --set"));
  if (settings.texel_sites != TexelSites::kNeeded) return;
  const std::string why = against_need(options, settings);
  if (!why.empty()) throw UsageError("--sites need: " + why);
}

/// \throw InvalidInput for what takes more memory than the machine has, whatever the volume
void require_memory_for(const BakeOptions& options, const BakeSettings& settings) {
  // Of each what is held at once at least: a texel's value; a site's place, isovalue, normal, light and variance.
  const auto require = [](const std::string& word, double count, double bytes_of_each) {
    const double bytes = count * bytes_of_each;
    if (bytes > machine_memory())
      throw InvalidInput(fmt::format("{}: that takes {:.1f} GB, and this machine has {:.1f} GB of memory", word,
                                     bytes * 1e-9, machine_memory() * 1e-9));
  };
  if (settings.texels) {
    const Index3& size = *settings.texels;
    require("--texels " + options.texels, double(size.x) * double(size.y) * double(size.z), sizeof(float));
  }
  require(fmt::format("--samples {}", options.samples), double(options.samples), 9 * sizeof(float));
}

}  // namespace

BakeSettings bake_settings(const BakeOptions& options, const Stages& stages,
                           const std::optional<ValueMoments>& moments) {
  BakeSettings settings;
  settings.trace = options.trace.settings();
  settings.sampler.name = options.sampler;
  settings.tracer.name = options.trace.tracer();
  settings.resampler.name = options.resampler;
  settings.samples = options.samples;
  if (!options.bounce_method.empty()) {
    settings.bounce_method = options.bounce_method == "paths" ? BounceMethod::kPaths : BounceMethod::kIterated;
  }
  settings.lattice = options.lattice == "voxels" ? TexelLattice::kVoxels : TexelLattice::kCells;
  if (!options.texels.empty() && !options.chooses_texels())
    settings.texels = parse_size3("--texels", options.texels, "auto or NXxNYxNZ");
  settings.texels_a_cell = options.texels_a_cell;
  if (!options.iso_range.empty()) settings.isovalues = isovalue_range(options.iso_range, moments);
  if (!options.error_grid.empty() && settings.trace.rays < 2 && options.rmse <= 0.0 && options.time <= 0.0)
    throw UsageError("--error-grid: one ray a site tells nothing about its error; allowed is --rays 2 and more");
  settings.texel_sites = options.sites == "need" ? TexelSites::kNeeded : TexelSites::kAll;
  settings.target_rmse = options.rmse;
  settings.target_seconds = options.time;
  settings.wants_error_grid = !options.error_grid.empty();
  apply_settings("--set", options.set,
                 {{"sampler", &settings.sampler.settings},
                  {"tracer", &settings.tracer.settings},
                  {"resampler", &settings.resampler.settings}});
  settings = with_backends(std::move(settings), stages);
  require_choice(stages.samplers, settings.sampler);
  require_choice(stages.tracers, settings.tracer);
  require_choice(stages.resamplers, settings.resampler);
  require_agreement(options, settings);
  require_memory_for(options, settings);
  return settings;
}

}  // namespace isolux
