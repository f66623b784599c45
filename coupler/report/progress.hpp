// How far the run is: a bar on a terminal, a plain line every ten seconds elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace coupler {

/// Reports the windows of one phase on `stream` (stderr). Writes nothing about phases that end at once.
class Progress {
 public:
  /// `phase`: "relaxing", "marching". `n_windows`: expected (an upper bound where it is not known).
  Progress(std::string phase, std::int64_t n_windows, double window_s, std::FILE* stream = stderr);
  ~Progress();  ///< ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Window number `done` of the phase is complete; `note` is appended.
  void update(std::int64_t done, const std::string& note = {});

 private:
  using Clock = std::chrono::steady_clock;
  std::string line(std::int64_t done, double elapsed_s, const std::string& note) const;

  std::string phase_;
  std::int64_t n_windows_;
  double window_s_;
  std::FILE* stream_;
  bool terminal_, line_open_ = false;
  Clock::time_point start_, last_;
};

}  // namespace coupler
