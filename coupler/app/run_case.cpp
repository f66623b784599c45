#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <string.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <thread>

#include "coupler/app/coupled_run.hpp"
#include "coupler/app/options.hpp"
#include "coupler/app/resumption.hpp"
#include "coupler/report/run_table.hpp"
#include "proto/result/provenance.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int interrupted_base = 128;     // as shells report it: 128 + signal
constexpr int out_of_time_code = 124;     // as timeout(1) reports it
constexpr double longest_pause_s = 60.0;  // before a restart

/// run.log of one run; every line is on the disk when the call returns.
class RunLog {
 public:
  explicit RunLog(const std::string& path) : logger_("run", std::make_shared<spdlog::sinks::basic_file_sink_st>(path)) {
    logger_.set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
    logger_.flush_on(spdlog::level::info);
  }
  spdlog::logger& logger() { return logger_; }

 private:
  spdlog::logger logger_;
};

Summary blank_summary(const CaseInput& input) {
  Summary summary;
  summary.status = "failed";
  summary.case_name = input.file.name();
  summary.case_hash = fmt::format("{:016x}", input.file.hash());
  summary.scheme = proto::name_of(input.coupling.scheme);
  summary.window_s = input.coupling.window_s;
  summary.n_windows_wanted = static_cast<std::int64_t>(input.coupling.n_windows);
  return summary;
}

Failure stopped_by_user(int signal, const std::string& stage) {
  return {fmt::format("stopped by signal {} ({}) - {}", signal, strsignal(signal), stage), "user",
          interrupted_base + signal};
}

/// What a run was asked for, beside the case.
struct Orders {
  int n_threads = 0, n_restarts = 0;
  bool record = false;  ///< every frame
  int n_failures = 0;   ///< since the last checkpoint
  std::optional<Clock::time_point> deadline;
  std::optional<Checkpoint> set;  ///< to go on from
  std::set<std::string> allowed;  ///< to differ from what made it
};

/// Sets status and failure of a run whose march ended during `stage`; returns the exit code.
int judge(MarchEnd end, int signal, const std::string& stage, Summary& summary) {
  summary.status = end == MarchEnd::complete ? "ok" : "interrupted";
  if (end == MarchEnd::stopped_by_user) summary.failure = stopped_by_user(signal, stage);
  if (end == MarchEnd::out_of_time)
    summary.failure = {"stopped at the limit of wall time - " + stage, "user", out_of_time_code};
  return end == MarchEnd::complete ? 0 : summary.failure.exit_code;
}

/// The whole run; fills the summary. Returns the exit code, throws what ended it early.
int carry_out(CoupledRun& run, Summary& summary, const Orders& orders) {
  if (orders.record) run.record_frames();
  run.start(orders.n_threads);
  run.set_up();
  if (orders.set) {
    run.resume(*orders.set, orders.allowed);
  } else {
    run.initialise();
    run.begin();
  }
  const auto end = run.march(orders.deadline);
  const std::string stage = run.stage();
  run.finish();
  return judge(end, run.stop_signal(), stage, summary);
}

/// Whether a failure may be due to where it ran and not to what was run.
bool may_pass(const ParticipantError& error) {
  return error.code() == proto::ExitCode::unavailable;
}

int run_guarded(const CaseInput& input, const RunFolder& folder, spdlog::logger& log, Summary& summary,
                StatusFile& status, Orders& orders) {
  CoupledRun run(input, folder, log, summary, status);
  const auto give_up = [&](const Failure& failure) {
    summary.failure = failure;
    run.abandon(failure.exit_code, failure.message);
  };
  try {
    return carry_out(run, summary, orders);
  } catch (const Interrupted& stop) {
    give_up(stopped_by_user(stop.signal(), run.stage()));
    summary.status = "interrupted";
    return summary.failure.exit_code;
  } catch (const ParticipantError& error) {
    give_up({error.what(), error.participant(), static_cast<int>(error.code())});
    if (run.has_checkpoint()) orders.n_failures = 0;
    throw;
  } catch (const proto::Error& error) {
    give_up({error.what(), "coupler", static_cast<int>(error.code())});
    throw;
  }
}

