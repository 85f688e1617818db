#pragma once

#include <filesystem>
#include <string>

#include "figures.h"
#include "suite.h"

namespace isolux::bench {

/// What the figures were taken on: processor, memory, compiler, flags, versions of peers, in Markdown.
[[nodiscard]] std::string machine_description(const SuiteContext& context);

/// Writes SUITE.json, a CSV file for each figure, an SVG picture for each plot, and SUITE.md. \throw IoError
void write_suite(const std::filesystem::path& folder, const Suite& suite, const SuiteReport& report,
                 const SuiteContext& context, double seconds);

/// Writes report.md: the machine, and SUITE.md of every suite that the folder holds, those of earlier runs included.
/// \throw IoError
void write_report(const std::filesystem::path& folder, const SuiteContext& context);

}  // namespace isolux::bench
