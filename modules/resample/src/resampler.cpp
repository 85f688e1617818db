#include <isolux/core/error.h>
#include <isolux/resample/resampler.h>

namespace isolux {

void Resampler::add_part(const Volume& /*volume*/, const SampleSet& /*samples*/, ResampledGrid& /*texels*/,
                         const Run& /*run*/) const {
  throw InvalidInput("this resampler takes all samples at once");
}

}  // namespace isolux