/// Goes on from the newest checkpoint, or from the beginning, after a participant was lost: at most `n_restarts` times
/// without a new checkpoint in between, after 1, 2, 4, ... s.
int run_with_restarts(const CaseInput& input, const RunFolder& folder, spdlog::logger& log, Summary& summary,
                      StatusFile& status, Orders orders) {
  const Summary blank = summary;
  for (;;) {
    try {
      return run_guarded(input, folder, log, summary, status, orders);
    } catch (const ParticipantError& error) {
      if (!may_pass(error) || orders.n_failures >= orders.n_restarts) throw;
      const double pause_s = std::min(longest_pause_s, std::ldexp(1.0, orders.n_failures++));
      const auto text =
          fmt::format("{}; restart {} of {} in {:g} s", error.what(), orders.n_failures, orders.n_restarts, pause_s);
      log.warn("{}", text);
      fmt::print(stderr, "coupler: {}\n", text);
      std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
      const int n_resumed = summary.resumed;
      summary = blank;
      summary.resumed = n_resumed;
      std::vector<std::string> problems;
      orders.set = CheckpointSlots(folder.path()).newest(problems);
      for (const auto& problem : problems) log.warn("{}", problem);
    }
  }
}

void tell_how_to_go_on(const Summary& summary, const RunFolder& folder) {
  if (summary.checkpoint_window < 0) return;
  fmt::print(stderr, "coupler: to go on after window {}: coupler run --resume {}\n", summary.checkpoint_window,
             folder.path());
}

/// The run of `input` in `folder` with its log and its summary.
int run_in(const CaseInput& input, const RunFolder& folder, const Orders& orders) {
  RunLog log(folder.file("run.log"));
  log.logger().info("coupler {} ({}), case {} {:016x}, scheme {}", proto::project_version(),
                    proto::source_description(), input.file.path(), input.file.hash(),
                    proto::name_of(input.coupling.scheme));
  auto summary = blank_summary(input);
  StatusFile status(folder.file("status.json"));
  status.now().case_name = summary.case_name, status.now().scheme = summary.scheme;
  const auto write_summary = [&] {
    auto& end = status.now();
    end.status = summary.status, end.exit_code = summary.status == "ok" ? 0 : summary.failure.exit_code;
    end.note = summary.status == "ok" ? "" : summary.failure.message;
    end.wall = summary.wall;
    status.write();
    proto::write_text_file(folder.file("summary.json"), summary_text(summary));
  };
  try {
    const int code = run_with_restarts(input, folder, log.logger(), summary, status, orders);
    write_summary();
    log.logger().info("{}: {} windows", summary.status, summary.n_windows);
    if (code != 0) {
      log.logger().warn("{}", summary.failure.message);
      fmt::print(stderr, "coupler: {}\n", summary.failure.message);
      tell_how_to_go_on(summary, folder);
    }
    if (summary.n_windows > 0)
      fmt::print("{}", run_table(summary, folder.path()));
    else
      fmt::print("no window was run; logs in {}\n", folder.path());
    return code;
  } catch (const proto::Error& error) {
    log.logger().error("{}", error.what());
    try {
      write_summary();
    } catch (const proto::Error& second) {  // a full disk, say; what ended the run stays the run's message
      log.logger().error("{}", second.what());
    }
    tell_how_to_go_on(summary, folder);
    throw;
  }
}

/// What the command line says in place of the case.
void apply(const RunOptions& options, proto::Coupling& coupling) {
  use_programs(coupling, options.fem, options.qdem);
  if (!options.scheme.empty()) coupling.scheme = proto::scheme_of(options.scheme);
  if (const auto why = proto::why_no_switch(coupling); !why.empty())
    throw proto::Error(proto::ExitCode::config, why, "--scheme", "give another coupling.audit.switch_to or action");
  if (options.sub_cycle_factor > 0) coupling.sub_cycle_factor = options.sub_cycle_factor;
  if (options.window_s > 0.0) {
    const double duration = static_cast<double>(coupling.n_windows) * coupling.window_s;
    coupling.window_s = options.window_s;
    coupling.n_windows = static_cast<std::uint64_t>(std::llround(duration / options.window_s));
  }
}

Orders orders_of(const RunOptions& options) {
  Orders orders;
  orders.n_threads = options.n_threads;
  orders.n_restarts = options.n_restarts;
  orders.record = options.record;
  orders.allowed = options.allowed;
  if (options.wall_limit_s > 0.0)
    orders.deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.wall_limit_s));
  return orders;
}

}  // namespace

int run_case(const RunOptions& options) {
  auto orders = orders_of(options);
  auto input = read_case(options.case_path);
  apply(options, input.coupling);
  find_participants(input);  // before a folder is made for a run that cannot start
  const RunFolder folder(options.out, input.file.name());
  proto::write_text_file(folder.file("case.toml"), input.file.text());
  return run_in(input, folder, orders);
}

int resume_run(const RunOptions& options) {
  auto orders = orders_of(options);
  const auto folder = RunFolder::reopen(options.resume);
  auto [input, set] = find_resumption(folder, options.case_path, options.allowed);
  apply(options, input.coupling);
  find_participants(input);
  proto::write_text_file(folder.file("case.toml"), input.file.text());
  orders.set = std::move(set);
  return run_in(input, folder, orders);
}

}  // namespace coupler
