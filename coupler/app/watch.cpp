// `coupler watch`: where a run stands, again and again until it ends.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "coupler/app/kit.hpp"
#include "coupler/record/run_folder.hpp"
#include "coupler/record/run_status.hpp"
#include "coupler/report/status_view.hpp"
#include "proto/error.hpp"

namespace coupler {
namespace {

struct WatchOptions {
  std::string folder;
  bool once = false;
  double interval_s = 0.0;  ///< 0: by where it is shown
};

/// Draws over what it drew before on a terminal; a line at a time elsewhere.
class Screen {
 public:
  bool is_terminal() const { return terminal_; }
  void show(const RunStatus& status) {
    if (!terminal_) {
      fmt::print("{}\n", status_line(status));
    } else {
      if (n_lines_ > 0) fmt::print("\x1b[{}A\x1b[J", n_lines_);
      const auto text = status_block(status);
      n_lines_ = std::count(text.begin(), text.end(), '\n');
      fmt::print("{}", text);
    }
    std::fflush(stdout);
  }

 private:
  bool terminal_ = isatty(STDOUT_FILENO) != 0;
  std::ptrdiff_t n_lines_ = 0;
};

int watch_run(const WatchOptions& options) {
  const std::string path = options.folder + "/status.json";
  Screen screen;
  const double interval_s = options.interval_s > 0.0 ? options.interval_s : (screen.is_terminal() ? 0.5 : 10.0);
  for (;;) {
    const bool in_use = RunFolder::in_use(options.folder);  // before the status: what is then read is not older
    const auto status = read_status(path);
    screen.show(status);
    if (status.status != "running") return status.exit_code;
    if (!in_use)
      throw proto::Error(proto::ExitCode::unavailable, "the run ended without saying so: it was killed", options.folder,
                         "coupler run --resume goes on from its newest checkpoint");
    if (options.once) return 0;
    std::this_thread::sleep_for(std::chrono::duration<double>(interval_s));
  }
}

}  // namespace

void add_watch_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("watch", "show where a run stands until it ends; returns the run's exit code");
  const auto options = std::make_shared<WatchOptions>();
  command->add_option("DIR", options->folder, "folder of the run")->required();
  command->add_flag("--once", options->once, "show it once");
  command->add_option("--interval", options->interval_s, "seconds between two looks (0.5 on a terminal, else 10)")
      ->check(CLI::PositiveNumber);
  command->callback([options, &chosen] { chosen = [options] { return watch_run(*options); }; });
}

}  // namespace coupler
