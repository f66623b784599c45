#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <string.h>

#include <cmath>
#include <cstdio>

#include "coupler/app/coupled_run.hpp"
#include "coupler/app/options.hpp"
#include "coupler/report/run_table.hpp"
#include "proto/result/provenance.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

constexpr int interrupted_base = 128;  // as shells report it: 128 + signal

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

/// The whole run; fills the summary. Returns the exit code, throws what ended it early.
int carry_out(CoupledRun& run, Summary& summary, int n_threads) {
  run.start(n_threads);
  run.set_up();
  run.initialise();
  const bool complete = run.march();
  if (!complete) summary.failure = stopped_by_user(run.stop_signal(), run.stage());
  run.finish();
  summary.status = complete ? "ok" : "interrupted";
  return complete ? 0 : summary.failure.exit_code;
}

int run_guarded(const CaseInput& input, const RunFolder& folder, spdlog::logger& log, Summary& summary, int n_threads) {
  CoupledRun run(input, folder, log, summary);
  const auto give_up = [&](const Failure& failure) {
    summary.failure = failure;
    run.abandon(failure.exit_code, failure.message);
  };
  try {
    return carry_out(run, summary, n_threads);
  } catch (const Interrupted& stop) {
    give_up(stopped_by_user(stop.signal(), run.stage()));
    summary.status = "interrupted";
    return summary.failure.exit_code;
  } catch (const ParticipantError& error) {
    give_up({error.what(), error.participant(), static_cast<int>(error.code())});
    throw;
  } catch (const proto::Error& error) {
    give_up({error.what(), "coupler", static_cast<int>(error.code())});
    throw;
  }
}

}  // namespace

int run_case(const RunOptions& options) {
  auto input = read_case(options.case_path);
  if (!options.scheme.empty()) input.coupling.scheme = proto::scheme_of(options.scheme);
  if (options.window_s > 0.0) {
    const double duration = static_cast<double>(input.coupling.n_windows) * input.coupling.window_s;
    input.coupling.window_s = options.window_s;
    input.coupling.n_windows = static_cast<std::uint64_t>(std::llround(duration / options.window_s));
  }
  find_participants(input);  // before a folder is made for a run that cannot start
  const RunFolder folder(options.out, input.file.name());
  proto::write_text_file(folder.file("case.toml"), input.file.text());
  RunLog log(folder.file("run.log"));
  log.logger().info("coupler {} ({}), case {} {:016x}, scheme {}", proto::project_version(),
                    proto::source_description(), input.file.path(), input.file.hash(),
                    proto::name_of(input.coupling.scheme));
  auto summary = blank_summary(input);
  const auto write_summary = [&] { proto::write_text_file(folder.file("summary.json"), summary_text(summary)); };
  try {
    const int code = run_guarded(input, folder, log.logger(), summary, options.n_threads);
    write_summary();
    log.logger().info("{}: {} windows", summary.status, summary.n_windows);
    if (code != 0) {
      log.logger().warn("{}", summary.failure.message);
      fmt::print(stderr, "coupler: {}\n", summary.failure.message);
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
    throw;
  }
}

}  // namespace coupler
