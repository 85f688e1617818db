// isolux: the command line. Commands, options, files and exit codes are those of docs/command-line.md.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/bake/version.h>
#include <isolux/core/options.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "commands.h"
#include "program.h"
#include "session.h"
#include "usage.h"

namespace {

/// \throw UsageError if the first word is neither an option nor a command; CLI11 would only say that a command is
/// missing.
void require_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2) return;
  const std::string word = argv[1];
  if (word.starts_with('-')) {
    if (program.get_option_no_throw(word) != nullptr) return;
    throw isolux::UsageError(
        fmt::format("'{}' before the command: allowed there are --help and --version; what a command takes goes behind "
                    "it, as in isolux info VOLUME --quiet",
                    word));
  }
  std::vector<std::string> known;
  for (const CLI::App* command : program.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  const std::string near = isolux::nearest_word(word, known);
  throw isolux::UsageError(fmt::format("no command is called '{}'{}; there are {}", word,
                                       near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                       fmt::join(known, ", ")));
}

const CLI::App& chosen(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? program : *commands.front();
}

int work(int argc, char** argv, isolux::Session& session, std::string& what) {
  CLI::App program(
      "Every isosurface of a volume in true light.\nFirst light a volume (bake), then draw (render, view) or export "
      "(extract) any isosurface of it.",
      "isolux");
  program.set_version_flag("--version", std::string("isolux ") + isolux::kVersion);
  program.require_subcommand(1);
  program.fallthrough(false);
  isolux::add_info_command(program, session);
  isolux::add_backends_command(program, session);
  isolux::add_extract_command(program, session);
  isolux::add_bake_command(program, session);
  isolux::add_render_command(program, session);
  isolux::add_probe_command(program, session);
  isolux::add_convert_command(program, session);
  isolux::add_companion_commands(program, session);
  require_command(program, argc, argv);
  const std::string empty = isolux::word_without_value(argc, argv);
  if (!empty.empty()) throw isolux::UsageError(fmt::format("'{}': a value is missing", empty));
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return isolux::print_help(program, help);
  } catch (const CLI::ParseError& error) {
    const CLI::App& app = chosen(program);
    if (&app != &program) what = app.get_name();
    throw isolux::UsageError(isolux::explain(error, app));
  }
  what = chosen(program).get_name();
  session.run_action();
  return isolux::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return isolux::run_program(
      "command line", [&](isolux::Session& session, std::string& what) { return work(argc, argv, session, what); });
}
