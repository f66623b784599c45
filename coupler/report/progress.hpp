// How far the run is: a bar on a terminal, a plain line every ten seconds elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace coupler {

/// How fast a phase goes.
struct Pace {
  double windows_per_s = 0.0;
  double left_s = 0.0;  ///< of wall time, at this rate
};

/// "12 s", "3 min 05 s", "1 h 20 min".
std::string duration_text(double seconds);

/// Reports the windows of one phase on `stream` (stderr). Writes nothing about phases that end at once.
class Progress {
 public:
  /// `phase`: "relaxing", "marching". `n_windows`: expected (an upper bound where it is not known), of which `n_before`
  /// were done by an earlier run.
  Progress(std::string phase, std::int64_t n_windows, double window_s, std::int64_t n_before = 0,
           std::FILE* stream = stderr);
  ~Progress();  ///< ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Window number `done` of the phase is complete; `note` is appended.
  void update(std::int64_t done, const std::string& note = {});
  Pace pace(std::int64_t done) const;

 private:
  using Clock = std::chrono::steady_clock;
  std::string line(std::int64_t done, const std::string& note) const;

  std::string phase_;
  std::int64_t n_windows_;
  double window_s_;
  std::int64_t n_before_;
  std::FILE* stream_;
  bool terminal_, line_open_ = false;
  Clock::time_point start_, last_;
};

}  // namespace coupler
