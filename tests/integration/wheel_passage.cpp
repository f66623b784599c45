// The whole chain on the shipped case wheel_passage_quick: bed, three processes, passage, record.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "proto/result/reader.hpp"
#include "tests/support/case_changes.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

using tests::CoupledRun;

constexpr double energy_limit = 1e-3, momentum_limit = 1e-4;  // coupler/README.md "Audit"
constexpr double wheel_load = 65e3;                           // [N]
constexpr double standing_drift = 1e-3;                       // of the seat force over 20 ms, the wheel standing
constexpr double patience_s = 900.0;

std::string quick_case(const tests::CaseChanges& changes = {}) {
  return tests::with_changes(tests::read_text(HOUSE_SOURCE_DIR "/cases/wheel_passage_quick/case.toml"), changes);
}

/// The bed is built by the first test and loaded by the others.
class WheelPassage : public ::testing::Test {
 protected:
  void SetUp() override { setenv("QDEM_BED_CACHE", HOUSE_BIN_DIR "/../test_beds", 1); }

  nlohmann::json run(CoupledRun& coupled, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"run", coupled.case_path(), "--out", coupled.out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    coupled.start(arguments);
    EXPECT_EQ(coupled.wait(patience_s), std::optional<int>(0)) << coupled.message();
    return coupled.summary();
  }
};

TEST_F(WheelPassage, RobinSchemeKeepsEnergyAndMomentumAtTheInterface) {
  CoupledRun coupled(quick_case());
  const auto summary = run(coupled);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_EQ(summary["status"], "ok");
  EXPECT_EQ(summary["scheme"], "R1");
  EXPECT_EQ(summary["windows"], 1600);
  EXPECT_LE(summary["interface"]["energy_defect_relative"].get<double>(), energy_limit);
  EXPECT_LE(summary["interface"]["momentum_defect_relative"].get<double>(), momentum_limit);
  EXPECT_GT(summary["interface"]["energy_defect_relative"].get<double>(), 0.0);
  const double share = summary["rail_seats"][0]["max_force_n"].get<double>() / wheel_load;
  EXPECT_TRUE(share > 0.1 && share < 0.6) << "the seat carries " << share << " of the wheel load";
  EXPECT_GT(summary["bed"]["stones"].get<int>(), 100);
  const double porosity = summary["bed"]["porosity"].get<double>();
  EXPECT_TRUE(porosity > 0.36 && porosity < 0.50) << porosity;
  for (const char* file : {"coupling.h5", "qdem.h5", "qdem.xdmf", "fem.h5", "fem.xdmf", "run.log", "case.toml"}) {
    EXPECT_TRUE(std::filesystem::exists(coupled.out() + "/" + file)) << file;
  }
  EXPECT_EQ(proto::ResultReader(coupled.out() + "/coupling.h5").n_committed(), 1601u);
}

/// Normal force of the seat in every window [N].
std::vector<double> seat_force(const std::string& out, double window_s) {
  const proto::ResultReader reader(out + "/coupling.h5");
  const auto impulse = reader.read_rows("seats/seat/impulse", reader.n_committed());  // window, cell, axis
  const std::size_t n_cells = impulse.shape[1];
  std::vector<double> force;
  for (std::size_t row = 1; row < impulse.shape[0]; ++row) {
    double sum = 0.0;
    for (std::size_t cell = 0; cell < n_cells; ++cell) sum += impulse.values[3 * (row * n_cells + cell) + 2];
    force.push_back(sum / window_s);
  }
  return force;
}

TEST_F(WheelPassage, AStandingWheelKeepsTheSeatForce) {
  CoupledRun coupled(quick_case({{"speed_m_per_s", "0.0"}, {"duration_s", "0.02"}}));
  ASSERT_FALSE(run(coupled).is_discarded());
  const auto force = seat_force(coupled.out(), 5e-5);
  ASSERT_EQ(force.size(), 400u);
  const auto [lowest, highest] = std::minmax_element(force.begin(), force.end());
  std::printf("seat force %.2f N, drift %.1e of it in 20 ms without artificial damping\n", force.front(),
              (*highest - *lowest) / std::abs(force.front()));
  EXPECT_LT(*highest - *lowest, standing_drift * std::abs(force.front()));
}

TEST_F(WheelPassage, StaggeredSchemeFailsTheSameCheck) {
  CoupledRun coupled(quick_case({{"scheme", "\"E1\""}}));
  const auto summary = run(coupled);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_TRUE(summary["interface"]["energy_defect_relative"].get<double>() > energy_limit ||
              summary["interface"]["momentum_defect_relative"].get<double>() > momentum_limit)
      << summary["interface"];
}

TEST_F(WheelPassage, OneThreadAndTwoWriteTheSameBytes) {
  CoupledRun coupled(quick_case({{"duration_s", "0.002"}}));  // one case file: its folder's name is in the record
  const auto bytes_with = [&](const std::string& threads) {
    const std::string out = coupled.out() + "_" + threads;
    coupled.start({"run", coupled.case_path(), "--out", out, "--threads", threads});
    EXPECT_EQ(coupled.wait(patience_s), std::optional<int>(0)) << coupled.message();
    return tests::read_text(out + "/qdem.h5");
  };
  const auto one = bytes_with("1"), two = bytes_with("2");
  EXPECT_GT(one.size(), 100000u);
  EXPECT_TRUE(one == two);
}

}  // namespace
