#pragma once

#include <isolux/raytrace_flat/scene.h>

#include <string>

namespace isolux {

/// Reads a scene in JSON (docs/file-formats.md). \throw IoError; InvalidInput naming the file, the key and the nearest
/// known one.
[[nodiscard]] Scene read_scene(const std::string& path);

/// The scene in `json`; image files are looked for in `folder`. `name` stands in messages. \throw as read_scene
[[nodiscard]] Scene parse_scene(const std::string& json, const std::string& folder, const std::string& name);

/// The scene as one line of JSON. An image environment is described by its size, not repeated.
[[nodiscard]] std::string scene_to_json(const Scene& scene);

/// A latitude-longitude picture as linear radiance: .hdr with its exposures divided out, the display window of .exr,
/// black where there are no data, .png and .jpg decoded from sRGB.
/// \throw IoError, InvalidInput naming the file
[[nodiscard]] ImageEnvironment read_environment_image(const std::string& path);

}  // namespace isolux
