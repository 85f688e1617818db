#include "suites.h"

namespace isolux::bench {

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all{
      {"intersect", "Ray-cell intersection",
       "Nanoseconds against hit error and wrong hits, ours and the published ones", run_intersect, 60.0},
      {"trace", "Tracing", "Million rays a second of every tracer over sizes and threads, beside Embree", run_trace,
       200.0},
      {"extract", "Extraction", "Milliseconds against geometric error, beside VTK and OpenMesh", run_extract, 90.0},
      {"resample", "Resampling", "Milliseconds against error of every resampler, on exact samples", run_resample,
       150.0},
      {"sample", "Sampling", "Error against the number of sites and of rays, with fitted rates", run_sample, 90.0},
      {"bake", "Baking", "Seconds against error of e at points of many level sets, beside other methods", run_bake,
       280.0},
      {"thesis", "The thesis's tables", "Tables 5.1 to 5.4 of Challis 2010 rerun, theirs beside ours", run_thesis,
       80.0},
      {"stability", "Stability", "Laws that have to hold however the volume looks", run_stability, 120.0},
      {"faults", "What a fault looks like",
       "The laws and figures of tracers that are wrong or slow on purpose, beside the healthy one", run_faults, 40.0},
  };
  return all;
}

Budget budget_of(const Suite& suite, Effort effort) {
  constexpr double kQuickSeconds = 35.0;
  constexpr double kSmokeSeconds = 1.5;
  if (effort == Effort::kFull) return Budget(suite.full_seconds);
  return Budget(effort == Effort::kQuick ? kQuickSeconds : kSmokeSeconds);
}

std::string_view effort_name(Effort effort) {
  if (effort == Effort::kFull) return "full";
  return effort == Effort::kQuick ? "quick" : "smoke";
}

}  // namespace isolux::bench
