#pragma once

#include <isolux/core/run.h>

#include <vector>

namespace isolux {

/// Finds x = g(x) for a contraction g, faster than by x <- g(x): the next x is that mix of the last ones whose change
/// would be smallest (Anderson, "Iterative procedures for nonlinear integral equations", JACM 1965; depth 2). The same
/// bits for any number of threads. Memory: six vectors of x's size.
class Anderson {
 public:
  explicit Anderson(const Run& run) : run_(run) {}

  /// Replaces x by a better one, given g(x). Returns the error of g(x) as the changes so far suggest it: its root mean
  /// square over that of g(x).
  double step(std::vector<float>& x, std::vector<float> image);

 private:
  struct Past {
    std::vector<float> image;   ///< differences of g(x)
    std::vector<float> change;  ///< and of g(x) - x
  };
  /// Weights of the past differences.
  [[nodiscard]] std::vector<double> mix(const std::vector<float>& change) const;
  [[nodiscard]] double dot(const std::vector<float>& a, const std::vector<float>& b) const;

  const Run& run_;
  std::vector<float> last_image_;
  std::vector<float> last_change_;
  double last_norm_ = 0.0;
  double rate_ = 0.5;  ///< by which changes fall at worst, as seen so far
  std::vector<Past> past_;
};

}  // namespace isolux
