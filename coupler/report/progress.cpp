#include "coupler/report/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "proto/clock.hpp"

namespace coupler {
namespace {

constexpr double bar_interval_s = 0.2, line_interval_s = 10.0;
constexpr int bar_width = 28;

}  // namespace

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(std::string phase, std::int64_t n_windows, double window_s, std::int64_t n_before, std::FILE* stream)
    : phase_(std::move(phase)),
      n_windows_(n_windows),
      window_s_(window_s),
      n_before_(n_before),
      stream_(stream),
      terminal_(isatty(fileno(stream)) != 0),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (line_open_) std::fputc('\n', stream_);
}

Pace Progress::pace(std::int64_t done) const {
  const double elapsed_s = proto::seconds_since(start_);
  Pace pace;
  if (elapsed_s > 0.0) pace.windows_per_s = static_cast<double>(done - n_before_) / elapsed_s;
  if (pace.windows_per_s > 0.0) pace.left_s = static_cast<double>(n_windows_ - done) / pace.windows_per_s;
  return pace;
}

std::string Progress::line(std::int64_t done, const std::string& note) const {
  const double share = n_windows_ > 0 ? static_cast<double>(done) / static_cast<double>(n_windows_) : 1.0;
  const auto [rate, left_s] = pace(done);
  return fmt::format("{} {:3.0f} %  {:.5g} s simulated  {:.3g} windows/s  {} left{}{}", phase_, 100.0 * share,
                     static_cast<double>(done) * window_s_, rate, duration_text(left_s), note.empty() ? "" : "  ",
                     note);
}

void Progress::update(std::int64_t done, const std::string& note) {
  const auto now = Clock::now();
  const double interval = terminal_ ? bar_interval_s : line_interval_s;
  if (std::chrono::duration<double>(now - last_).count() < interval) return;
  last_ = now;
  const auto text = line(done, note);
  if (!terminal_) {
    fmt::print(stream_, "{}\n", text);
    return;
  }
  const int filled = static_cast<int>(
      bar_width * std::min(1.0, static_cast<double>(done) / std::max<double>(1.0, static_cast<double>(n_windows_))));
  fmt::print(stream_, "\r[{:#<{}}{:<{}}] {}\x1b[K", "", filled, "", bar_width - filled, text);
  std::fflush(stream_);
  line_open_ = true;
}

}  // namespace coupler
