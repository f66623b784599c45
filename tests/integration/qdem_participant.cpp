// The participant as the session sees it, on a bed of a few cubes.
#include "qdem_solver/participant/qdem_participant.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "coupler/mapping/interface_check.hpp"
#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "qdem_solver/participant/run_alone.hpp"
#include "tests/support/small_bed.hpp"
#include "tests/support/tolerance.hpp"

namespace field = proto::field;
using tests::near_abs;
using tests::near_rel;

namespace {

constexpr double window = 1e-4;
constexpr double preload = 2000.0;  ///< on the seat while relaxing [N]

std::string folder() {
  return testing::TempDir();
}

/// A participant driven as the coupler would: relax under a pressed seat, start, then windows of a moving rail.
class Driver {
 public:
  explicit Driver(const std::string& qdem_keys = "threads = 1\n", const std::string& coupling_keys = "")
      : file_(proto::CaseFile::load(tests::small_bed_case(folder(), qdem_keys, coupling_keys))),
        participant_(file_, tests::small_bed, "qdem", folder()) {
    interface_ = participant_.describe();
    proto::Configure request;
    request.window_s = window, request.windows = 100, request.output_directory = folder();
    configured_ = participant_.configure(request);
    const auto cycles = [](double step) { return static_cast<std::uint32_t>(std::ceil(window / step)); };
    sub_cycles_ = cycles(*configured_.largest_step_s);
    relaxing_sub_cycles_ = cycles(*configured_.largest_initialise_step_s);
    rail_.assign(12, 0.0);
    for (std::size_t i = 2; i < 12; i += 3) rail_[i] = -preload / 2e7;
  }

  proto::FieldSet advance(proto::Phase phase, std::int64_t n, const std::vector<double>& next) {
    const auto sub_cycles = phase == proto::Phase::initialise ? relaxing_sub_cycles_ : sub_cycles_;
    proto::Advance request{phase, n, 0, window, sub_cycles, {}};
    request.data.set(field::rail_displacement_begin, rail_);
    request.data.set(field::rail_displacement, next);
    return participant_.advance(request, progress_);
  }
  void relax(int n) {
    for (int i = 0; i < n; ++i) {
      last_ = advance(proto::Phase::initialise, i, rail_);
      participant_.commit({i});
    }
  }
  proto::FieldSet march(std::int64_t n) {
    auto next = rail_;
    for (std::size_t i = 2; i < 12; i += 3) next[i] -= 1e-6 * std::sin(0.3 * static_cast<double>(n));
    last_ = advance(proto::Phase::march, n, next);
    pending_ = next;
    return last_;
  }
  void commit(std::int64_t n) {
    participant_.commit({n});
    rail_ = pending_;
  }
  double seat_force() const {
    double sum = 0;
    for (std::size_t i = 2; i < 12; i += 3) sum += last_.get(field::impulse)[i] / window;
    return sum;
  }

  proto::CaseFile file_;
  qdem::QdemParticipant participant_;
  proto::Progress progress_;
  proto::Interface interface_;
  proto::Configured configured_;
  std::uint32_t sub_cycles_ = 0, relaxing_sub_cycles_ = 1;
  std::vector<double> rail_, pending_;
  proto::FieldSet last_;
};

}  // namespace

TEST(QdemParticipant, RegistersAnInterfaceTheCouplerAccepts) {
  Driver driver;
  EXPECT_EQ(driver.participant_.build_id().find("qdem_solver "), 0u);
  const auto seats = proto::read_rail_seats(driver.file_);
  EXPECT_NO_THROW(coupler::check_interface("qdem", driver.interface_, seats));
  auto wrong = driver.interface_;
  wrong.seats[0].rigid_response[7] += 1e-10;
  EXPECT_THROW(coupler::check_interface("qdem", wrong, seats), proto::Error);
  const auto& law = driver.interface_.seats[0];
  EXPECT_TRUE(near_rel(law.stiffness[2], 2e7 / 4, 1e-14));
  EXPECT_TRUE(near_rel(law.damping[1], 2e3 / 4, 1e-14));
}

