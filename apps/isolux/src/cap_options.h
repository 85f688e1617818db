#pragma once

#include <isolux/mc_extract/extractor.h>
#include <isolux/raytrace_flat/scene.h>
#include <isolux/volume_io/light_file.h>

#include <CLI/App.hpp>
#include <cstddef>
#include <span>
#include <vector>

#include "bake_options.h"
#include "session.h"

namespace isolux {

/// --cap and --min-component: what of an isosurface `extract` writes and `render` shows.
struct CapOptions {
  bool cap = false;
  std::size_t min_component = 0;

  void add_to(CLI::App& command);
  /// The same for an extractor.
  [[nodiscard]] ExtractSettings settings(float isovalue, OuterSide outer) const;
};

/// The isovalues of which there is a surface. Warns of the others: no voxel is on one side of them, and no cap closes
/// the whole box.
[[nodiscard]] std::vector<float> isovalues_of_surfaces(const VolumeView& volume,
                                                       std::span<const ExtractSettings> surfaces,
                                                       const Session& session);

/// Whose light a cap beside baked light is in: the light's own, else, where its file does not tell all of it, the scene
/// that is given, else, with a warning, a white sky. \throw as TraceOptions::scene()
[[nodiscard]] Scene scene_of_cap(const LightFile& baked, const TraceOptions& given, const Session& session);

}  // namespace isolux
