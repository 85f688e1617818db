#include "ui/panes.h"

#include <algorithm>
#include <cmath>

namespace isolux::viewer {

std::vector<Pane> make_panes(Layout layout, double width, double height) {
  if (layout != Layout::kSideBySide)
    return {{{0.0, 0.0, width, height}, layout == Layout::kLocal ? Lighting::kLocal : Lighting::kGlobal}};
  const double left = std::floor(width / 2.0);
  return {{{0.0, 0.0, left, height}, Lighting::kLocal}, {{left, 0.0, width - left, height}, Lighting::kGlobal}};
}

std::size_t pane_at(const std::vector<Pane>& panes, double x) {
  for (std::size_t i = panes.size() - 1; i > 0; --i) {
    if (x >= panes[i].box.x) return i;
  }
  return 0;
}

glm::dvec2 picture_place(const Box& pane, double x, double y) {
  const double half = 0.5 * std::max(std::min(pane.width, pane.height), 1.0);
  return {(x - pane.x - 0.5 * pane.width) / half, (pane.y + 0.5 * pane.height - y) / half};
}

Box slider_track(double width, double height, double scale) {
  const double margin = 24.0 * scale;
  const double thick = 20.0 * scale;
  return {margin, height - margin - thick, std::max(width - 2.0 * margin, 1.0), thick};
}

}  // namespace isolux::viewer
