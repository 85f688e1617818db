#include "slice_stack.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace isolux::detail {
namespace {
// A gantry is tilted by 30 degrees at most; what lies flatter is no stack but noise, or a shift in the plane.
constexpr double kLeastRise = 0.5;
// Positions are rounded to a micrometre or so by scanners; a hundredth of the gap is no rounding any more.
constexpr double kRounding = 1e-2;
// Of a gap by which it may differ from that of whole slices left out.
constexpr double kMissingSlack = 0.1;

/// Two neighbours, and how far apart they are along the normal.
struct Gap {
  double width = 0.0;
  const Slice* before = nullptr;
  const Slice* behind = nullptr;
};

void require_alike(const std::string& source, const std::vector<Slice>& slices) {
  const Lattice& lattice = slices.front().lattice;
  const Mat3& axes = lattice.frame.axes;
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
}

std::vector<Gap> gaps_of(const std::vector<Slice>& slices, const Vec3& normal) {
  std::vector<Gap> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i)
    gaps.push_back({glm::dot(slices[i].lattice.frame.origin - slices[i - 1].lattice.frame.origin, normal),
                    &slices[i - 1], &slices[i]});
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.width < b.width; });
  return gaps;
}

/// What is wrong with gaps, by the slices that it is wrong between; empty if they are even. `gaps` go from the smallest
/// to the largest.
std::string unevenness(const std::vector<Gap>& gaps) {
  const Gap& least = gaps.front();
  const Gap& most = gaps.back();
  if (!(most.width > 0.0)) return fmt::format("all {} lie at one place", gaps.size() + 1);
  const auto between = [](const Gap& gap) { return fmt::format("{} and {}", gap.before->path, gap.behind->path); };
  const auto apart =
      std::find_if(gaps.begin(), gaps.end(), [&](const Gap& g) { return g.width > kRounding * most.width; });
  if (apart != gaps.begin()) return fmt::format("two slices at the same place: {}", between(least));
  const double usual = gaps[(gaps.size() - 1) / 2].width;
  const double slices = most.width / usual;
  if (std::round(slices) >= 2.0 && std::fabs(slices - std::round(slices)) < kMissingSlack)
    return fmt::format(
        "{} missing between {}, which are {:.4g} mm apart, where the usual gap is {:.4g} mm",
        std::round(slices) == 2.0 ? "a slice is" : fmt::format("{} slices are", std::round(slices) - 1.0),
        between(most), most.width, usual);
  if (most.width - least.width <= kRounding * usual) return "";
  return fmt::format("the smallest gap is {:.4g} mm, between {}, the largest {:.4g} mm, between {}", least.width,
                     between(least), most.width, between(most));
}

/// What keeps sorted slices from standing one `step` behind another; empty if nothing does.
std::string off_places(const std::vector<Slice>& slices, const Vec3& step, const Vec3& normal) {
  const Vec3& first = slices.front().lattice.frame.origin;
  const Slice* farthest = &slices.front();
  double most = 0.0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const double off = glm::distance(slices[i].lattice.frame.origin, first + double(i) * step);
    if (off <= most) continue;
    most = off;
    farthest = &slices[i];
  }
  if (most <= kRounding * glm::length(step) && std::fabs(glm::dot(step, normal)) > 0.0) return "";
  const std::string why = unevenness(gaps_of(slices, normal));
  if (!why.empty()) return why;
  return fmt::format("{} lies {:.3g} mm off its place in a stack of {} at {:.4g} mm", farthest->path, most,
                     slices.size(), glm::length(step));
}

}  // namespace

SliceStack stack_slices(const std::string& source, std::vector<Slice>& slices, std::optional<double> gap) {
  require_alike(source, slices);
  SliceStack stack{.lattice = slices.front().lattice, .remark = {}};
  IndexToWorld& frame = stack.lattice.frame;
  const Vec3 normal = glm::normalize(glm::cross(frame.axes[0], frame.axes[1]));
  // Where no places are told, the order of the names stays.
  std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
    return glm::dot(a.lattice.frame.origin, normal) < glm::dot(b.lattice.frame.origin, normal);
  });
  frame.origin = slices.front().lattice.frame.origin;
  if (slices.size() == 1) return stack;
  stack.lattice.size.z = int(slices.size());
  const Vec3 step = (slices.back().lattice.frame.origin - frame.origin) / double(slices.size() - 1);
  const std::string why = off_places(slices, step, normal);
  if (!gap && !why.empty())
    throw InvalidInput(fmt::format(
        "{}: the DICOM slices are not evenly spaced: {}; --spacing takes them as evenly spaced all the same", source,
        why));
  frame.axes[2] = step;
  if (!gap) return stack;
  const bool stacked = glm::dot(step, normal) > kLeastRise * glm::length(step);
  frame.axes[2] = (stacked ? glm::normalize(step) : normal) * *gap;
  if (!why.empty())
    stack.remark = fmt::format(
        "{}: the DICOM slices are not evenly spaced: {}; --spacing takes them as {:.4g} mm apart all the same, so that "
        "what they show may be squashed or stretched",
        source, why, *gap);
  return stack;
}

}  // namespace isolux::detail
