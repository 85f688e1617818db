#include <isolux/core/spread_labels.h>

#include <cstddef>
#include <vector>

namespace isolux {

void spread_labels(const Index3& size, std::span<std::uint32_t> labels) {
  const std::size_t extent[3] = {std::size_t(size.x), std::size_t(size.y), std::size_t(size.z)};
  const auto for_each_face_neighbour = [&](std::uint32_t at, const auto& visit) {
    std::size_t stride = 1;
    for (const std::size_t n : extent) {
      const std::size_t place = at / stride % n;
      if (place > 0) visit(std::uint32_t(at - stride));
      if (place + 1 < n) visit(std::uint32_t(at + stride));
      stride *= n;
    }
  };
  // The front of labelled places, breadth first; the first one is those that touch a place without.
  std::vector<std::uint32_t> front;
  std::vector<std::uint32_t> next;
  for (std::size_t at = 0; at < labels.size(); ++at) {
    if (labels[at] != kNoLabel) continue;
    for_each_face_neighbour(std::uint32_t(at), [&](std::uint32_t near) {
      if (labels[near] != kNoLabel) front.push_back(near);
    });
  }
  while (!front.empty()) {
    next.clear();
    for (const std::uint32_t at : front) {
      for_each_face_neighbour(at, [&](std::uint32_t near) {
        if (labels[near] != kNoLabel) return;
        labels[near] = labels[at];
        next.push_back(near);
      });
    }
    front.swap(next);
  }
}

}  // namespace isolux
