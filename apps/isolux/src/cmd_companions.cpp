#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "companion.h"

namespace isolux {
namespace {

/// A command that hands all that follows to a program of its own, --help included.
void add(CLI::App& program, Session& session, const std::string& command_name, const std::string& help,
         const std::string& companion) {
  CLI::App& command = *program.add_subcommand(command_name, help);
  command.prefix_command();
  command.set_help_flag();
  command.callback([&command, &session, companion] {
    session.on_run([&command, &session, companion] {
      throw_if_stopped(session.run);
      run_companion(companion, command.remaining());
    });
  });
}

}  // namespace

void add_companion_commands(CLI::App& program, Session& session) {
  add(program, session, "view", "The interactive window: isolux view [VOLUME] [--light LIGHT.nrrd]", "isolux-view");
  add(program, session, "bench", "Run time against error: isolux bench [SUITE ...] [-o DIR]", "isolux-bench");
}

}  // namespace isolux
