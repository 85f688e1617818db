#include "anderson.h"

#include <isolux/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace isolux {
namespace {

constexpr std::size_t kDepth = 2;
constexpr std::size_t kABlock = 65536;
/// A slower fall of the changes is taken for noise: no error is guessed at more than twenty times the change.
constexpr double kSlowest = 0.95;

}  // namespace

void Anderson::Products::operator+=(const Products& more) {
  change += more.change;
  image += more.image;
  newer += more.newer;
  older += more.older;
  newer_change += more.newer_change;
  older_change += more.older_change;
  older_newer += more.older_newer;
}

Anderson::Products Anderson::products(const Step& now) const {
  std::vector<Products> parts(block_count(now.change.size(), kABlock));
  parallel_blocks(now.change.size(), kABlock, run_, "", [&](const Block& block) {
    Products sum;
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const auto change = double(now.change[i]);
      sum.change += change * change;
      sum.image += double(now.image[i]) * double(now.image[i]);
      if (past_.empty()) continue;
      const auto newer = double(now.change[i] - past_.back().change[i]);
      sum.newer += newer * newer;
      sum.newer_change += newer * change;
      if (past_.size() < kDepth) continue;
      const auto older = double(past_.back().change[i] - past_.front().change[i]);
      sum.older += older * older;
      sum.older_change += older * change;
      sum.older_newer += older * newer;
    }
    parts[block.index] = sum;
  });
  Products sum;
  for (const Products& part : parts) sum += part;
  return sum;
}

std::vector<double> Anderson::mix(const Products& of) const {
  if (past_.empty()) return {};
  if (past_.size() == 1) return {of.newer > 0.0 ? of.newer_change / of.newer : 0.0};
  const double determinant = of.older * of.newer - of.older_newer * of.older_newer;
  // Nearly parallel differences say the same: the newer one is enough.
  if (!(determinant > 1e-6 * of.older * of.newer)) return {0.0, of.newer > 0.0 ? of.newer_change / of.newer : 0.0};
  return {(of.older_change * of.newer - of.newer_change * of.older_newer) / determinant,
          (of.newer_change * of.older - of.older_change * of.older_newer) / determinant};
}

std::vector<float> Anderson::mixed(const Step& now, const std::vector<double>& weights) {
  std::vector<float> next;
  const bool is_deep = past_.size() == kDepth;
  if (is_deep) {
    next = std::move(past_.front().image);
  } else {
    next.resize(now.image.size());
  }
  parallel_blocks(next.size(), kABlock, run_, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      auto x = double(now.image[i]);
      if (is_deep) x -= weights[0] * double(past_.back().image[i] - next[i]);
      if (!past_.empty()) x -= weights.back() * double(now.image[i] - past_.back().image[i]);
      next[i] = float(x);
    }
  });
  return next;
}

double Anderson::step(std::vector<float>& x, std::vector<float>& image) {
  Step now{.image = std::move(image), .change = std::move(x)};
  parallel_blocks(now.image.size(), kABlock, run_, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) now.change[i] = now.image[i] - now.change[i];
  });
  const Products of = products(now);
  x = mixed(now, mix(of));
  if (past_.size() == kDepth) {
    image = std::move(past_.front().change);
    past_.erase(past_.begin());
  }
  past_.push_back(std::move(now));
  const double norm = std::sqrt(of.change);
  const double size = std::sqrt(of.image);
  if (last_norm_ > 0.0) rate_ = std::max(rate_, std::min(kSlowest, norm / last_norm_));
  last_norm_ = norm;
  return size > 0.0 ? norm / size * rate_ / (1.0 - rate_) : 0.0;
}

}  // namespace isolux
