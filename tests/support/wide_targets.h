// Instruction sets for tests of the wide kernels.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <string>
#include <vector>

namespace isolux::test {

/// The kernels run at one instruction set from here on; 0: at the best again.
inline void choose_target(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Those that the kernels are compiled for, among those of this machine.
[[nodiscard]] inline std::vector<std::int64_t> wide_targets() {
  std::vector<std::int64_t> all;
  for (const std::int64_t t : {HWY_SCALAR, HWY_EMU128, HWY_SSE4, HWY_AVX2, HWY_AVX3, HWY_NEON})
    if ((hwy::SupportedTargets() & t) != 0) all.push_back(t);
  return all;
}

[[nodiscard]] inline std::string wide_target_name(const ::testing::TestParamInfo<std::int64_t>& info) {
  return hwy::TargetName(info.param);
}

}  // namespace isolux::test
