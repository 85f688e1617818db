#include "anderson.h"

#include <isolux/core/parallel.h>

#include <cmath>
#include <cstddef>
#include <utility>

namespace isolux {
namespace {

constexpr std::size_t kDepth = 2;
constexpr std::size_t kABlock = 65536;

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

Anderson::ByChannel Anderson::products(const Step& now) const {
  const std::size_t channels = contractions_.size();
  std::vector<ByChannel> parts(block_count(now.change.size(), kABlock));
  parallel_blocks(now.change.size(), kABlock, run_, "", [&](const Block& block) {
    ByChannel sums{};
    std::size_t channel = block.begin % channels;
    for (std::size_t i = block.begin; i < block.end; ++i) {
      Products& sum = sums[channel];
      if (++channel == channels) channel = 0;
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
    parts[block.index] = sums;
  });
  ByChannel sums{};
  for (const ByChannel& part : parts)
    for (std::size_t c = 0; c < channels; ++c) sums[c] += part[c];
  return sums;
}

Anderson::Weights Anderson::mix(const Products& of) const {
  if (past_.empty()) return {};
  // Nearly parallel differences say the same: the newer one is enough.
  const Weights newer{0.0, of.newer > 0.0 ? of.newer_change / of.newer : 0.0};
  if (past_.size() < kDepth) return newer;
  const double determinant = of.older * of.newer - of.older_newer * of.older_newer;
  if (!(determinant > 1e-6 * of.older * of.newer)) return newer;
  return {(of.older_change * of.newer - of.newer_change * of.older_newer) / determinant,
          (of.newer_change * of.older - of.older_change * of.older_newer) / determinant};
}

std::vector<float> Anderson::mixed(const Step& now, const std::array<Weights, kMostChannels>& weights) {
  const std::size_t channels = contractions_.size();
  std::vector<float> next;
  const bool is_deep = past_.size() == kDepth;
  if (is_deep) {
    next = std::move(past_.front().image);
  } else {
    next.resize(now.image.size());
  }
  parallel_blocks(next.size(), kABlock, run_, "", [&](const Block& block) {
    std::size_t channel = block.begin % channels;
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const auto [older, newer] = weights[channel];
      if (++channel == channels) channel = 0;
      auto x = double(now.image[i]);
      if (is_deep) x -= older * double(past_.back().image[i] - next[i]);
      if (!past_.empty()) x -= newer * double(now.image[i] - past_.back().image[i]);
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
  const ByChannel of = products(now);
  std::array<Weights, kMostChannels> weights{};
  double left = 0.0;
  double size = 0.0;
  for (std::size_t c = 0; c < contractions_.size(); ++c) {
    weights[c] = mix(of[c]);
    const double most = contractions_[c] / (1.0 - contractions_[c]);
    left += most * most * of[c].change;
    size += of[c].image;
  }
  x = mixed(now, weights);
  if (past_.size() == kDepth) {
    image = std::move(past_.front().change);
    past_.erase(past_.begin());
  }
  past_.push_back(std::move(now));
  return size > 0.0 ? std::sqrt(left / size) : 0.0;
}

}  // namespace isolux
