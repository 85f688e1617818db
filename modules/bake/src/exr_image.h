#pragma once

#include <isolux/raytrace_flat/scene.h>

#include <string>

namespace isolux {

/// The display window of an OpenEXR file's first part: black where the file holds no data, without those that lie
/// outside. \throw IoError; InvalidInput where nothing of the picture would be left or it is no latitude-longitude map
[[nodiscard]] ImageEnvironment read_exr_image(const std::string& path);

}  // namespace isolux
