// The real solvers under the real coupler: whoever is killed, and whenever, the others end at once, the culprit is
// named, and what was committed can be read. The bed of the case is built by the first test and kept in the build
// folder.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/solver_case.hpp"

namespace {

using tests::contains;
using tests::CoupledRun;

constexpr double gone_within_s = 5.0;
constexpr double set_up_patience_s = 120.0;  // a bed is built on a machine that may be busy

/// When the victim is killed: what the log says then, what the message calls it.
struct Moment {
  const char* name;
  const char* logged;
  const char* stage;
  tests::CaseChanges changes;
  friend void PrintTo(const Moment& moment, std::ostream* out) { *out << moment.name; }
};

const Moment moments[] = {
    {"set_up", "qdem connected", " in set-up", {}},
    {"initialise", "configured:", " in initialise window ", {{"min_windows", "100000000"}}},
    {"march", "marching", " in window ", {}},
};

/// Sockets lie in a folder of the test's own; the bed of the set-up's moment is never there yet.
class SolverRun {
 public:
  explicit SolverRun(const Moment& moment) : coupled_(tests::solver_case(moment.changes)) {
    const bool fresh_bed = std::string(moment.name) == "set_up";
    setenv("QDEM_BED_CACHE", fresh_bed ? new_beds().c_str() : HOUSE_BIN_DIR "/../test_beds", 1);
    setenv("XDG_RUNTIME_DIR", sockets_.path().c_str(), 1);
    coupled_.start();
    EXPECT_TRUE(coupled_.await_log(moment.logged, set_up_patience_s)) << coupled_.message();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
  }

  CoupledRun& coupled() { return coupled_; }
  std::string new_beds() const { return beds_.file("beds"); }
  std::ptrdiff_t n_socket_folders() const {
    const std::filesystem::directory_iterator entries(sockets_.path());
    return std::distance(begin(entries), end(entries));
  }

 private:
  tests::TemporaryFolder sockets_, beds_;
  CoupledRun coupled_;
};

/// Everything the run wrote holds what it says it holds. A file that is not there yet holds nothing.
void expect_readable_results(const CoupledRun& run) {
  const auto path = [&](const char* name) { return run.out() + "/" + name; };
  if (std::filesystem::exists(path("coupling.h5"))) {
    const proto::ResultReader record(path("coupling.h5"));
    const auto windows = record.read_rows("window", record.n_committed()).values;
    for (std::size_t i = 0; i < windows.size(); ++i) ASSERT_EQ(windows[i], static_cast<double>(i) - 1.0);
  }
  for (const char* name : {"qdem.h5", "fem.h5"}) {
    if (!std::filesystem::exists(path(name))) continue;
    const proto::ResultReader fields(path(name));
    const auto times = fields.read_rows("/VTKHDF/Steps/Values", fields.n_steps()).values;
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], 1e-3 * static_cast<double>(i), 1e-9) << name;
    EXPECT_NO_THROW(fields.read_rows("/TimeSeries/time", fields.n_committed("/TimeSeries"))) << name;
  }
}

void expect_march_was_recorded(const CoupledRun& run) {
  EXPECT_GT(proto::ResultReader(run.out() + "/coupling.h5").n_committed(), 1u);
  for (const char* name : {"qdem.h5", "fem.h5"}) EXPECT_GT(proto::ResultReader(run.out() + "/" + name).n_steps(), 0u);
}

class SolverKill : public ::testing::TestWithParam<std::tuple<std::string, Moment>> {};

TEST_P(SolverKill, EndsTheOthersAndLeavesNothing) {
  const auto& [victim, moment] = GetParam();
  SolverRun run(moment);
  auto& coupled = run.coupled();
  const int qdem = coupled.participant("qdem"), fem = coupled.participant("fem");
  ASSERT_FALSE(tests::is_gone(qdem) || tests::is_gone(fem)) << coupled.message();
  EXPECT_EQ(coupled.n_processes(), 3);
  const bool coupler_dies = victim == "coupler";
  const auto killed = std::chrono::steady_clock::now();
  kill(coupler_dies ? coupled.pid() : coupled.participant(victim), SIGKILL);

  const auto code = coupled.wait(gone_within_s).value_or(-1);
  EXPECT_TRUE(tests::becomes_true([&] { return tests::is_gone(qdem) && tests::is_gone(fem); }, gone_within_s));
  std::printf("all gone after %.2f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - killed).count());
  EXPECT_EQ(coupled.n_processes(), 0);
  if (coupler_dies) {
    EXPECT_EQ(code, 128 + SIGKILL);
    EXPECT_FALSE(std::filesystem::exists(coupled.out() + "/summary.json"));
    EXPECT_EQ(run.n_socket_folders(), 1);
    CoupledRun next(tests::OscillatorCase{}.text());
    EXPECT_EQ(next.run().value_or(-1), 0) << next.message();
  } else {
    EXPECT_EQ(code, static_cast<int>(proto::ExitCode::unavailable)) << coupled.message();
    EXPECT_TRUE(contains(coupled.message(), "coupler: " + victim + " (")) << coupled.message();
    EXPECT_TRUE(contains(coupled.message(), std::string("was killed by signal 9 (Killed)") + moment.stage))
        << coupled.message();
    EXPECT_EQ(coupled.summary()["status"], "failed");
    EXPECT_EQ(coupled.summary()["failure"]["culprit"], victim);
  }
  EXPECT_EQ(run.n_socket_folders(), 0);
  expect_readable_results(coupled);
  if (std::string(moment.name) == "march") expect_march_was_recorded(coupled);
  EXPECT_FALSE(std::filesystem::exists(run.new_beds()) && !std::filesystem::is_empty(run.new_beds()))
      << "a part of a bed is in the cache";
}

INSTANTIATE_TEST_SUITE_P(OfEach, SolverKill,
                         ::testing::Combine(::testing::Values("coupler", "qdem", "fem"), ::testing::ValuesIn(moments)),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "_in_" + std::get<1>(test.param).name;
                         });

class SolverInterrupt : public ::testing::TestWithParam<Moment> {};

TEST_P(SolverInterrupt, EndsCleanly) {
  const auto& moment = GetParam();
  SolverRun run(moment);
  auto& coupled = run.coupled();
  kill(coupled.pid(), SIGINT);
  EXPECT_EQ(coupled.wait(gone_within_s).value_or(-1), 128 + SIGINT) << coupled.message();
  EXPECT_EQ(coupled.n_processes(), 0);
  EXPECT_EQ(run.n_socket_folders(), 0);
  EXPECT_TRUE(contains(coupled.message(), "stopped by signal 2 (Interrupt) - ")) << coupled.message();
  const auto summary = coupled.summary();
  EXPECT_EQ(summary["status"], "interrupted");
  EXPECT_EQ(summary["failure"]["culprit"], "user");
  expect_readable_results(coupled);
  if (std::string(moment.name) != "march") return;
  expect_march_was_recorded(coupled);
  EXPECT_EQ(proto::ResultReader(coupled.out() + "/coupling.h5").n_committed(),
            summary["windows"].get<std::uint64_t>() + 1);
  for (const char* name : {"qdem.xdmf", "fem.xdmf"})  // the participants took part in the end
    EXPECT_TRUE(std::filesystem::exists(coupled.out() + "/" + name)) << name;
}

INSTANTIATE_TEST_SUITE_P(At, SolverInterrupt, ::testing::ValuesIn(moments),
                         [](const auto& test) { return test.param.name; });

}  // namespace
