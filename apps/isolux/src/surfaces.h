#pragma once

#include <functional>
#include <string>
#include <vector>

#include "isovalue_option.h"
#include "session.h"

namespace isolux {

/// The files that --output names for the isovalues of --iso: itself for a plain one; of a list or steps its one
/// placeholder is filled, {iso} with the isovalue as --iso tells it, %d with its number from 0 on, %03d with that in at
/// least three digits. \throw UsageError for several without a placeholder, with more than one placeholder, or if two
/// isovalues would have one file
[[nodiscard]] std::vector<std::string> output_names(const std::string& output, const IsovalueOption& isovalues);

/// An --output for several isovalues: checked before the work as other outputs are.
[[nodiscard]] FileOption outputs_of(const std::string& output, const IsovalueOption& isovalues);

/// Makes one surface after the other. Of one the report is the session's; of several each has one of its own, in the
/// list `surfaces` of the session's, which counts their seconds and has the sums of what they count.
void for_each_surface(const std::vector<std::string>& outputs, Session& session,
                      const std::function<void(std::size_t number)>& make);

}  // namespace isolux