TEST(QdemParticipant, RelaxesToTheForceOfTheSpring) {
  Driver driver;
  driver.relax(1);
  EXPECT_GT(driver.participant_.residual().value(), 0.1);
  driver.relax(1500);
  EXPECT_LT(driver.participant_.residual().value(), 5e-3);
  // At rest the sleeper carries rail force and weight on its contacts; the pad's force is the law at x.
  const auto& x = driver.last_.get(field::sleeper_displacement);
  double expected = 0;
  for (std::size_t i = 2; i < 12; i += 3) expected += 2e7 / 4 * (driver.rail_[i] - x[i]);
  EXPECT_TRUE(near_rel(driver.seat_force(), expected, 1e-3));
  EXPECT_LT(driver.seat_force(), -0.1 * preload);
  const double before = driver.seat_force();
  driver.participant_.start();
  driver.pending_ = driver.rail_;
  for (int n = 0; n < 50; ++n) {  // a standing rail: nothing drifts when the artificial damping is gone
    driver.last_ = driver.advance(proto::Phase::march, n, driver.rail_);
    driver.participant_.commit({n});
  }
  EXPECT_TRUE(near_rel(driver.seat_force(), before, 1e-3));
}

namespace {

void expect_rollback_repeats(const std::string& qdem_keys) {
  Driver driver(qdem_keys);
  driver.relax(20);
  driver.participant_.start();
  for (int n = 0; n < 3; ++n) driver.march(n), driver.commit(n);
  const auto first = driver.march(3);
  const auto first_step = driver.participant_.largest_step();
  driver.participant_.rollback({3});
  const auto second = driver.march(3);
  EXPECT_EQ(first_step, driver.participant_.largest_step());
  for (const auto& values : first.all()) EXPECT_EQ(values.values, second.get(values.name)) << values.name;
}

}  // namespace

TEST(QdemParticipant, RollbackRepeatsTheWindowBitwise) {
  expect_rollback_repeats("threads = 1\n");
}

TEST(QdemParticipant, RollbackRepeatsTheWindowBitwiseOnADevice) {
  expect_rollback_repeats("threads = 1\nengine = \"check\"\n");
}

TEST(QdemParticipant, RestoreRepeatsTheWindowBitwiseOnADevice) {
  Driver driver("threads = 1\nengine = \"check\"\n");
  driver.relax(20);
  driver.participant_.start();
  for (int n = 0; n < 3; ++n) driver.march(n), driver.commit(n);
  const std::string path = folder() + "/saved.h5";
  const auto hash = driver.participant_.save({3, path});
  const auto first = driver.march(3);
  driver.participant_.restore({3, path, hash});
  const auto second = driver.march(3);
  for (const auto& values : first.all()) EXPECT_EQ(values.values, second.get(values.name)) << values.name;
}

TEST(QdemParticipant, TheDeviceEngineMarchesAsTheCpuEngine) {
  Driver cpu("threads = 1\n"), device("threads = 1\nengine = \"check\"\n");
  for (Driver* driver : {&cpu, &device}) {
    driver->relax(20);
    driver->participant_.start();
    for (int n = 0; n < 10; ++n) driver->march(n), driver->commit(n);
  }
  for (const char* name : {field::impulse, field::pad_work, field::sleeper_displacement, field::sleeper_velocity}) {
    const auto &wanted = cpu.last_.get(name), &reached = device.last_.get(name);
    double largest = 0.0;
    for (const double value : wanted) largest = std::max(largest, std::abs(value));
    ASSERT_EQ(reached.size(), wanted.size());
    // Cundall's damping is a sign: while relaxing, round-off decides it for whatever hardly moves.
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_TRUE(near_abs(reached[i], wanted[i], 1e-4 * largest)) << name << " " << i;
    }
  }
}

TEST(QdemParticipant, ADeviceKeepsNoEnergyLedger) {
  const auto facts_of = [](const std::string& engine) {
    Driver driver("threads = 1\nengine = \"" + engine + "\"\n", "output_interval_s = 1e-4\n");
    driver.relax(2);
    driver.participant_.start();
    for (int n = 0; n < 2; ++n) driver.march(n), driver.commit(n);
    const auto facts = driver.participant_.finish();
    return std::count_if(facts.begin(), facts.end(),
                         [](const auto& fact) { return fact.key.find("qdem.energy.") == 0; });
  };
  const auto written = [](const std::string& name) {
    return proto::ResultReader(folder() + "/qdem.h5").read("/TimeSeries/" + name).values.size();
  };
  EXPECT_EQ(facts_of("check"), 0);
  EXPECT_EQ(written("kinetic_energy"), 3u);
  EXPECT_THROW(written("work_of_loads"), proto::Error);
  EXPECT_EQ(facts_of("cpu"), 8);
  EXPECT_EQ(written("work_of_loads"), 3u);
}

