// The coupler with the real solvers on the small bed of the fault tests: `converge --over cells` writes cases of its own
// into its output folder, and what these name by relative paths is found; an implicit scheme balances the interface.
#include <filesystem>

#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/solver_case.hpp"

namespace {

using tests::CoupledRun;

/// Three windows; the rail's heights stand in a file beside the case.
std::string case_with_a_table() {
  return tests::solver_case(
      {{"duration_s", "3e-4"},
       {"output_interval_s", "0.0"},
       {"radius_m", "0.43\n[wheel.irregularity]\nkind = \"table\"\nfile = \"heights/rail.csv\""}});
}

TEST(ConvergeOverCells, FindsTheFilesOfTheOriginalCase) {
  setenv("QDEM_BED_CACHE", HOUSE_BIN_DIR "/../test_beds", 1);
  CoupledRun run(case_with_a_table());
  const auto folder = std::filesystem::path(run.case_path()).parent_path() / "heights";
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "rail.csv") << "-5.0, 0.0\n0.0, 0.0\n5.0, 0.0\n";
  run.start({"converge", run.case_path(), "--over", "cells", "--levels", "3", "--out", run.out()});
  // Three windows of a blow show no order; that all levels ran is what counts here.
  const int code = run.wait(250.0).value_or(-1);
  EXPECT_TRUE(code == 0 || code == static_cast<int>(proto::ExitCode::numerics)) << run.message();
  for (int level = 0; level < 3; ++level) {
    const auto summary =
        nlohmann::json::parse(tests::read_text(run.out() + "/level_" + std::to_string(level) + "/summary.json"));
    EXPECT_EQ(summary["status"], "ok") << level;
    const auto refined = tests::read_text(run.out() + "/level_" + std::to_string(level) + ".toml");
    const int cells = 2 << level;
    EXPECT_TRUE(tests::contains(refined, "cells = [" + std::to_string(cells) + ", " + std::to_string(cells) + "]"));
  }
  EXPECT_FALSE(tests::read_text(run.out() + "/convergence.csv").empty());
}

TEST(Implicit, BalancesTheInterfaceOfTheSolversToTenTimesItsTolerance) {
  setenv("QDEM_BED_CACHE", HOUSE_BIN_DIR "/../test_beds", 1);
  constexpr double tolerance = 1e-6;
  CoupledRun run(tests::solver_case({{"duration_s", "0.01"}, {"output_interval_s", "0.0"}, {"speed_m_per_s", "5.0"}}));
  run.start({"run", run.case_path(), "--out", run.out(), "--scheme", "implicit"});
  ASSERT_EQ(run.wait(200.0).value_or(-1), 0) << run.message();
  const auto summary = run.summary();
  const double energy = summary["interface"]["energy_defect_relative"],
               momentum = summary["interface"]["momentum_defect_relative"];
  std::printf("energy defect %.1e, momentum defect %.1e, %.2f passes\n", energy, momentum,
              summary["observed"]["passes_mean"].get<double>());
  EXPECT_GT(summary["observed"]["passes_mean"], 1.0);
  EXPECT_LT(energy, 10 * tolerance);
  EXPECT_LT(momentum, 10 * tolerance);
}

}  // namespace
