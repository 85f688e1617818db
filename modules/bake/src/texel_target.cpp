#include "texel_target.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

/// By what the sites' noise has to have fallen to tell how the texels' error follows it.
constexpr double kTellingFall = 2.0;
/// Where their squared error falls as a lower power of the sites' squared noise than this one, rays are not worth it:
/// at most that part of it is noise.
constexpr double kLeastPower = 0.25;
constexpr double kLeastPowerOfLittle = 0.5;  ///< where the sites' noise is less than the error asked

/// Of the squared error, where it may be as small as asked by luck.
constexpr double kLeastStep = 0.9;
/// Of the sites' squared noise: some four times the rays, then it is judged anew whether they helped.
constexpr double kMostAtOnce = 0.125;

/// Whether it is told from what the paths that judge it are wrong by.
bool is_known(const HeldOut::SquaredError& error) { return error.mean > error.standard_error; }

/// Whether it is no more than that, as far as they tell.
bool may_be(const HeldOut::SquaredError& error, double most) { return error.mean - 2.0 * error.standard_error <= most; }

}  // namespace

bool TexelTarget::is_reached() const {
  const auto& [sites, error] = rounds_.back();
  if (error.mean + error.standard_error <= target_) return true;
  // Of light that is more right than what judges it the sites' own noise has to do.
  return sites <= target_ && may_be(error, target_);
}

double TexelTarget::power() const {
  const Round& last = rounds_.back();
  if (!is_known(last.texels)) return 1.0;
  // Texels are no noisier than their sites.
  const double most = std::min(1.0, last.sites / last.texels.mean);
  const auto telling = std::find_if(rounds_.rbegin(), rounds_.rend(), [&](const Round& r) {
    return r.sites >= kTellingFall * last.sites && is_known(r.texels);
  });
  if (telling == rounds_.rend() || !(last.sites > 0.0)) return most;
  const double fall = telling->texels.mean / last.texels.mean;
  return std::min(most, std::log(fall) / std::log(telling->sites / last.sites));
}

double TexelTarget::wanted_noise() const {
  if (is_reached()) return 0.0;
  const auto& [sites, error] = rounds_.back();
  const double exponent = power();
  const double least = sites > target_ ? kLeastPower : kLeastPowerOfLittle;
  if (!may_be(error, target_) && !(exponent > least)) return 0.0;
  // The error asked is a place to look whether more helps, for texels are seldom more wrong than their sites.
  const double most = std::max(sites * kMostAtOnce, sites > target_ ? target_ : 0.0);
  if (!is_known(error)) return most;
  // An error just below the one asked that is not sure wants a little less noise.
  const double fall = std::min(target_ / error.mean, kLeastStep);
  return std::max(sites * std::pow(fall, 1.0 / std::max(exponent, kLeastPower)), most);
}

}  // namespace isolux