TEST(QdemParticipant, ACheckpointHoldsTheEnergyLedger) {
  const auto march_to_the_end = [](Driver& driver) {
    for (int n = 3; n < 6; ++n) driver.march(n), driver.commit(n);
    return driver.participant_.finish();
  };
  Driver whole;
  whole.relax(20);
  whole.participant_.start();
  for (int n = 0; n < 3; ++n) whole.march(n), whole.commit(n);
  const std::string path = folder() + "/qdem_state.h5";
  const auto hash = whole.participant_.save({2, path});
  Driver resumed;
  resumed.participant_.restore({2, path, hash});
  resumed.rail_ = whole.rail_;
  const auto facts = march_to_the_end(whole), again = march_to_the_end(resumed);
  ASSERT_EQ(facts.size(), again.size());
  for (std::size_t i = 0; i < facts.size(); ++i) {
    EXPECT_EQ(facts[i].number, again[i].number) << facts[i].key;
    EXPECT_EQ(facts[i].text, again[i].text) << facts[i].key;
  }
}

TEST(QdemParticipant, NamesTheStepOfTheNextWindow) {
  Driver driver;
  driver.relax(20);
  driver.participant_.start();
  const double touching = driver.participant_.largest_step().value();
  for (std::size_t i = 2; i < 12; i += 3) driver.rail_[i] += 2e-3;  // lifts the sleeper off its stones
  double apart = touching;
  for (int n = 0; n < 100; ++n) {
    driver.sub_cycles_ = static_cast<std::uint32_t>(std::ceil(window / apart));
    driver.march(n);
    driver.participant_.commit({n});
    apart = driver.participant_.largest_step().value();
  }
  EXPECT_GT(apart, 1.05 * touching);
}

