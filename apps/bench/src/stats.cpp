#include "stats.h"

#include <fmt/format.h>
#include <isolux/core/random.h>
#include <isolux/core/stopwatch.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace isolux::bench {

double quantile(std::span<const double> values, double p) {
  assert(!values.empty());
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double at = p * double(sorted.size() - 1);
  const auto below = std::size_t(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - double(below)) * (sorted[above] - sorted[below]);
}

Estimate median(std::span<const double> values) {
  return {.value = quantile(values, 0.5), .low = quantile(values, 0.25), .high = quantile(values, 0.75)};
}

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / double(values.size());
}

double rms(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / double(values.size()));
}

Estimate rms_interval(std::span<const double> errors, std::uint64_t seed) {
  constexpr std::uint64_t kResamples = 200;
  std::vector<double> resampled;
  for (std::uint64_t r = 0; r < kResamples && !errors.empty(); ++r) {
    RandomStream random(seed, r);
    double sum = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const double e = errors[std::size_t(random.uniform_double() * double(errors.size()))];
      sum += e * e;
    }
    resampled.push_back(std::sqrt(sum / double(errors.size())));
  }
  if (resampled.empty()) return {};
  return {.value = rms(errors), .low = quantile(resampled, 0.025), .high = quantile(resampled, 0.975)};
}

namespace {

/// The 97.5 % quantile of Student's t.
double student_95(std::size_t degrees) {
  constexpr std::array<double, 10> kQuantiles{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  return degrees <= kQuantiles.size() ? kQuantiles[degrees - 1] : 1.96 + 2.5 / double(degrees);
}

}  // namespace

PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size() && x.size() >= 2);
  const auto n = double(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
    xy += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
  }
  PowerLaw law;
  law.exponent = xy / xx;
  law.factor = std::exp(mean_y - law.exponent * mean_x);
  if (x.size() > 2) {
    double residual = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double d = std::log(y[i]) - mean_y - law.exponent * (std::log(x[i]) - mean_x);
      residual += d * d;
    }
    law.exponent_error = std::sqrt(residual / (n - 2.0) / xx);
    law.exponent_bar = student_95(x.size() - 2) * law.exponent_error;
  }
  return law;
}

std::string bar_text(const PowerLaw& law) {
  return std::isnan(law.exponent_bar) ? std::string() : fmt::format("{:.2f}", law.exponent_bar);
}

PowerLaw fit_power_law(std::span<const PlotPoint> points) {
  std::vector<double> x;
  std::vector<double> y;
  for (const PlotPoint& p : points) {
    x.push_back(p.x);
    y.push_back(p.y);
  }
  return fit_power_law(x, y);
}

Estimate timed(const std::function<void()>& body, int repetitions, double budget_seconds) {
  std::vector<double> seconds;
  const Stopwatch all;
  do {
    const Stopwatch one;
    body();
    seconds.push_back(one.seconds());
  } while (int(seconds.size()) < repetitions && all.seconds() < budget_seconds);
  return median(seconds);
}

}  // namespace isolux::bench
