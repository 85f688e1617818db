#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/core/lattice.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace isolux {
namespace {

/// How many times `axis` the other one is, if it runs along it but for the rounding of its three numbers.
std::optional<double> steps_along(const Vec3& other, const Vec3& axis) {
  const Vec3 lengths = glm::abs(axis);
  const int longest = lengths.x >= lengths.y ? (lengths.x >= lengths.z ? 0 : 2) : (lengths.y >= lengths.z ? 1 : 2);
  const double steps = other[longest] / axis[longest];
  const Vec3 off = glm::abs(other - axis * steps);
  const double rounding = 2.0 * std::numeric_limits<double>::epsilon() * std::fabs(other[longest]);
  if (!(std::max({off.x, off.y, off.z}) <= rounding)) return {};
  return steps;
}

}  // namespace

Vec3 IndexToWorld::index(const Vec3& world) const { return glm::inverse(axes) * (world - origin); }

Mat3 IndexToWorld::gradient_to_world() const { return glm::transpose(glm::inverse(axes)); }

Vec3 IndexToWorld::spacing() const { return {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])}; }

std::optional<std::size_t> point_at(const Lattice& lattice, const Vec3& index) {
  constexpr double kTolerance = 0.01;
  int point[3];
  for (int a = 0; a < 3; ++a) {
    const double nearest = std::floor(index[a] + 0.5);
    if (!(std::fabs(index[a] - nearest) <= kTolerance) || nearest < 0.0 || nearest >= double(lattice.size[a]))
      return {};
    point[a] = int(nearest);
  }
  return lattice.offset(point[0], point[1], point[2]);
}

void require_spanning(const IndexToWorld& frame, std::string_view what) {
  constexpr double kLeastVolume = 1e-9;  // of axes of length 1
  const Vec3 lengths = frame.spacing();
  const Mat3 unit(frame.axes[0] / lengths.x, frame.axes[1] / lengths.y, frame.axes[2] / lengths.z);
  const bool has_place = std::isfinite(frame.origin.x + frame.origin.y + frame.origin.z);
  if (has_place && std::isnormal(glm::determinant(frame.axes)) && std::fabs(glm::determinant(unit)) > kLeastVolume)
    return;
  const auto text = [](const Vec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); };
  throw InvalidInput(fmt::format("{}: axes {}, {} and {} from origin {} span no volume", what, text(frame.axes[0]),
                                 text(frame.axes[1]), text(frame.axes[2]), text(frame.origin)));
}

void require_places(const Lattice& lattice, std::string_view what) {
  constexpr double kMostOff = 1e-3;  // grid points
  // World places are sums of steps along all axes. What these lose to rounding the way back makes larger.
  const Mat3& axes = lattice.frame.axes;
  const Mat3 back = glm::inverse(axes);
  Vec3 reach(0.0);
  for (int a = 0; a < 3; ++a) reach += glm::abs(axes[a]) * double(lattice.size[a]);
  const Vec3 off = (glm::abs(back[0]) * reach.x + glm::abs(back[1]) * reach.y + glm::abs(back[2]) * reach.z) *
                   std::numeric_limits<double>::epsilon();
  if (std::max({off.x, off.y, off.z}) < kMostOff) return;
  const auto text = [](const Vec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); };
  throw InvalidInput(
      fmt::format("{}: axes {}, {} and {} are too unlike each other in length: world coordinates do not tell their "
                  "grid points apart",
                  what, text(axes[0]), text(axes[1]), text(axes[2])));
}

std::size_t require_countable(const Lattice& lattice) {
  constexpr std::size_t kMost = std::size_t(1) << 48;  // what addresses reach; products of two sizes fit beside it
  const Index3& size = lattice.size;
  const bool is_size = size.x >= 0 && size.y >= 0 && size.z >= 0;
  const std::size_t plane = is_size ? std::size_t(size.x) * std::size_t(size.y) : 0;
  if (is_size && (plane == 0 || std::size_t(size.z) <= kMost / plane)) return lattice.count();
  throw InvalidInput(fmt::format("a lattice of {}x{}x{} points: allowed are sizes of 0 and more, and 2^48 points",
                                 size.x, size.y, size.z));
}

void require_values(const Lattice& lattice, std::size_t values) {
  if (values == require_countable(lattice)) return;
  throw InvalidInput(fmt::format("{} values for a lattice of {}x{}x{} points: one a point is wanted", values,
                                 lattice.size.x, lattice.size.y, lattice.size.z));
}

Lattice cell_lattice(const Lattice& volume, Index3 texels) {
  Lattice result;
  result.size = texels;
  Vec3 first(0.0);
  for (int a = 0; a < 3; ++a) {
    if (volume.size[a] < 2 || texels[a] < 1) {
      throw InvalidInput(
          fmt::format("a texture of {}x{}x{} texels over a volume of {}x{}x{} grid points: it needs at least 1 texel "
                      "and 2 grid points on each axis",
                      texels.x, texels.y, texels.z, volume.size.x, volume.size.y, volume.size.z));
    }
    const double step = double(volume.size[a] - 1) / texels[a];
    first[a] = 0.5 * step;
    result.frame.axes[a] = volume.frame.axes[a] * step;
  }
  result.frame.origin = volume.frame.world(first);
  return result;
}

Lattice cell_lattice(const Lattice& volume) { return cell_lattice(volume, volume.size - 1); }

Lattice voxel_lattice(const Lattice& volume) { return volume; }

IndexToWorld index_to_index(const Lattice& from, const Lattice& to) {
  const Mat3 inverse = glm::inverse(to.frame.axes);
  IndexToWorld map{.origin = inverse * (from.frame.origin - to.frame.origin), .axes = inverse * from.frame.axes};
  // Rounding in the inverse of oblique axes would put grid points of one lattice beside those of the other, into cells
  // that they only touch. Straight axes keep their zeros.
  for (int a = 0; a < 3; ++a) {
    const Vec3 along(a == 0, a == 1, a == 2);
    const std::optional<double> steps = steps_along(from.frame.axes[a], to.frame.axes[a]);
    if (steps && map.axes[a] != along * map.axes[a][a]) map.axes[a] = along * *steps;
  }
  return map;
}

bool has_axes_of(const Lattice& one, const Lattice& other) {
  constexpr double kRounding = 1e-9;
  const IndexToWorld to_other = index_to_index(one, other);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (a != b && std::abs(to_other.axes[b][a]) * double(one.size[b]) > kRounding * double(other.size[a]))
        return false;
  return true;
}

}  // namespace isolux
