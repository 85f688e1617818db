#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace isolux::detail {

/// What the file says that an array is for.
enum class VtkRole : std::uint8_t { kScalars, kOther, kIds };

/// An array of a VTK file, as far as it matters for a choice.
struct VtkArrayInfo {
  std::string name;
  bool of_cells = false;
  VtkRole role = VtkRole::kOther;
  bool plain = true;          ///< one number a point or cell, of a type that is read
  std::string peculiarity{};  ///< what a message adds to the name: " (3 components)"
};

struct VtkChoice {
  std::size_t array = 0;
  std::vector<std::string> left_out;  ///< the others, described; at most ten and how many more
};

/// The array to read: the one named `wanted` or, if that is empty, the first that will do, those of points before
/// those of cells and of these the scalars before others and identifiers last. VTK's marks of hidden points will never
/// do. \throw InvalidInput naming `path` and the arrays that there are
[[nodiscard]] VtkChoice choose_vtk_array(const std::string& path, const std::vector<VtkArrayInfo>& arrays,
                                         const std::string& wanted);

/// Which array was read instead of which; empty if there was one only. `reader` is the backend's name.
[[nodiscard]] std::string remark_on_choice(const std::string& path, const std::string& reader,
                                           const VtkArrayInfo& array, const VtkChoice& choice);

}  // namespace isolux::detail
