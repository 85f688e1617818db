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

double Anderson::dot(const std::vector<float>& a, const std::vector<float>& b) const {
  std::vector<double> parts(block_count(a.size(), kABlock));
  parallel_blocks(a.size(), kABlock, run_, "", [&](const Block& block) {
    double sum = 0.0;
    for (std::size_t i = block.begin; i < block.end; ++i) sum += double(a[i]) * double(b[i]);
    parts[block.index] = sum;
  });
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

std::vector<double> Anderson::mix(const std::vector<float>& change) const {
  if (past_.empty()) return {};
  const double aa = dot(past_[0].change, past_[0].change);
  const double ac = dot(past_[0].change, change);
  if (past_.size() == 1) return {aa > 0.0 ? ac / aa : 0.0};
  const double bb = dot(past_[1].change, past_[1].change);
  const double ab = dot(past_[0].change, past_[1].change);
  const double bc = dot(past_[1].change, change);
  const double determinant = aa * bb - ab * ab;
  // Nearly parallel differences say the same: the newer one is enough.
  if (!(determinant > 1e-6 * aa * bb)) return {0.0, bb > 0.0 ? bc / bb : 0.0};
  return {(ac * bb - bc * ab) / determinant, (bc * aa - ac * ab) / determinant};
}

double Anderson::step(std::vector<float>& x, std::vector<float> image) {
  std::vector<float> change(x.size());
  const bool has_last = !last_image_.empty();
  if (has_last && past_.size() == kDepth) std::rotate(past_.begin(), past_.begin() + 1, past_.end());
  if (has_last && past_.size() < kDepth) past_.emplace_back();
  if (has_last) {
    past_.back().image.resize(x.size());
    past_.back().change.resize(x.size());
  }
  parallel_blocks(x.size(), kABlock, run_, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      change[i] = image[i] - x[i];
      if (!has_last) continue;
      past_.back().image[i] = image[i] - last_image_[i];
      past_.back().change[i] = change[i] - last_change_[i];
    }
  });
  const std::vector<double> weights = mix(change);
  parallel_blocks(x.size(), kABlock, run_, "", [&](const Block& block) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      double next = double(image[i]);
      for (std::size_t j = 0; j < weights.size(); ++j) next -= weights[j] * double(past_[j].image[i]);
      x[i] = float(next);
    }
  });
  const double norm = std::sqrt(dot(change, change));
  const double size = std::sqrt(dot(image, image));
  if (last_norm_ > 0.0) rate_ = std::max(rate_, std::min(kSlowest, norm / last_norm_));
  last_norm_ = norm;
  last_image_ = std::move(image);
  last_change_ = std::move(change);
  return size > 0.0 ? norm / size * rate_ / (1.0 - rate_) : 0.0;
}

}  // namespace isolux
