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

/// Of the squared error, where it may be as small as asked by luck.
constexpr double kLeastStep = 0.9;
/// Of the sites' squared noise: some four times the rays, then it is judged anew whether they helped.
constexpr double kMostAtOnce = 0.125;

double squared_error(const HeldOut::SquaredError& found) { return std::max(found.mean, found.standard_error); }

}  // namespace

bool TexelTarget::is_reached() const {
  const HeldOut::SquaredError& error = rounds_.back().texels;
  return error.mean + error.standard_error <= target_;
}

double TexelTarget::power() const {
  const Round& last = rounds_.back();
  const auto telling = std::find_if(rounds_.rbegin(), rounds_.rend(),
                                    [&](const Round& r) { return r.sites >= kTellingFall * last.sites; });
  if (telling == rounds_.rend() || !(last.sites > 0.0)) return 1.0;
  const double fall = squared_error(telling->texels) / squared_error(last.texels);
  return std::min(1.0, std::log(fall) / std::log(telling->sites / last.sites));
}

double TexelTarget::wanted_noise() const {
  if (is_reached()) return 0.0;
  const double exponent = power();
  if (!(exponent > kLeastPower)) return 0.0;
  const Round& last = rounds_.back();
  // An error just below the one asked that is not sure wants a little less noise.
  const double fall = std::min(target_ / squared_error(last.texels), kLeastStep);
  return last.sites * std::max(std::pow(fall, 1.0 / exponent), kMostAtOnce);
}

}  // namespace isolux