TEST(QdemParticipant, RefusesAStepAboveTheBound) {
  Driver driver;
  driver.relax(1);
  driver.participant_.start();
  driver.sub_cycles_ = 1;
  try {
    driver.march(0);
    FAIL() << "an unstable step was taken";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
  }
  try {
    Driver bold("largest_step_s = 1e-3\n");
    FAIL() << "a largest_step_s above the bound was accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::config);
    EXPECT_NE(std::string(error.what()).find("qdem.largest_step_s"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("stability bound"), std::string::npos) << error.what();
  }
}

TEST(QdemParticipant, WritesFieldsAtTheInterval) {
  Driver driver("threads = 1\n", "output_interval_s = 2e-4\n");
  driver.relax(20);
  driver.participant_.start();
  for (int n = 0; n < 6; ++n) driver.march(n), driver.commit(n);
  const auto facts = driver.participant_.finish();
  const auto residual = std::find_if(facts.begin(), facts.end(), [](const proto::Fact& fact) {
    return fact.key == "qdem.energy.largest_residual_relative";
  });
  ASSERT_NE(residual, facts.end());
  EXPECT_GT(residual->number.value(), 0.0);
  EXPECT_LT(residual->number.value(), 0.01);
  const proto::ResultReader reader(folder() + "/qdem.h5");
  EXPECT_EQ(reader.n_steps(), 4u);  // t = 0, 2e-4, 4e-4, 6e-4
  EXPECT_EQ(reader.n_committed("/TimeSeries"), 4u);
  const auto displacement = reader.read("/VTKHDF/PointData/displacement");
  double largest = 0;
  for (const double value : displacement.values) largest = std::max(largest, std::abs(value));
  EXPECT_GT(largest, 1e-9);
  EXPECT_TRUE(std::filesystem::exists(folder() + "/qdem.xdmf"));
}

namespace {

qdem::RunFigures run_alone(const std::string& keys, std::vector<std::string>* warnings = nullptr) {
  const auto file = proto::CaseFile::load(tests::small_bed_case(folder(), "threads = 1\n" + keys));
  const auto warn = [&](const std::string& line) {
    if (warnings != nullptr) warnings->push_back(line);
  };
  const auto figures = qdem::run_alone(file, tests::small_bed, folder(), {}, warn);
  std::printf("residual %.2e, at most %.2e, of %.3g J; work %.4g, viscous %.3g, dashpots %.3g, friction %.3g J\n",
              figures.energy.relative(), figures.largest_residual, figures.energy.scale, figures.energy.work,
              figures.energy.viscous, figures.energy.contact_dashpots, figures.energy.friction);
  return figures;
}

}  // namespace

TEST(QdemAlone, CarriesTheLoadItIsGiven) {
  const auto figures = run_alone(R"([qdem.run]
duration_s = 0.06
[[qdem.run.load]]
kind = "table"
time_s = [0.0, 0.02]
force_n = [0.0, 1000.0]
[[qdem.run.load]]
kind = "table"
time_s = [0.0, 0.02]
force_n = [0.0, 500.0]
)");
  EXPECT_TRUE(near_rel(figures.pad_force, -1500, 0.02));
  EXPECT_LT(figures.sleeper_displacement, -1e-6);
  EXPECT_LT(figures.largest_residual, 0.01);
}

TEST(QdemAlone, TheRailFootGoesWhereItIsSent) {
  const auto figures = run_alone(R"([qdem.run]
duration_s = 0.06
[[qdem.run.load]]
kind = "displacement_table"
time_s = [0.0, 0.02]
displacement_m = [0.0, 3e-4]
)");
  // The pad is between foot and sleeper.
  EXPECT_TRUE(near_rel(figures.pad_force, 2e7 * (-3e-4 - figures.sleeper_displacement), 0.02));
  EXPECT_LT(figures.pad_force, -100.0);
  EXPECT_LT(figures.largest_residual, 0.01);
}

TEST(QdemAlone, AWeightFallsOnThePads) {
  std::vector<std::string> warnings;
  const auto figures = run_alone(R"([qdem.run]
duration_s = 0.02
output_interval_s = 1e-3
[[qdem.run.load]]
kind = "drop_weight"
mass_kg = 10.0
drop_height_m = 0.002
stiffness_n_per_m = 1e6
)",
                                 &warnings);
  EXPECT_EQ(figures.pad_force, 0.0);
  EXPECT_GT(figures.energy.work, 0.0);
  EXPECT_LT(figures.largest_residual, 0.01);
  EXPECT_TRUE(warnings.empty());
  const proto::ResultReader reader(folder() + "/qdem.h5");
  const auto work = reader.read("/TimeSeries/work_of_loads").values;
  const auto residual = reader.read("/TimeSeries/energy_residual_relative").values;
  ASSERT_EQ(work.size(), 21u);
  EXPECT_EQ(work.front(), 0.0);
  EXPECT_TRUE(near_rel(work.back(), figures.energy.work, 1e-12));
  EXPECT_TRUE(near_rel(residual.back(), figures.energy.relative(), 1e-12));
}

TEST(QdemAlone, RefusesALoadOnABodyThatIsNotThere) {
  try {
    run_alone(R"([qdem.run]
duration_s = 0.02
[[qdem.run.load]]
on = "patch"
body = "stone_4"
centre_m = [0, 0, 0]
radius_m = 1.0
kind = "half_sine"
peak_n = 1.0
duration_s = 1.0
)");
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
    EXPECT_NE(std::string(error.what()).find("did you mean 'stone 4'"), std::string::npos) << error.what();
  }
}

TEST(QdemAlone, StopsWhenEnergyComesFromNowhere) {
  // A weight that drives the sleeper right through the stones: where surfaces have passed each other the contact forces
  // are not those of any energy.
  std::vector<std::string> warnings;
  try {
    run_alone(R"([qdem.run]
duration_s = 0.05
output_interval_s = 1e-4
[[qdem.run.load]]
kind = "drop_weight"
mass_kg = 1e4
impact_velocity_m_per_s = 3.0
stiffness_n_per_m = 1e7
)",
              &warnings);
    FAIL() << "it ran to its end";
  } catch (const proto::Error& error) {
    std::printf("%s\n", error.what());
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    const std::string text = error.what();
    EXPECT_NE(text.find("energy ledger does not close"), std::string::npos);
    EXPECT_NE(text.find("step "), std::string::npos);
    EXPECT_NE(text.find("t = "), std::string::npos);
  }
  EXPECT_LE(warnings.size(), 1u);
}
