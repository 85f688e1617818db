#pragma once

#include <string>
#include <vector>

namespace isolux {

/// The file of a scene and the picture that it names as its environment, as far as that can be told; none for "".
[[nodiscard]] std::vector<std::string> scene_files(const std::string& scene);

}  // namespace isolux
