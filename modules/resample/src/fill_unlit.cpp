#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/parallel.h>
#include <isolux/resample/fill_unlit.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace isolux {
namespace {

enum State : std::uint8_t { kUnlit = 0, kLit = 1, kInFront = 2 };

/// A step to one of the 26 neighbours and the weight of what lies there.
struct GridStep {
  Index3 step{0};
  double weight = 0.0;
};

Index3 texel_index(const Lattice& lattice, std::size_t offset) {
  const auto nx = std::size_t(lattice.size.x);
  const auto ny = std::size_t(lattice.size.y);
  return {int(offset % nx), int(offset / nx % ny), int(offset / nx / ny)};
}

bool inside(const Lattice& lattice, const Index3& i) {
  return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < lattice.size.x && i.y < lattice.size.y && i.z < lattice.size.z;
}

/// Weights fall with the square of the distance along the axes, so that thick slices do not smear across.
std::array<GridStep, 26> make_neighbours(const Lattice& lattice) {
  const Vec3 spacing = lattice.frame.spacing();
  std::array<GridStep, 26> result;
  std::size_t n = 0;
  for (int q = 0; q < 27; ++q) {
    const Index3 step{q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1};
    if (q == 13) continue;
    double squared = 0.0;
    for (int a = 0; a < 3; ++a)
      squared += double(step[a] * step[a]) * (spacing[a] / spacing.x) * (spacing[a] / spacing.x);
    result[n++] = {.step = step, .weight = 1.0 / squared};
  }
  return result;
}

/// Grows the lit region by one layer of face neighbours at a time. A texel is visited once, when the layer reaches it.
class Filler {
 public:
  Filler(ResampledGrid partial, const Run& run)
      : grid_(std::move(partial.grid)),
        state_(std::move(partial.lit)),
        run_(run),
        around_(make_neighbours(lattice())) {}

  IlluminationGrid fill(int layers) {
    std::vector<std::size_t> front = first_front();
    for (int layer = 0; layer < layers && !front.empty(); ++layer) {
      // The layer's texels see only those lit before it, so their order does not matter.
      parallel_blocks(front.size(), 4096, run_, "", [&](const Block& block) {
        for (std::size_t f = block.begin; f < block.end; ++f) light(front[f]);
      });
      for (const std::size_t texel : front) state_[texel] = kLit;
      front = next_front(front);
    }
    return std::move(grid_);
  }

 private:
  [[nodiscard]] const Lattice& lattice() const { return grid_.lattice; }

  [[nodiscard]] std::vector<std::size_t> first_front() {
    std::vector<std::size_t> front;
    bool any_lit = false;
    for (std::size_t t = 0; t < state_.size(); ++t) {
      any_lit = any_lit || state_[t] == kLit;
      if (state_[t] != kUnlit || !touches_lit(t)) continue;
      state_[t] = kInFront;
      front.push_back(t);
    }
    if (!any_lit) throw InvalidInput(fmt::format("none of {} texels has light to fill the others from", state_.size()));
    return front;
  }

  template <class Visit>
  void for_each_face_neighbour(std::size_t texel, Visit visit) const {
    const Index3 at = texel_index(lattice(), texel);
    std::size_t stride = 1;
    for (int a = 0; a < 3; ++a) {
      if (at[a] > 0) visit(texel - stride);
      if (at[a] + 1 < lattice().size[a]) visit(texel + stride);
      stride *= std::size_t(lattice().size[a]);
    }
  }

  [[nodiscard]] bool touches_lit(std::size_t texel) const {
    bool found = false;
    for_each_face_neighbour(texel, [&](std::size_t n) { found = found || state_[n] == kLit; });
    return found;
  }

  [[nodiscard]] std::vector<std::size_t> next_front(const std::vector<std::size_t>& front) {
    std::vector<std::size_t> next;
    for (const std::size_t texel : front) {
      for_each_face_neighbour(texel, [&](std::size_t n) {
        if (state_[n] != kUnlit) return;
        state_[n] = kInFront;
        next.push_back(n);
      });
    }
    return next;
  }

  void light(std::size_t texel) {
    const Index3 at = texel_index(lattice(), texel);
    const auto channels = std::size_t(grid_.channels);
    std::array<double, 3> sum{};
    double weight = 0.0;
    for (const GridStep& n : around_) {
      const Index3 i = at + n.step;
      if (!inside(lattice(), i)) continue;
      const std::size_t from = lattice().offset(i.x, i.y, i.z);
      if (state_[from] != kLit) continue;
      weight += n.weight;
      for (std::size_t c = 0; c < channels; ++c) sum[c] += n.weight * double(grid_.values[from * channels + c]);
    }
    for (std::size_t c = 0; c < channels; ++c) grid_.values[texel * channels + c] = float(sum[c] / weight);
  }

  IlluminationGrid grid_;
  std::vector<std::uint8_t> state_;
  const Run& run_;
  std::array<GridStep, 26> around_;
};

}  // namespace

IlluminationGrid fill_unlit(ResampledGrid partial, const Run& run, const FillSettings& settings) {
  if (std::find(partial.lit.begin(), partial.lit.end(), std::uint8_t(kUnlit)) == partial.lit.end())
    return std::move(partial.grid);
  return Filler(std::move(partial), run).fill(settings.layers);
}

}  // namespace isolux
