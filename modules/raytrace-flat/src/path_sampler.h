#pragma once

#include <cstdint>

namespace isolux {

/// Two numbers in [0, 1).
struct UnitPair {
  double u;
  double v;
};

/// The random numbers of one site's paths: for every pair of dimensions an Owen-scrambled Sobol' sequence in base 2,
/// its order shuffled by another scramble so that the pairs are independent of each other (Burley, "Practical
/// hash-based Owen scrambling", JCGT 2020). Any 2^m aligned paths are a (0,m,2)-net in every pair, every estimate is
/// unbiased, and a number depends on nothing but (seed, site, pair, path).
class PathSampler {
 public:
  PathSampler(std::uint64_t seed, std::uint64_t site);

  [[nodiscard]] UnitPair pair(std::uint32_t path, std::uint32_t dimension_pair) const;

 private:
  std::uint64_t key_;
};

}  // namespace isolux
