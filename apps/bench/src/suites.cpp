#include "suites.h"

namespace isolux::bench {

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all{
      {"intersect", "Ray-cell intersection",
       "Nanoseconds against hit error and wrong hits, ours and the published ones", run_intersect},
      {"trace", "Tracing", "Million rays a second of every tracer over sizes and threads, beside Embree", run_trace},
      {"extract", "Extraction", "Milliseconds against geometric error, beside VTK and OpenMesh", run_extract},
      {"resample", "Resampling", "Milliseconds against error of every resampler, on exact samples", run_resample},
      {"sample", "Sampling", "Error against the number of sites and of rays, with fitted rates", run_sample},
      {"bake", "Baking", "Seconds against error of e at points of many level sets, beside other methods", run_bake},
      {"thesis", "The thesis's tables", "Tables 5.1 to 5.4 of Challis 2010 rerun, theirs beside ours", run_thesis},
      {"stability", "Stability", "Laws that have to hold however the volume looks", run_stability},
  };
  return all;
}

}  // namespace isolux::bench
