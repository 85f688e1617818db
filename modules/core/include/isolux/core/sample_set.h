#pragma once

#include <isolux/core/lattice.h>
#include <isolux/core/vec.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace isolux {

/// Points scattered through the volume, each on its own level set. Structure of arrays, all of one length.
struct Sites {
  std::vector<Vec3f> positions;  ///< index space; as floats they are the sites exactly, not an approximation of them
  std::vector<float> isovalues;  ///< f(position), the level set that a ray from here may meet
  std::vector<Vec3f> normals;    ///< world space, unit, towards the outer side

  [[nodiscard]] std::size_t size() const { return positions.size(); }
};

/// \throw InvalidInput unless every site has a position, an isovalue and a normal
void require_equal_lengths(const Sites& sites);
/// The same of sites that somebody else made (`whose`: "sampler x"), which also have to lie in the box of `volume` with
/// isovalues and normals that are numbers; the message says which one does not. Cost: some nanoseconds a site.
void require_usable(const Sites& sites, const Lattice& volume, std::string_view whose);

/// The sites with these numbers, in their order. \throw InvalidInput for numbers that no site has
[[nodiscard]] Sites some_of(const Sites& sites, std::span<const std::size_t> numbers);

/// Whether samples say which part of their light is lamps': what light sources, and parts of an image as bright as
/// these, send straight to a site. Rays are aimed at them, so it is hardly noisy, and has edges that the rest has not.
enum class LampLight : std::uint8_t {
  kWithin,    ///< it is a part of the whole like any other
  kToldApart  ///< SampleSet::lamps says it too, where there are lamps
};

/// How rays are spread over the sites.
enum class RaySpread : std::uint8_t {
  kEven,    ///< as many of each
  kByNoise  ///< as many on average, more of sites about which a first quarter of the rays is noisy
};

/// The variance of a sample whose rays say nothing of it: of one ray, or of a site without a normal.
inline constexpr float kUnknownVariance = std::numeric_limits<float>::max();

/// Sites and the light found at them: e = irradiance/pi of the outer side (a radiance), see docs/theory.md.
struct SampleSet {
  Sites sites;
  int channels = 1;             ///< 1 (grey) or 3 (RGB)
  std::vector<float> radiance;  ///< e; `channels` values a site, channel fastest
  std::vector<float>
      variance;  ///< squared standard error of e, mean over the channels; one a site, or kUnknownVariance
  /// What of `radiance` and of `variance` is lamps' (LampLight), in the same layout; empty where it is not told apart.
  std::vector<float> lamps{};
  std::vector<float> lamps_variance{};

  [[nodiscard]] std::size_t size() const { return sites.size(); }
};

}  // namespace isolux
