// Audit, its limits, what a run shows of its scheme, and the watch for rest.
#include <gtest/gtest.h>

#include "coupler/scheme/audit_watch.hpp"
#include "coupler/scheme/observation.hpp"
#include "coupler/scheme/rest_watch.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using coupler::Audit;

/// One cell at the seat's origin.
const coupler::AuditSeat one_cell{{{0.0, 0.0, 0.0}}, 1.0};

TEST(Audit, SumsVectorsPerSeatAndTakesTheLargestPrefix) {
  Audit audit({one_cell, one_cell}, 0.5);
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

TEST(Audit, TakesTheMomentAboutTheSeatsOrigin) {
  Audit audit({{{{0.1, 0.0, 0.0}, {-0.1, 0.0, 0.0}}, 0.2}}, 0.5);
  coupler::WindowRecord record;
  record.rail_displacement_begin = record.rail_displacement = record.pad_work = std::vector<double>(6, 0.0);
  record.impulse = {0, 0, -1, 0, 0, -1};
  record.force_used = {0, 0, -2.4, 0, 0, -1.6};  // P = -0.2 and 0.2: no force, a moment of 0.04 about axis 2
  const auto defects = audit.add(record);
  EXPECT_TRUE(tests::near_abs(defects.moment_defect[1], 0.04, 1e-15));
  EXPECT_TRUE(tests::near_abs(audit.momentum_defect_relative(), 0.0, 1e-15));
  EXPECT_TRUE(tests::near_abs(audit.moment_defect_relative(), 0.04 / (0.2 * 2.0), 1e-15));
}

/// Windows whose energy defect is a tenth of their work of 1 J, momentum exact.
coupler::WindowRecord leaky_window() {
  coupler::WindowRecord record;
  record.rail_displacement_begin = {0, 0, 0}, record.rail_displacement = {0, 0, 1};
  record.force_used = {0, 0, -1}, record.impulse = {0, 0, -0.5}, record.pad_work = {0, 0, -0.9};
  return record;
}

TEST(AuditWatch, SpeaksOnceWhenTheRunIsOverOrTheScaleIsReached) {
  for (const double scale : {0.0, 50.0}) {
    proto::AuditLimits limits;
    limits.energy = 0.05, limits.work_scale = limits.impulse_scale = scale;
    coupler::AuditWatch watch(limits);
    Audit audit({one_cell}, 0.5);
    std::vector<int> told;
    for (int n = 0; n < 10; ++n) {
      audit.add(leaky_window());
      for (const auto& text : watch.look(audit, n == 9)) {
        told.push_back(n);
        EXPECT_EQ(text, "the interface's energy defect is 1.00e-01 (coupling.audit.energy 5.00e-02)");
      }
    }
    EXPECT_EQ(told, std::vector<int>{scale > 0.0 ? 5 : 9}) << "more than a tenth of 50 J after six windows";
  }
}

TEST(Observation, TellsGrowthContractionAndTheLawsTangent) {
  coupler::Observation seen(400, 0.5);
  for (int n = 0; n < 400; ++n) {
    coupler::WindowRecord record;
    record.solves = n % 2 ? 3 : 1, record.contraction = 0.25, record.converged = n != 7;
    record.force_used = {2.0 + 2 * std::pow(1.01, n)}, record.impulse = {1.0};
    record.force_robin = {1.07 * n}, record.force_law = {1.0 * n};
    seen.add(record);
  }
  EXPECT_TRUE(tests::near_rel(seen.growth(), 1.01, 1e-9));
  EXPECT_TRUE(tests::near_rel(seen.contraction(), 0.25, 1e-12));
  EXPECT_TRUE(tests::near_rel(seen.law_deviation(), 0.07, 1e-12));
  EXPECT_EQ(seen.mean_solves(), 2.0);
  EXPECT_NE(seen.text().find("passes per window 2.00 (at most 3), contraction 0.25, 1 windows not converged"),
            std::string::npos)
      << seen.text();
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
