// summary.json: the run in figures, for scripts and tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coupler/record/figures.hpp"
#include "coupler/scheme/observation.hpp"
#include "coupler/scheme/rest_watch.hpp"
#include "proto/wire/messages.hpp"

namespace coupler {

/// How a run that did not complete ended.
struct Failure {
  std::string message;
  std::string culprit;  ///< participant, or "coupler", "case", "user"
  int exit_code = 0;
};

struct Summary {
  std::string status;  ///< "ok" only when the run completed; "failed", "interrupted"
  std::string case_name, case_hash, scheme;
  std::int64_t n_windows = 0;  ///< committed
  std::int64_t n_windows_wanted = 0;
  double window_s = 0.0;
  std::uint32_t sub_cycles = 0;  ///< most in one window
  int initialise_windows = 0;
  RestFigures rest;                     ///< at its end
  std::uint64_t interface_hash = 0;     ///< InterfaceHash of all windows
  std::int64_t checkpoint_window = -1;  ///< of the newest set; -1: there is none
  int resumed = 0;                      ///< how often the run went on from a checkpoint
  double energy_defect_relative = 0.0, momentum_defect_relative = 0.0, moment_defect_relative = 0.0;
  Observation observation{0, 0.0};
  std::string switched_to;  ///< scheme that the audit switched to; "" if it did not
  std::vector<std::string> warnings;
  WallTime wall;
  std::vector<SeatFigures> seats;
  std::vector<proto::Fact> facts;  ///< land under their dotted keys; never over a key of the coupler's own
  Failure failure;                 ///< used unless status is "ok"
};

/// The JSON text. A number that is not finite becomes null.
std::string summary_text(const Summary& summary);

}  // namespace coupler
