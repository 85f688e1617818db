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

/// Those that the kernels are compiled for, among those of this machine, the best first.
[[nodiscard]] inline std::vector<std::int64_t> wide_targets() {
  std::vector<std::int64_t> all;
  for (std::int64_t left = HWY_SUPPORTED_TARGETS & HWY_TARGETS; left != 0; left &= left - 1)
    all.push_back(left & -left);
  return all;
}

/// Calls body with the kernels at each of them.
template <class Body>
void on_every_target(const Body& body) {
  for (const std::int64_t target : wide_targets()) {
    choose_target(target);
    SCOPED_TRACE(hwy::TargetName(target));
    body();
  }
  choose_target(0);
}

[[nodiscard]] inline std::string wide_target_name(const ::testing::TestParamInfo<std::int64_t>& info) {
  return hwy::TargetName(info.param);
}

}  // namespace isolux::test
