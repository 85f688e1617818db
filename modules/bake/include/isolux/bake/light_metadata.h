#pragma once

#include <isolux/bake/bake.h>
#include <isolux/core/surface_colour.h>
#include <isolux/volume_io/light_file.h>

#include <optional>

namespace isolux {

/// The bake's result as a file: grid and the key/value pairs isolux.version, .quantity, .scene, .settings,
/// .volume_sha256, .iso_range and .rmse_estimate. `volume`, `scene` and `run` are those of the bake.
[[nodiscard]] LightFile make_light_file(BakeResult result, const Volume& volume, const Scene& scene, const Run& run);

/// BakeResult::error as a file. \throw InvalidInput if there is none
[[nodiscard]] LightFile make_error_file(const BakeResult& result, const Volume& volume, const Scene& scene,
                                        const Run& run);

/// The settings as one line of JSON, with names where with_defaults() gave them.
[[nodiscard]] std::string settings_to_json(const BakeSettings& settings, const Run& run);

/// \throw InvalidInput unless the light was baked for this volume; it names both.
void require_light_of(const LightFile& light, const Volume& volume, const std::string& light_path);

/// The albedo and emission of an isovalue's surface in a scene.
[[nodiscard]] SurfaceColour surface_colour(const Scene& scene, float isovalue);
/// Those that the light's scene gives it; where the file says nothing, an albedo of 0.8.
[[nodiscard]] SurfaceColour surface_colour(const LightFile& light, float isovalue);

/// The scene that the light was baked in; nothing where the file does not tell all of it (an image environment).
[[nodiscard]] std::optional<Scene> light_scene(const LightFile& light);

/// The reflections that the light was baked with; kAllBounces where the file says nothing.
[[nodiscard]] int light_bounces(const LightFile& light);

/// The outer side that the light was baked for.
[[nodiscard]] OuterSide light_outer(const LightFile& light);
/// Which of a light's sides shows on a surface whose outside is `outer`.
[[nodiscard]] LevelSetSide side_towards(const LightFile& light, OuterSide outer);

}  // namespace isolux
