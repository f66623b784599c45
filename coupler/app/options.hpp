// What the command line asks for.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "coupler/study/options.hpp"

namespace coupler {

/// What `coupler converge` refines: H, the sub-cycles, or the cells of the rail seats.
enum class Refine { window, sub_cycles, cells };

struct RunOptions {
  std::string case_path;
  std::string out;                ///< empty: runs/<case>-<time>
  std::string scheme;             ///< a name, or empty: as the case says
  std::string fem, qdem;          ///< see use_programs(), or empty: as the case says
  double window_s = 0.0;          ///< instead of the case's; 0: as the case says [s]
  int sub_cycle_factor = 0;       ///< likewise; 0: as the case says
  Refine over = Refine::window;   ///< of converge_case()
  int n_threads = 0;              ///< of each participant; 0: as the environment says
  std::string resume;             ///< folder of an earlier run to go on in; empty: a new run
  std::set<std::string> allowed;  ///< of a resumed run: may differ ("case", "version", "program")
  double wall_limit_s = 0.0;      ///< stop in time with a checkpoint; 0: no limit [s]
  bool record = false;            ///< every frame goes to frames.log
  int n_restarts = 0;             ///< how often a run whose participant was lost goes on by itself
};

/// Exit code of a completed, or cleanly interrupted, run: 0, 128 + signal, 124 when the wall limit was reached. Throws
/// proto::Error when it fails.
int run_case(const RunOptions& options);

/// Goes on with the run in `options.resume` from its newest checkpoint; otherwise as run_case(). `options.case_path`
/// may be empty: the case is then read where the run found it.
int resume_run(const RunOptions& options);

/// Runs the case `n_levels` (>= 3) times, each refined by two against the one before, into folders of `options.out`;
/// prints the observed order of every seat's motion and force; writes convergence.csv, convergence.gnuplot and, where
/// gnuplot is installed, convergence.svg. Exit code as run_case(); throws proto::Error (numerics) when an order is more
/// than 0.2 below the expected one: the scheme's over windows, two over sub-cycles and cells.
int converge_case(const RunOptions& options, int n_levels);

struct AnalyzeOptions {
  std::string folder;  ///< of the run
  std::string out;     ///< empty: `folder`/analysis
  study::Options study;
};

/// Analyses a run, writes analysis.h5 and CSV files, prints the figures. Returns 0. Throws proto::Error (usage,
/// missing_input, bad_data, cannot_create, io_error); an analysis whose records are missing is a note, not an error.
int analyze_run(const AnalyzeOptions& options);

struct ReportOptions {
  std::vector<std::string> folders;  ///< of runs; the first one is shown in 3-D
  std::string out;                   ///< empty: report.html in the first folder; of several: comparison.html there
  double size_limit_mb = 30.0;       ///< of the page; fields and long tables are thinned to it
};

/// Writes the page. Returns 0. Throws proto::Error: missing_input (no such run; a build without the page), bad_data,
/// cannot_create, io_error.
int report_runs(const ReportOptions& options);

/// Validates the case: the coupler's own and the common sections, then each participant's `check`.
/// Returns 0, or the exit code of the participant that refused (which has said why on stderr). Throws proto::Error.
/// Of `options` the case, `fem` and `qdem` count.
int check_case(const RunOptions& options);

}  // namespace coupler
