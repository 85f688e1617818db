#include "vtk_choice.h"

#include "plain_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>

#include <optional>
#include <utility>

namespace isolux::detail {
namespace {

constexpr std::size_t kMostNamed = 10;

std::string described(const VtkArrayInfo& array) {
  return fmt::format("'{}'{}{}", excerpt(array.name), array.of_cells ? " of cells" : "", array.peculiarity);
}

}  // namespace

VtkChoice choose_vtk_array(const std::string& path, const std::vector<VtkArrayInfo>& arrays,
                           const std::string& wanted) {
  const auto rank = [&](std::size_t i) { return std::pair(arrays[i].of_cells, arrays[i].role); };
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const VtkArrayInfo& array = arrays[i];
    if (!array.plain || array.name == "vtkGhostType" || (!wanted.empty() && array.name != wanted)) continue;
    if (!found || rank(i) < rank(*found)) found = i;
  }
  VtkChoice choice;
  const std::size_t others = arrays.size() - (found ? 1 : 0);
  for (std::size_t i = 0; i < arrays.size() && choice.left_out.size() < kMostNamed; ++i)
    if (found != i) choice.left_out.push_back(described(arrays[i]));
  if (others > kMostNamed) choice.left_out.push_back(fmt::format("{} more", others - kMostNamed));
  if (!found)
    throw InvalidInput(
        fmt::format("{}: VTK: {} of one number a point or cell is needed; there {}", path,
                    wanted.empty() ? "an array" : fmt::format("an array '{}'", excerpt(wanted)),
                    arrays.empty() ? "is none" : fmt::format("is {}", fmt::join(choice.left_out, ", "))));
  choice.array = *found;
  return choice;
}

std::string remark_on_choice(const std::string& path, const std::string& reader, const VtkArrayInfo& array,
                             const VtkChoice& choice) {
  if (choice.left_out.empty()) return {};
  return fmt::format("{}: the array '{}'{} is read, not {}; --set-reader {}.array=NAME reads another", path,
                     excerpt(array.name), array.of_cells ? " of cells" : "", fmt::join(choice.left_out, ", "), reader);
}

}  // namespace isolux::detail
