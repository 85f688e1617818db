#include <isolux/core/parallel.h>
#include <isolux/core/texel_mask.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace isolux {
namespace {

/// Grid points of an axis, from `first` to `last`.
struct Window {
  int first = 0;
  int last = 0;
};

/// Of each texel of an axis, the grid points between whose values light is read from it.
std::vector<Window> windows(const IndexToWorld& to_volume, int axis, int texels, int points) {
  std::vector<Window> windows(static_cast<std::size_t>(texels));
  for (int i = 0; i < texels; ++i) {
    const auto place = [&](int texel) { return to_volume.origin[axis] + double(texel) * to_volume.axes[axis][axis]; };
    // Reading goes on beyond the outermost centres.
    const int first = i == 0 ? 0 : int(std::floor(within_axis(place(i - 1), points)));
    const int last = i == texels - 1 ? points - 1 : int(std::ceil(within_axis(place(i + 1), points)));
    windows[std::size_t(i)] = {std::min(first, last), std::max(first, last)};
  }
  return windows;
}

struct Extremes {
  std::vector<float> least;
  std::vector<float> largest;
};

/// Of the rows of grid points along x in a window of y and one of z.
void find_extremes(const Volume& volume, const Window& y, const Window& z, Extremes& extremes) {
  const Lattice& lattice = volume.lattice();
  const auto nx = std::size_t(lattice.size.x);
  const float* const values = volume.values.values().data();
  const float* const begin = values + lattice.offset(0, y.first, z.first);
  extremes.least.assign(begin, begin + nx);
  extremes.largest.assign(begin, begin + nx);
  float* const least = extremes.least.data();
  float* const largest = extremes.largest.data();
  for (int k = z.first; k <= z.last; ++k) {
    for (int j = y.first; j <= y.last; ++j) {
      const float* const row = values + lattice.offset(0, j, k);
      for (std::size_t i = 0; i < nx; ++i) {
        least[i] = std::min(least[i], row[i]);
        largest[i] = std::max(largest[i], row[i]);
      }
    }
  }
}

}  // namespace

TexelMask::TexelMask(const Index3& size)
    : size_(size), words_((require_countable({.size = size, .frame = {}}) + 63) / 64, 0) {}

std::size_t TexelMask::count() const {
  return std::transform_reduce(words_.begin(), words_.end(), std::size_t(0), std::plus<>(),
                               [](std::uint64_t word) { return std::size_t(std::popcount(word)); });
}

TexelMask texels_read_by(const Volume& volume, const Lattice& texels, const ValueRange& isovalues, const Run& run) {
  const Index3 size = texels.size;
  TexelMask mask(size);
  const IndexToWorld to_volume = index_to_index(texels, volume.lattice());
  if (!has_axes_of(texels, volume.lattice())) {
    for (std::size_t t = 0; t < texels.count(); ++t) mask.set(t);
    return mask;
  }
  std::vector<Window> along[3];
  for (int a = 0; a < 3; ++a) along[a] = windows(to_volume, a, size[a], volume.lattice().size[a]);
  // Whole planes of bytes first, as words of bits may hold texels of two planes.
  constexpr std::size_t kPlanes = 16;
  const std::size_t plane = std::size_t(size.x) * std::size_t(size.y);
  std::vector<std::uint8_t> hit(std::min(kPlanes, std::size_t(size.z)) * plane);
  for (std::size_t first = 0; first < std::size_t(size.z); first += kPlanes) {
    const std::size_t planes = std::min(kPlanes, std::size_t(size.z) - first);
    parallel_blocks(planes * std::size_t(size.y), 16, run, "", [&](const Block& block) {
      Extremes extremes;
      for (std::size_t row = block.begin; row < block.end; ++row) {
        const std::size_t k = first + row / std::size_t(size.y);
        find_extremes(volume, along[1][row % std::size_t(size.y)], along[2][k], extremes);
        for (std::size_t x = 0; x < std::size_t(size.x); ++x) {
          const Window& window = along[0][x];
          float least = extremes.least[std::size_t(window.first)];
          float largest = extremes.largest[std::size_t(window.first)];
          for (int i = window.first + 1; i <= window.last; ++i) {
            least = std::min(least, extremes.least[std::size_t(i)]);
            largest = std::max(largest, extremes.largest[std::size_t(i)]);
          }
          hit[row * std::size_t(size.x) + x] =
              std::uint8_t(int(least <= isovalues.high) & int(largest >= isovalues.low));
        }
      }
    });
    for (std::size_t i = 0; i < planes * plane; ++i)
      if (hit[i] != 0) mask.set(first * plane + i);
  }
  return mask;
}

}  // namespace isolux
