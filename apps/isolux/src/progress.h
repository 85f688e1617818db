#pragma once

#include <functional>
#include <string_view>

namespace isolux {

/// Shows the progress of long work on stderr: a bar with the time left on a terminal, a plain line for each tenth
/// elsewhere. Stages that end within a second stay silent.
[[nodiscard]] std::function<void(std::string_view stage, double fraction)> make_progress();

}  // namespace isolux
