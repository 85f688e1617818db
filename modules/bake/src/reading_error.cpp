#include "reading_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "standard_error.h"

namespace isolux {
namespace {

/// What is measured to be less may be so much by chance: this part of the uncertainty is about what to expect of
/// something above 0 that was measured a little below it.
constexpr double kLeastPart = 0.5;
/// Of the squared error asked, what reading may be wrong by so that less noise can make up for it.
constexpr double kMostReadingError = 0.75;

HeldOut hold_out(const Volume& volume, const Scene& scene, const Sites& sites, const BakeSettings& settings,
                 const Run& run) {
  const std::size_t most = places_to_judge_by(sites.size(), scene, settings);
  std::vector<std::size_t> numbers = one_of_each_share(sites.size(), std::min(most, sites.size()), run);
  const Sites some = some_of(sites, numbers);
  const TraceSettings paths = paths_of_each(numbers.size(), sites.size(), scene, settings);
  return {volume, scene, some, std::move(numbers), paths, run};
}

}  // namespace

ReadingError::ReadingError(const Volume& volume, const Scene& scene, const Sites& sites, const BakeSettings& settings,
                           const Run& run)
    : held_out_(hold_out(volume, scene, sites, settings, run)) {}

double ReadingError::of(const SampleSet& samples) const {
  if (held_out_.numbers().empty()) return 0.0;
  std::vector<float> variances;
  for (const std::size_t i : held_out_.numbers()) variances.push_back(samples.variance[i]);
  const double noise = standard_error(variances);
  const HeldOut::SquaredError squared = held_out_.squared_error(samples.radiance);
  return std::sqrt(std::max(squared.mean - noise * noise, kLeastPart * squared.standard_error));
}

bool reading_allows(double target_rmse, double reading_error) {
  return reading_error * reading_error < kMostReadingError * target_rmse * target_rmse;
}

double squared_noise_for(double target_rmse, double reading_error) {
  const double reading = reading_allows(target_rmse, reading_error) ? reading_error : 0.0;
  return target_rmse * target_rmse - reading * reading;
}

}  // namespace isolux
