// `coupler profile`: computing against waiting of a run that was made before.
#include <fmt/format.h>

#include <memory>

#include "coupler/app/kit.hpp"
#include "coupler/report/profile.hpp"
#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

std::vector<WindowTimes> read_times(const proto::ResultReader& record, const std::string& path) {
  if (!record.has("window_begin"))
    throw proto::Error(proto::ExitCode::bad_data, "the record has no times of its windows", path,
                       "it was written by an older version; run the case again");
  const auto n = record.n_committed();
  const auto column = [&](const char* name) { return record.read_rows(name, n).values; };
  const auto begin = column("window_begin"), end = column("window_end");
  const auto qdem = column("qdem_compute"), fem = column("fem_compute");
  std::vector<WindowTimes> windows;
  for (std::size_t i = 1; i < n; ++i) windows.push_back({begin[i], end[i], qdem[i], fem[i]});  // row 0: initial values
  return windows;
}

int profile_run(const std::string& folder, const std::string& trace) {
  const auto path = folder + "/coupling.h5";
  const proto::ResultReader record(path);
  const auto windows = read_times(record, path);
  fmt::print("{}", profile_table(profile_of(windows, record.text("/", "scheme") == "E0")));
  const auto trace_path = trace.empty() ? folder + "/trace.json" : trace;
  proto::write_text_file(trace_path, trace_json(windows));
  fmt::print("\ntrace for ui.perfetto.dev or chrome://tracing: {}\n", trace_path);
  return 0;
}

}  // namespace

void add_profile_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("profile", "show where a run's time went");
  const auto folder = std::make_shared<std::string>(), trace = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "folder of the run")->required();
  command->add_option("--trace", *trace, "file for the trace (default: DIR/trace.json)");
  command->callback([folder, trace, &chosen] { chosen = [folder, trace] { return profile_run(*folder, *trace); }; });
}

}  // namespace coupler
