#include "reading_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "standard_error.h"

namespace isolux {
namespace {

/// A site held out by so many rays of the bake: its paths are then some twentieth of the time.
constexpr std::size_t kRaysAHeldOut = 16384;
/// As many at least, if there are so many sites; paths of fewer cannot tell a bias from noise.
constexpr std::size_t kFewestHeldOut = 1024;
constexpr std::size_t kMostHeldOut = 4096;
constexpr std::size_t kSitesAHeldOut = 8;
/// From this albedo on paths may be long, hundreds of rays in closed spaces: a quarter of both sites and rays has to
/// do.
constexpr float kLasting = 0.95f;
/// Of the squared error asked, what reading may be wrong by so that less noise can make up for it.
constexpr double kMostReadingError = 0.75;

bool paths_last(const Scene& scene) {
  return std::any_of(scene.albedo.keys.begin(), scene.albedo.keys.end(), [](const auto& key) {
    return std::max({key.colour.x, key.colour.y, key.colour.z}) > kLasting;
  });
}

std::vector<std::size_t> sites_to_hold_out(std::size_t sites, const Scene& scene, const BakeSettings& settings,
                                           const Run& run) {
  const std::size_t by_rays =
      settings.target_rmse > 0.0 ? kMostHeldOut : sites * std::size_t(std::max(settings.trace.rays, 1)) / kRaysAHeldOut;
  const std::size_t part = paths_last(scene) ? 4 : 1;
  const std::size_t wanted = std::clamp(by_rays, kFewestHeldOut, kMostHeldOut) / part;
  return one_of_each_share(sites, std::min(wanted, (sites + kSitesAHeldOut - 1) / kSitesAHeldOut), run);
}

HeldOut hold_out(const Volume& volume, const Scene& scene, const Sites& sites, const BakeSettings& settings,
                 const Run& run) {
  TraceSettings judged = settings.trace;
  judged.nets = RayNets::kIndependent;
  judged.rays = settings.target_rmse > 0.0 && settings.target_rmse < 0.012 ? 128 : 64;
  if (paths_last(scene)) judged.rays /= 4;
  std::vector<std::size_t> numbers = sites_to_hold_out(sites.size(), scene, settings, run);
  const Sites some = some_of(sites, numbers);
  return {volume, scene, some, std::move(numbers), judged, run};
}

}  // namespace

ReadingError::ReadingError(const Volume& volume, const Scene& scene, const Sites& sites, const BakeSettings& settings,
                           const Run& run)
    : held_out_(hold_out(volume, scene, sites, settings, run)) {}

double ReadingError::of(const SampleSet& samples) const {
  std::vector<float> variances;
  for (const std::size_t i : held_out_.numbers()) variances.push_back(samples.variance[i]);
  const double noise = standard_error(variances);
  return std::sqrt(std::max(0.0, held_out_.squared_error(samples.radiance).mean - noise * noise));
}

bool reading_allows(double target_rmse, double reading_error) {
  return reading_error * reading_error < kMostReadingError * target_rmse * target_rmse;
}

double squared_noise_for(double target_rmse, double reading_error) {
  const double reading = reading_allows(target_rmse, reading_error) ? reading_error : 0.0;
  return target_rmse * target_rmse - reading * reading;
}

}  // namespace isolux
