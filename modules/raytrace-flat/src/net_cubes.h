#pragma once

#include <isolux/core/sample_set.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// Cubes of sites whose rays are one net (wide::NetPlaces), and how many rays each is worth by the noise of a few.
class NetCubes {
 public:
  /// The first rays, which tell noise, are so small a part of all.
  static constexpr int kFirst = 4;

  /// \pre unit normals, or none where there is nothing to light: those are in no cube
  explicit NetCubes(const Sites& sites);

  /// The sites of some of the cubes, anywhere, and those of all others; by number.
  struct Parts {
    std::vector<std::uint32_t> some;
    std::vector<std::uint32_t> others;
  };
  [[nodiscard]] Parts parts() const;

  /// Learns the variances of these sites' first rays. \pre whole cubes, each once
  void learn(std::span<const std::uint32_t> sites, const std::vector<float>& variances);

  /// Whether as many rays spread over the cubes known so far leave less noise by what more passes are worth.
  [[nodiscard]] bool pays(int rays) const { return noise_left(factor(rays), rays) <= kWorthIt; }
  /// How many rays each site gets, `rays` on average, first ones that are traced in vain counted: a quarter, half,
  /// once, twice or four times as many; `rays` where there is nothing to light.
  [[nodiscard]] std::vector<std::uint32_t> spread(int rays) const;

 private:
  static constexpr double kWorthIt = 0.9;  ///< of the variance, all sites together
  static constexpr std::uint32_t kNone = ~std::uint32_t(0);

  struct Cube {
    double sites = 0.0;
    double noise = 0.0;  ///< sum of the first rays' variances
    bool is_known = false;
  };

  [[nodiscard]] double mean_noise() const;
  /// Times as many rays as a cube of mean noise.
  [[nodiscard]] static double wants(const Cube& cube, double mean);
  /// By what to multiply what cubes want so that they take `rays` on average.
  [[nodiscard]] double factor(int rays) const;
  /// Of the variance of `rays` each.
  [[nodiscard]] double noise_left(double factor, int rays) const;

  std::vector<std::uint32_t> of_site_;
  std::vector<Cube> cubes_;
};

}  // namespace isolux
