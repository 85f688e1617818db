#include "suites.h"

namespace isolux::bench {

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all{
      {"resample", "Resampling", "Milliseconds against error of every resampler, on exact samples", run_resample},
      {"sample", "Sampling", "Error against the number of sites and of rays, with fitted rates", run_sample},
  };
  return all;
}

}  // namespace isolux::bench
