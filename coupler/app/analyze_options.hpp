// The command line of `coupler analyze`.
#pragma once

#include <CLI/CLI.hpp>

#include "coupler/app/options.hpp"

namespace coupler {

/// Adds the subcommand; `options` is filled when it was given.
CLI::App* add_analyze_command(CLI::App& app, AnalyzeOptions& options);

}  // namespace coupler
