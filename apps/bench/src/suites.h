#pragma once

#include "suite.h"

namespace isolux::bench {

[[nodiscard]] SuiteReport run_intersect(const SuiteContext& context);
[[nodiscard]] SuiteReport run_trace(const SuiteContext& context);
[[nodiscard]] SuiteReport run_extract(const SuiteContext& context);
[[nodiscard]] SuiteReport run_resample(const SuiteContext& context);
[[nodiscard]] SuiteReport run_sample(const SuiteContext& context);
[[nodiscard]] SuiteReport run_bake(const SuiteContext& context);
[[nodiscard]] SuiteReport run_thesis(const SuiteContext& context);
[[nodiscard]] SuiteReport run_stability(const SuiteContext& context);
[[nodiscard]] SuiteReport run_faults(const SuiteContext& context);

}  // namespace isolux::bench
