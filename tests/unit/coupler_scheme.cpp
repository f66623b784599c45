// R1 and E1 on the split oscillator with model participants: order, momentum identity, audit.
#include "coupler/scheme/window_scheme.hpp"

#include "coupler/scheme/audit.hpp"
#include "coupler/scheme/rest_watch.hpp"
#include "proto/error.hpp"
#include "tests/support/oscillator_sides.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using coupler::Audit;
using coupler::WindowScheme;
using proto::Scheme;

constexpr double end_time = 4.0;

struct Run {
  double error = 0.0, energy_defect = 0.0, momentum_defect = 0.0;
  double raw_defect = 0.0, momentum_sum = 0.0;  // R_n and sum of P at the last window
};

/// An explicit side whose stability bound changes from window to window.
class FitfulSleeper : public tests::SleeperModel {
 public:
  using tests::SleeperModel::SleeperModel;
  static constexpr std::uint32_t sub_cycles_of(std::int64_t window) {
    return static_cast<std::uint32_t>(3 + window % 4);
  }
  proto::Result advance(const proto::Advance& request) override {
    EXPECT_EQ(request.sub_cycles, sub_cycles_of(request.window));
    auto result = tests::SleeperModel::advance(request);
    result.largest_step_s = request.window_s / sub_cycles_of(request.window + 1);
    return result;
  }
};

template <class Sleeper = tests::SleeperModel>
Run run(Scheme scheme, int n_windows, std::uint32_t sub_cycles) {
  const tests::Oscillator oscillator;
  const double h = end_time / n_windows;
  tests::RailModel rail(oscillator);
  Sleeper sleeper(oscillator);
  WindowScheme windows(scheme, h, sub_cycles, {oscillator.pad});
  windows.start({{oscillator.u}, {oscillator.v}, {oscillator.x}, {oscillator.y}});
  Audit audit({1}, h);
  // The audit of a seat sums three axes; the oscillator moves along the first of one cell, the others stay at rest.
  const auto padded = [](std::vector<double>& values) { values.resize(3, 0.0); };
  Run result;
  coupler::WindowRecord record;
  for (int n = 0; n < n_windows; ++n) {
    record = windows.advance(proto::Phase::march, n, {rail, sleeper});
    result.momentum_sum += h * record.force_used[0] - record.impulse[0];
    result.raw_defect = h * record.force_robin[0] - record.impulse[0];
    auto audited = record;
    for (auto* values : {&audited.rail_displacement_begin, &audited.rail_displacement, &audited.force_used,
                         &audited.impulse, &audited.pad_work})
      padded(*values);
    audit.add(audited);
  }
  const auto exact = tests::exact_state(oscillator, end_time);
  const Eigen::Vector4d found(record.rail_displacement[0], record.rail_velocity[0], record.sleeper_displacement[0],
                              record.sleeper_velocity[0]);
  result.error = (found - exact).norm();
  result.energy_defect = audit.energy_defect_relative();
  result.momentum_defect = audit.momentum_defect_relative();
  return result;
}

template <class Sleeper = tests::SleeperModel>
double order(Scheme scheme, std::uint32_t sub_cycles) {
  std::vector<double> steps, errors;
  for (int n : {160, 320, 640}) {
    steps.push_back(end_time / n);
    errors.push_back(run<Sleeper>(scheme, n, sub_cycles).error);
  }
  return tests::fitted_order(steps, errors);
}

void expect_order(Scheme scheme, double expected) {
  for (const std::uint32_t sub_cycles : {1, 10}) {
    EXPECT_TRUE(tests::near_abs(order(scheme, sub_cycles), expected, 0.15)) << sub_cycles << " sub-cycles";
  }
}

TEST(WindowScheme, R1IsOfSecondOrder) {
  expect_order(Scheme::robin_explicit, 2.0);
}

TEST(WindowScheme, R2IsOfSecondOrder) {
  expect_order(Scheme::robin_corrected, 2.0);
}

TEST(WindowScheme, E2IsOfSecondOrder) {
  expect_order(Scheme::serial_extrapolated, 2.0);
}

TEST(WindowScheme, R2KeepsTheMomentumToo) {
  const auto r2 = run(Scheme::robin_corrected, 320, 10);
  EXPECT_TRUE(tests::near_abs(r2.momentum_sum, r2.raw_defect, 1e-13));
  EXPECT_LT(r2.energy_defect, run(Scheme::robin_explicit, 320, 10).energy_defect);
}

TEST(WindowScheme, EveryWindowGetsTheSubCyclesOfItsOwnBound) {
  const auto first = FitfulSleeper::sub_cycles_of(0);
  EXPECT_TRUE(tests::near_abs(order<FitfulSleeper>(Scheme::robin_explicit, first), 2.0, 0.15));
}

TEST(WindowScheme, E1IsReportedAsFirstOrder) {
  expect_order(Scheme::serial_staggered, 1.0);
}

