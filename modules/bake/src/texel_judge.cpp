#include "texel_judge.h"

#include <isolux/core/stopwatch.h>
#include <isolux/resample/light_reader.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "held_out.h"
#include "level_set_places.h"

namespace isolux {
namespace {

/// From so many on a root mean square is known to an eighth, 1 / sqrt(2 * 32), if errors are normal.
constexpr std::size_t kFewestToJudgeBy = 32;

/// Places, at most so many, that stand for what is read: texels, or of known level sets points of these. Few texels,
/// and of labels special ones, lie on a level set. None if there are too few.
Sites places_to_judge(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Lattice& texels,
                      std::size_t most, const Run& run) {
  const SiteRequest request{
      .texels = texels, .isovalues = settings.isovalues, .outer = scene.outer, .gradient = settings.trace.gradient};
  Sites sites;
  if (settings.isovalues) {
    sites = level_set_places(volume, request, most, run);
  } else {
    const TexelSiteMaker maker(volume, request, run);
    sites = maker.make(held_out_texels(texels, maker, most, 1, run));
  }
  return sites.size() < kFewestToJudgeBy ? Sites{} : sites;
}

/// e as it is read at the sites.
std::vector<float> read_at(const Volume& volume, const Sites& sites, const IlluminationGrid& light, const Run& run) {
  const LightReader reader(volume, light, TexelStorage::kLent, run);
  const auto channels = std::size_t(light.channels);
  std::vector<float> found(sites.size() * channels);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3f e = reader.at_index(Vec3(sites.positions[i]), double(sites.isovalues[i]));
    for (std::size_t c = 0; c < channels; ++c) found[i * channels + c] = e[int(c)];
  }
  return found;
}

std::vector<std::size_t> numbers_below(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t(0));
  return numbers;
}

/// To where the root of the texels' mean square is `rms`.
void scale_errors(double rms, IlluminationGrid& errors) {
  double squares = 0.0;
  for (const float error : errors.values) squares += double(error) * double(error);
  if (!(squares > 0.0)) return;
  const auto by = float(rms / std::sqrt(squares / double(errors.values.size())));
  for (float& error : errors.values) error *= by;
}

}  // namespace

bool are_sites_own(const Resampler& resampler, const BakeSettings& settings) {
  return settings.sampler.name == "texels" && resampler.takes_parts();
}

TexelJudge::TexelJudge(const Volume& volume, const Scene& scene, const BakeSettings& settings, std::size_t sites,
                       const Run& run)
    : volume_(volume),
      places_(places_to_judge(volume, scene, settings, texel_lattice(volume.lattice(), settings),
                              places_to_judge_by(sites, scene, settings), run)),
      held_out_(volume, scene, places_, numbers_below(places_.size()),
                paths_of_each(places_.size(), sites, scene, settings), run) {}

bool TexelJudge::can_judge() const { return held_out_.numbers().size() >= kFewestToJudgeBy; }

std::optional<HeldOut::SquaredError> TexelJudge::squared_error(const IlluminationGrid& light, const Run& run) const {
  if (!can_judge()) return {};
  return held_out_.squared_error(read_at(volume_, places_, light, run));
}

void tell_error(const std::optional<HeldOut::SquaredError>& error, BakeResult& result) {
  if (!error) return;
  // Places can agree by chance.
  result.rmse_estimate = std::sqrt(std::max(error->mean, error->standard_error));
  if (result.error) scale_errors(result.rmse_estimate, *result.error);
}

void judge_texels(const Volume& volume, const Scene& scene, const BakeSettings& settings, const Run& run,
                  BakeResult& result) {
  const Stopwatch watch;
  const TexelJudge judge(volume, scene, settings, result.sites, run);
  tell_error(judge.squared_error(result.light, run), result);
  count_judging(judge.held_out(), result);
  result.seconds["trace"] += watch.seconds();
}

}  // namespace isolux
