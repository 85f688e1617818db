#pragma once

#include <isolux/core/run.h>

#include <vector>

namespace isolux {

/// Finds x = g(x) for a contraction g, faster than by x <- g(x): the next x is that mix of the last ones whose change
/// would be smallest (Anderson, "Iterative procedures for nonlinear integral equations", JACM 1965; depth 2). The same
/// bits for any number of threads. Memory: four vectors of x's size; differences of steps are made anew where they are
/// wanted, and arrays that are done with are used again.
class Anderson {
 public:
  explicit Anderson(const Run& run) : run_(run) {}

  /// Replaces x by a better one, given g(x). Returns the error of g(x) as the changes so far suggest it: its root mean
  /// square over that of g(x). What `image` holds afterwards is of no value, but memory that the next one may use.
  double step(std::vector<float>& x, std::vector<float>& image);
  /// g(x) of the last step: what a step without acceleration would have given.
  [[nodiscard]] const std::vector<float>& last_image() const { return past_.back().image; }

 private:
  /// g(x) and g(x) - x of one step.
  struct Step {
    std::vector<float> image;
    std::vector<float> change;
  };
  /// Sums of products over all values: the present change, its difference from the last one, and that one's from the
  /// change before it.
  struct Products {
    double change = 0.0;
    double image = 0.0;
    double newer = 0.0;
    double older = 0.0;
    double newer_change = 0.0;
    double older_change = 0.0;
    double older_newer = 0.0;

    void operator+=(const Products& more);
  };
  [[nodiscard]] Products products(const Step& now) const;
  /// Weights of the past differences, the newest last.
  [[nodiscard]] std::vector<double> mix(const Products& of) const;
  /// The next x, in the memory of the oldest step if there is one to spare.
  [[nodiscard]] std::vector<float> mixed(const Step& now, const std::vector<double>& weights);

  const Run& run_;
  std::vector<Step> past_;  ///< up to kDepth, the newest last
  double last_norm_ = 0.0;
  double rate_ = 0.5;  ///< by which changes fall at worst, as seen so far
};

}  // namespace isolux