TEST(WindowScheme, R1KeepsTheMomentumUpToTheLastWindowsRawDefect) {
  const auto r1 = run(Scheme::robin_explicit, 320, 10);
  EXPECT_TRUE(tests::near_abs(r1.momentum_sum, r1.raw_defect, 1e-13));
  EXPECT_GT(std::abs(r1.raw_defect), 1e-9);
}

TEST(WindowScheme, AuditTellsR1FromE1) {
  const auto r1 = run(Scheme::robin_explicit, 1280, 10);
  const auto e1 = run(Scheme::serial_staggered, 1280, 10);
  EXPECT_LT(r1.energy_defect, 1e-3);
  EXPECT_LT(r1.momentum_defect, 1e-4);
  EXPECT_GT(e1.energy_defect, 1e-3);
  EXPECT_GT(e1.momentum_defect, 1e-4);
}

TEST(WindowScheme, FirstForceOfE1IsThePadsAtTheInitialValues) {
  struct Rail : tests::RailModel {
    using RailModel::RailModel;
    proto::Result advance(const proto::Advance& request) override {
      force = request.data.get(proto::field::force_mean).at(0);
      return RailModel::advance(request);
    }
    double force = 0.0;
  };
  const tests::Oscillator oscillator;
  Rail rail(oscillator);
  tests::SleeperModel sleeper(oscillator);
  WindowScheme windows(Scheme::serial_staggered, 0.01, 1, {oscillator.pad});
  windows.start({{oscillator.u}, {oscillator.v}, {oscillator.x}, {oscillator.y}});
  windows.advance(proto::Phase::march, 0, {rail, sleeper});
  EXPECT_TRUE(tests::near_abs(rail.force, 10.0 * 1.5 + 0.2 * -0.3, 1e-14));
}

TEST(WindowScheme, R1PredictsTheSleepersMeanMotion) {
  struct Rail : tests::RailModel {
    using RailModel::RailModel;
    proto::Result advance(const proto::Advance& request) override {
      seen = request.data;
      return RailModel::advance(request);
    }
    proto::FieldSet seen;
  };
  const tests::Oscillator oscillator;
  const double h = 0.02;
  Rail rail(oscillator);
  tests::SleeperModel sleeper(oscillator);
  WindowScheme windows(Scheme::robin_explicit, h, 3, {oscillator.pad});
  windows.start({{oscillator.u}, {oscillator.v}, {oscillator.x}, {oscillator.y}});
  const auto first = windows.advance(proto::Phase::march, 0, {rail, sleeper});
  windows.advance(proto::Phase::march, 1, {rail, sleeper});
  const double x = first.sleeper_displacement[0], y = first.sleeper_velocity[0], a = (y - oscillator.y) / h;
  EXPECT_TRUE(tests::near_abs(rail.seen.get(proto::field::sleeper_mean_displacement).at(0),
                              x + h * y / 2 + h * h * a / 6, 1e-15));
  EXPECT_TRUE(tests::near_abs(rail.seen.get(proto::field::sleeper_mean_velocity).at(0), y + h * a / 2, 1e-15));
  EXPECT_TRUE(tests::near_abs(rail.seen.get(proto::field::force_carry).at(0),
                              first.force_robin[0] - first.impulse[0] / h, 1e-12));
}

TEST(WindowScheme, NamesTheMissingField) {
  struct Mute : coupler::Side {
    proto::Result advance(const proto::Advance&) override { return {}; }
    void rollback(const proto::Rollback&) override {}
    void commit(const proto::Commit&) override {}
  } mute;
  WindowScheme windows(Scheme::robin_explicit, 0.01, 1, {proto::PadLaw{}});
  try {
    windows.advance(proto::Phase::march, 0, {mute, mute});
    FAIL() << "nothing was thrown";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
    EXPECT_NE(std::string(error.what()).find("fem did not return the field 'rail_displacement'"), std::string::npos);
  }
}

TEST(WindowScheme, SubCyclesAreTheSmallestWholeNumber) {
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, std::nullopt), 1u);
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, 5e-6), 10u);
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, 4.9e-6), 11u);
  EXPECT_EQ(coupler::sub_cycles_for(0.025, 0.0025), 10u);
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, 1.0), 1u);
  EXPECT_THROW(coupler::sub_cycles_for(5e-5, 0.0), proto::Error);
  EXPECT_THROW(coupler::sub_cycles_for(5e-5, 1e-15), proto::Error);
}

