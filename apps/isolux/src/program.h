#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace isolux {

class Session;

/// Of all programs; docs/command-line.md promises them.
enum ExitStatus { kDone = 0, kFailed = 1, kUsage = 2, kInterrupted = 130 };

/// What the main() of each program does around its work: it has arrays' memory used again, opens standard streams,
/// makes limits of file size errors like a full disk and interrupts the session's stop token, and turns what the work
/// throws into one line on stderr and an exit status. `what` is the line's first word; the work may choose a better
/// one.
int run_program(std::string what, const std::function<int(Session& session, std::string& what)>& work);

/// What CLI11 prints instead of working, such as help. \throw IoError if it does not reach standard output
int print_help(const CLI::App& program, const CLI::Success& help);

}  // namespace isolux
