#include "slice_stack.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace isolux::detail {
namespace {
constexpr double kLeastRise = 0.5;
}  // namespace

Lattice stack_slices(const std::string& source, std::vector<Slice>& slices, std::optional<double> gap) {
  Lattice lattice = slices.front().lattice;
  const Mat3 axes = lattice.frame.axes;
  const Vec3 normal = glm::normalize(glm::cross(axes[0], axes[1]));
  for (const auto& slice : slices) {
    const Lattice& other = slice.lattice;
    double turned = 0.0;
    for (int a = 0; a < 2; ++a)
      turned = std::max(turned, glm::distance(other.frame.axes[a], axes[a]) / glm::length(axes[a]));
    // A thousandth of a pixel's edge, far above the rounding of DICOM's decimal text.
    if (other.size != Index3(lattice.size.x, lattice.size.y, 1) || !(turned < 1e-3))
      throw InvalidInput(fmt::format("{}: the slices {} and {} differ in size, spacing or direction", source,
                                     slices.front().path, slice.path));
  }
  std::sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
    return glm::dot(a.lattice.frame.origin, normal) < glm::dot(b.lattice.frame.origin, normal);
  });
  lattice.frame.origin = slices.front().lattice.frame.origin;
  if (slices.size() == 1) return lattice;
  lattice.size.z = int(slices.size());
  const Vec3 step = (slices.back().lattice.frame.origin - lattice.frame.origin) / double(slices.size() - 1);
  if (gap) {
    // A gantry is tilted by 30 degrees at most; what lies flatter is no stack but noise, or a shift in the plane.
    const bool stacked = glm::dot(step, normal) > kLeastRise * glm::length(step);
    lattice.frame.axes[2] = (stacked ? glm::normalize(step) : normal) * *gap;
    return lattice;
  }
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const double off = glm::distance(slices[i].lattice.frame.origin, lattice.frame.origin + double(i) * step);
    // Positions are rounded to a micrometre or so by scanners; a hundredth of the gap is no rounding any more.
    if (!(off <= 1e-2 * glm::length(step)) || !(std::fabs(glm::dot(step, normal)) > 0.0))
      throw InvalidInput(
          fmt::format("{}: the DICOM slices are not evenly spaced: {} lies {:.3g} mm off its place in a "
                      "stack of {} at {:.4g} mm; --spacing takes them as evenly spaced all the same",
                      source, slices[i].path, off, slices.size(), glm::length(step)));
  }
  lattice.frame.axes[2] = step;
  return lattice;
}

}  // namespace isolux::detail
