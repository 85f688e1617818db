#pragma once

#include <CLI/App.hpp>

#include "session.h"

namespace isolux {

/// Each adds one command to the program; its work is handed to session.on_run().
void add_info_command(CLI::App& program, Session& session);
void add_backends_command(CLI::App& program, Session& session);
void add_extract_command(CLI::App& program, Session& session);
void add_bake_command(CLI::App& program, Session& session);
void add_render_command(CLI::App& program, Session& session);
void add_probe_command(CLI::App& program, Session& session);
void add_convert_command(CLI::App& program, Session& session);
/// `view` and `bench` are programs of their own beside this one, so that it links neither GL nor the benchmarks' peers.
void add_companion_commands(CLI::App& program, Session& session);

}  // namespace isolux
