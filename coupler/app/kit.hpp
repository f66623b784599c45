// The subcommands beside a run: a case before it, its state during it, its record after it, a solver alone, other machines.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace coupler {

/// What a subcommand does, once the command line is known to be right; empty: none of these was given. The exit code.
using Action = std::function<int()>;

/// Adds the subcommands; `chosen` is set when one of them was given.
void add_kit_commands(CLI::App& app, Action& chosen);

// Each of them, in a source file of its name.
void add_conformance_command(CLI::App& app, Action& chosen);
void add_graph_command(CLI::App& app, Action& chosen);
void add_init_command(CLI::App& app, Action& chosen);
void add_keys_command(CLI::App& app, Action& chosen);
void add_profile_command(CLI::App& app, Action& chosen);
void add_replay_command(CLI::App& app, Action& chosen);
void add_schema_command(CLI::App& app, Action& chosen);
void add_slurm_command(CLI::App& app, Action& chosen);
void add_watch_command(CLI::App& app, Action& chosen);

}  // namespace coupler
