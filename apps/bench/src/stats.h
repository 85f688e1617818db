#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "figures.h"

namespace isolux::bench {

/// A value and the ends of its interval.
struct Estimate {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The p-quantile (0 to 1), linear between order statistics (type 7 of Hyndman & Fan 1996). \pre not empty
[[nodiscard]] double quantile(std::span<const double> values, double p);
/// Median with quartiles. \pre not empty
[[nodiscard]] Estimate median(std::span<const double> values);

[[nodiscard]] double mean(std::span<const double> values);
[[nodiscard]] double rms(std::span<const double> values);
/// rms with its 95 % interval by the percentile bootstrap (Efron & Tibshirani 1993), 200 resamples keyed by `seed`.
[[nodiscard]] Estimate rms_interval(std::span<const double> errors, std::uint64_t seed);

/// y = factor * x^exponent
struct PowerLaw {
  double factor = 0.0;
  double exponent = 0.0;
  double exponent_error = 0.0;  ///< standard error of the exponent; 0 for two points
  double exponent_bar = kNone;  ///< half the 95 % interval of the exponent by Student's t; none for two points
};
/// Least squares in logarithms. \pre at least two points, all positive
[[nodiscard]] PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);
[[nodiscard]] PowerLaw fit_power_law(std::span<const PlotPoint> points);
/// exponent_bar for a table; empty if there is none.
[[nodiscard]] std::string bar_text(const PowerLaw& law);

/// Seconds of `body`, repeated until `repetitions` are done or `budget_seconds` are spent, at least once: median and
/// quartiles.
[[nodiscard]] Estimate timed(const std::function<void()>& body, int repetitions, double budget_seconds);

}  // namespace isolux::bench
