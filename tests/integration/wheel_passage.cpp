// The whole chain on the shipped case wheel_passage_quick: bed, three processes, passage, record.
#include <gtest/gtest.h>

#include "proto/result/reader.hpp"
#include "tests/support/case_changes.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

using tests::CoupledRun;

constexpr double energy_limit = 1e-3, momentum_limit = 1e-4;  // coupler/README.md "Audit"
constexpr double force_scale = 650.0;                         // 2 % of a seat's peak, force_floor_n of the case [N]
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
  EXPECT_GT(summary["rail_seats"][0]["max_force_n"].get<double>(), force_scale);
  EXPECT_LT(summary["rail_seats"][0]["max_force_n"].get<double>(), 65e3);
  EXPECT_GT(summary["bed"]["stones"].get<int>(), 100);
  const double porosity = summary["bed"]["porosity"].get<double>();
  EXPECT_TRUE(porosity > 0.36 && porosity < 0.50) << porosity;
  for (const char* file : {"coupling.h5", "qdem.h5", "qdem.xdmf", "fem.h5", "fem.xdmf", "run.log", "case.toml"}) {
    EXPECT_TRUE(std::filesystem::exists(coupled.out() + "/" + file)) << file;
  }
  EXPECT_EQ(proto::ResultReader(coupled.out() + "/coupling.h5").n_committed(), 1601u);
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
