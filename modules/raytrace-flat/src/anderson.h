#pragma once

#include <isolux/core/run.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace isolux {

/// Finds x = g(x) for a contraction g, faster than by x <- g(x): the next x is that mix of the last ones whose change
/// would be smallest (Anderson, "Iterative procedures for nonlinear integral equations", JACM 1965; depth 2). Channels,
/// which know nothing of each other, are mixed each on its own. The same bits for any number of threads. Memory: four
/// vectors of x's size; differences of steps are made anew where they are wanted, and arrays that are done with are
/// used again.
class Anderson {
 public:
  static constexpr std::size_t kMostChannels = 3;

  /// `contractions`: by what g brings values nearer to each other at least, by channel; below 1. x holds the channels
  /// of one place after those of another. \pre 1 to kMostChannels
  Anderson(std::vector<double> contractions, const Run& run) : contractions_(std::move(contractions)), run_(run) {}

  /// Replaces x by a better one, given g(x). Returns how far g(x) is from x = g(x) at most: its root mean square over
  /// that of g(x). What `image` holds afterwards is of no value, but memory that the next one may use.
  double step(std::vector<float>& x, std::vector<float>& image);
  /// g(x) of the last step: what a step without acceleration would have given.
  [[nodiscard]] const std::vector<float>& last_image() const { return past_.back().image; }

 private:
  /// g(x) and g(x) - x of one step.
  struct Step {
    std::vector<float> image;
    std::vector<float> change;
  };
  /// Sums of products over all values of a channel: the present change, its difference from the last one, and that
  /// one's from the change before it.
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
  using ByChannel = std::array<Products, kMostChannels>;
  /// Of past differences, the newest last.
  using Weights = std::array<double, 2>;

  [[nodiscard]] ByChannel products(const Step& now) const;
  [[nodiscard]] Weights mix(const Products& of) const;
  /// The next x, in the memory of the oldest step if there is one to spare.
  [[nodiscard]] std::vector<float> mixed(const Step& now, const std::array<Weights, kMostChannels>& weights);

  std::vector<double> contractions_;
  const Run& run_;
  std::vector<Step> past_;  ///< up to kDepth, the newest last
};

}  // namespace isolux
