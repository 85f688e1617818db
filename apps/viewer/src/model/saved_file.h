#pragma once

#include <functional>
#include <string>

namespace isolux::viewer {

/// Lets `write` make a file and calls it "STEM-ISOVALUE.EXTENSION" in the current folder, or STEM-ISOVALUE-2, -3, ...
/// where that exists; STEM, of the volume, is cut where the name would be longer than file systems take. Two programs
/// never get the same name, and nothing that exists is overwritten. Returns the name. \throw IoError naming it, and
/// whatever `write` throws
[[nodiscard]] std::string save_under_free_name(const std::string& volume_name, double isovalue,
                                               const std::string& extension,
                                               const std::function<void(const std::string& path)>& write);

}  // namespace isolux::viewer
