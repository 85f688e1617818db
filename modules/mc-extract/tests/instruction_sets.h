#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>

namespace isolux::testing {

/// Calls body for each instruction set that this machine has.
template <class Body>
void on_every_instruction_set(const Body& body) {
  std::int64_t targets = hwy::SupportedTargets();
  for (; targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(target);
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace isolux::testing
