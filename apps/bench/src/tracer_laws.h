#pragma once

#include <string>

#include "figures.h"
#include "judge.h"
#include "suite.h"

namespace isolux::bench {

/// Tries every law of a tracer (docs/theory.md, "exact answers"): furnaces, the open integrating sphere, leaks, numbers
/// that go wrong, linearity, agreement with the scalar tracer, work a ray. `seconds` is spent on leaks; the others take
/// what they take.
void try_laws(const std::string& tracer, const SuiteContext& context, double seconds, Judge& judge);

/// Mean e in the white furnace over bounces: the curve that must rise to 1 and not past it.
[[nodiscard]] Series furnace_energy(const std::string& tracer, const SuiteContext& context);

}  // namespace isolux::bench
