// The participant as the session sees it, on a bed of a few cubes.
#include "qdem_solver/participant/qdem_participant.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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
  driver.participant_.finish();
  const proto::ResultReader reader(folder() + "/qdem.h5");
  EXPECT_EQ(reader.n_steps(), 4u);  // t = 0, 2e-4, 4e-4, 6e-4
  EXPECT_EQ(reader.n_committed("/TimeSeries"), 4u);
  const auto displacement = reader.read("/VTKHDF/PointData/displacement");
  double largest = 0;
  for (const double value : displacement.values) largest = std::max(largest, std::abs(value));
  EXPECT_GT(largest, 1e-9);
  EXPECT_TRUE(std::filesystem::exists(folder() + "/qdem.xdmf"));
}

TEST(QdemAlone, CarriesTheLoadItIsGiven) {
  const auto file = proto::CaseFile::load(tests::small_bed_case(folder(), R"(threads = 1
[qdem.run]
duration_s = 0.06
[qdem.run.load]
kind = "table"
time_s = [0.0, 0.02]
force_n = [0.0, 1500.0]
)"));
  const auto figures = qdem::run_alone(file, tests::small_bed, folder(), {});
  EXPECT_TRUE(near_rel(figures.pad_force, -1500, 0.02));
  EXPECT_LT(figures.sleeper_displacement, -1e-6);
}