TEST(Audit, SumsVectorsPerSeatAndTakesTheLargestPrefix) {
  Audit audit({1, 1}, 0.5);
  coupler::WindowRecord record;
  record.rail_displacement_begin = {0, 0, 0, 0, 0, 0};
  record.rail_displacement = {0, 0, 1, 0, 0, 2};
  record.force_used = {0, 0, -2, 0, 0, -4};
  record.impulse = {0.3, 0, -1.4, 0, 0, -2};
  record.pad_work = {0, 0, -1, 0, 0, -8};
  audit.add(record);  // W = 2 + 8, D = 1 + 0, P = (-0.3, 0, 0.4) and 0
  std::swap(record.rail_displacement_begin, record.rail_displacement);
  record.pad_work = {0, 0, 1, 0, 0, 8};
  record.impulse = {-0.3, 0, -0.6, 0, 0, -2};
  const auto last = audit.add(record);  // D = -1 + 0 takes the sum back to 0; so does P
  EXPECT_TRUE(tests::near_abs(last.energy_defect_sum, 0.0, 1e-15));
  EXPECT_TRUE(tests::near_abs(audit.energy_defect_relative(), 1.0 / 20.0, 1e-15));
  EXPECT_TRUE(tests::near_abs(audit.momentum_defect_relative(), 0.5 / 4.0, 1e-15));
}

/// A tolerance of 1 %, the default limits of the residuals.
proto::Initialise rest_limits(int min_windows, int check_windows, double force_floor = 0.0) {
  proto::Initialise limits;
  limits.min_windows = min_windows, limits.check_windows = check_windows;
  limits.tolerance = 1e-2, limits.force_floor = force_floor;
  return limits;
}

TEST(RestWatch, WaitsForTheBandAndTheMinimum) {
  coupler::RestWatch watch(rest_limits(6, 3));
  EXPECT_FALSE(watch.add({{-50.0}}));
  for (int n = 0; n < 4; ++n) EXPECT_FALSE(watch.add({{-100.0 - 0.1 * n}})) << n;
  EXPECT_TRUE(watch.add({{-100.4}}));
  EXPECT_TRUE(tests::near_rel(watch.figures().change, 0.3 / 100.4, 1e-9));
}

TEST(RestWatch, BelowTheFloorTheChangeIsRelativeToIt) {
  coupler::RestWatch loose(rest_limits(0, 2, 1000.0)), strict(rest_limits(0, 2));
  bool loose_rests = false, strict_rests = false;
  for (const double force : {10.0, 14.0, 12.0}) {
    loose_rests = loose.add({{force}});
    strict_rests = strict.add({{force}});
  }
  EXPECT_TRUE(loose_rests);
  EXPECT_FALSE(strict_rests);
  EXPECT_NEAR(loose.figures().change, 4.0 / 1000.0, 1e-15);
}

TEST(RestWatch, ASwingAboutNothingIsNoRest) {
  coupler::RestWatch watch(rest_limits(0, 2));
  for (int n = 0; n < 50; ++n) EXPECT_FALSE(watch.add({{n % 2 ? 1.0 : -1.0}}));
}

TEST(RestWatch, EachResidualMustStayWithinItsLimit) {
  auto limits = rest_limits(0, 2);
  limits.qdem_residual_limit = 0.02, limits.fem_residual_limit = 0.01;
  const auto rests_with = [&](double qdem, double fem) {
    coupler::RestWatch watch(limits);
    watch.add({{5.0}, qdem, fem});
    EXPECT_FALSE(watch.add({{5.0}, 0.0, 0.0})) << "too few windows were seen";
    return watch.add({{5.0}, 0.0, 0.0});
  };
  EXPECT_TRUE(rests_with(0.02, 0.01));
  EXPECT_FALSE(rests_with(0.021, 0.01));
  EXPECT_FALSE(rests_with(0.02, 0.011));
}

TEST(RestWatch, ForgetsResidualsOlderThanItsWindows) {
  coupler::RestWatch watch(rest_limits(0, 2));
  watch.add({{5.0}, 1.0, 1.0});
  for (int n = 0; n < 2; ++n) EXPECT_FALSE(watch.add({{5.0}, 1e-3, 2e-3})) << n;
  EXPECT_TRUE(watch.add({{5.0}, 1e-3, 2e-3}));
  EXPECT_EQ(watch.figures().qdem_residual, 1e-3);
  EXPECT_EQ(watch.figures().fem_residual, 2e-3);
}

TEST(RestWatch, NamesEveryCriterionWithValueAndLimit) {
  auto limits = rest_limits(0, 1);
  limits.qdem_residual_limit = 0.02;
  coupler::RestWatch watch(limits);
  EXPECT_NE(watch.text().find("change of the seat force inf"), std::string::npos) << watch.text();
  for (int n = 0; n < 2; ++n) watch.add({{5.0}, 0.5, 3e-4});
  EXPECT_EQ(watch.text(),
            "change of the seat force 0.00e+00 (tolerance 1.00e-02), residual of qdem 5.00e-01 (qdem_residual_limit "
            "2.00e-02), residual of fem 3.00e-04 (fem_residual_limit 5.00e-03)");
}

}  // namespace
