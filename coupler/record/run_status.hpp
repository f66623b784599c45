// status.json: where a run stands, renewed while it runs. `coupler watch` shows it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "coupler/record/figures.hpp"

namespace coupler {

struct SeatNow {
  std::string name;
  double force_n = 0.0;  ///< window mean along the normal, summed over the cells
};

struct RunStatus {
  std::string status = "running";  ///< at the end as Summary::status
  int exit_code = 0;               ///< at the end
  std::string case_name, scheme;
  std::string phase = "starting";  ///< then "relaxing", "marching"
  std::string note;                ///< what a long set-up does; why a run failed
  std::int64_t n_windows = 0;      ///< of the phase
  std::int64_t n_windows_wanted = 0;
  double simulated_s = 0.0;  ///< of the phase
  double windows_per_s = 0.0;
  double left_s = 0.0;  ///< of wall time, at this rate
  std::vector<SeatNow> seats;
  double energy_defect_relative = 0.0, momentum_defect_relative = 0.0;
  WallTime wall;
};

/// JSON; `updated_s` says when, in seconds since 1970.
std::string status_text(const RunStatus& status);

/// Throws proto::Error: missing_input (there is none), bad_data.
RunStatus read_status(const std::string& path);

/// The file of one run. It is replaced whole, so that a reader never sees half of it. A write that fails is left out:
/// the record shares its disk and says why.
class StatusFile {
 public:
  explicit StatusFile(std::string path) : path_(std::move(path)) {}

  RunStatus& now() { return now_; }
  void renew();  ///< at most once a second
  void write();  ///< at once

 private:
  std::string path_;
  RunStatus now_;
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace coupler
