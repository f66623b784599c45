// One window of the condensed solve against a monolithic one, energy without damping, laws on both sides.
#include <Eigen/SparseCholesky>
#include <cmath>

#include "fem_solver/time/wheel_track.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/fem_rails.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

constexpr double step = 5e-5;

fem::FemSettings short_track() {
  auto s = tests::small_track();
  s.n_bays = 6;
  s.element_length = 0.3;
  return s;
}

// M, C and K of the whole track with the pads of the coupled seats on sleepers that move as told.
struct Monolithic {
  fem::SparseMatrix stiffness, damping;
  Monolithic(const fem::TrackSystem& s, const std::vector<proto::PadLaw>& laws) {
    Eigen::VectorXd k(laws.size()), c(laws.size());
    for (std::size_t i = 0; i < laws.size(); ++i) k[i] = laws[i].stiffness, c[i] = laws[i].damping;
    const fem::SparseMatrix to_nodes = s.cells.transpose();
    const fem::SparseMatrix rail = s.rail_stiffness.selfadjointView<Eigen::Lower>();
    stiffness = s.support_stiffness.selfadjointView<Eigen::Lower>();
    stiffness += rail + fem::SparseMatrix(to_nodes * k.asDiagonal() * s.cells);
    damping = s.support_damping.selfadjointView<Eigen::Lower>();
    damping += s.stiffness_damping * rail + fem::SparseMatrix(to_nodes * c.asDiagonal() * s.cells);
  }
};

using Window = tests::BothRails;
using Residual = tests::BothRails;
using Energy = tests::BothRails;

TEST_P(Window, equals_the_monolithic_implicit_solve) {
  const auto settings = short_track();
  const auto rail = GetParam().build(settings, {tests::rail_seat(0.0), tests::rail_seat(0.6)}, fem::SeatOwner::partner);
  const auto& system = rail->track();
  const auto laws = proto::interface_laws(system.coupled_seats);
  fem::WheelSettings wheel;
  wheel.start = 0.2;
  fem::WheelTrack track(*rail, settings, wheel, step, laws);

  const auto n = static_cast<Eigen::Index>(laws.size());
  fem::WindowInput input;
  input.sleeper_displacement = Eigen::VectorXd::LinSpaced(n, -2e-4, 1e-4);
  input.sleeper_velocity = Eigen::VectorXd::LinSpaced(n, 0.02, -0.03);
  input.carry = Eigen::VectorXd::LinSpaced(n, -300, 500);
  track.march(input);  // leaves a state in motion
  const fem::RunState before = track.state();
  input.sleeper_velocity *= -1.0;
  const auto output = track.march(input);
  const fem::RunState after = track.state();

  // (2 M/H + C + K H/2) v_m = F + 2 M v_0/H - K u_0 with spring and dashpot of the pads in C and K.
  const Monolithic m(system, laws);
  Eigen::VectorXd k(n), c(n);
  for (Eigen::Index i = 0; i < n; ++i) k[i] = laws[i].stiffness, c[i] = laws[i].damping;
  Eigen::VectorXd load = system.cells.transpose() * (k.cwiseProduct(input.sleeper_displacement) +
                                                     c.cwiseProduct(input.sleeper_velocity) + input.carry);
  const double position = 0.2 + 40.0 * step * 1.5;
  const auto place = track.band().at(position);
  track.band().add_load(place, -track.contact_force(), load);
  fem::SparseMatrix mass = system.mass.selfadjointView<Eigen::Lower>();
  mass *= 2 / step;
  const fem::SparseMatrix a = fem::SparseMatrix(step / 2 * m.stiffness + m.damping) + mass;
  const Eigen::SimplicialLDLT<fem::SparseMatrix> solver(a);
  const Eigen::VectorXd mean =
      solver.solve(load + mass * before.track.velocity - m.stiffness * before.track.displacement);
  const Eigen::VectorXd u = before.track.displacement + step * mean, v = 2 * mean - before.track.velocity;
  EXPECT_TRUE(near_abs((after.track.displacement - u).norm() / u.norm(), 0.0, 1e-10));
  EXPECT_TRUE(near_abs((after.track.velocity - v).norm() / v.norm(), 0.0, 1e-8));
  EXPECT_TRUE(near_abs((output.force_robin - output.force_used - input.carry).norm(), 0.0, 1e-9));

  // The contact force is Hertz's of the monolithic solution's mean approach.
  const double wheel_mean = (before.wheel.hub() + after.wheel.hub()) / 2;
  const double rail_mean = track.band().read(place, (before.track.displacement + u) / 2) +
                           (track.indentation() - place.missing_flexibility) * track.contact_force();
  EXPECT_TRUE(
      near_rel(track.contact_force(), track.hertz().coefficient() * std::pow(rail_mean - wheel_mean, 1.5), 1e-8));
}

TEST_P(Window, cut_off_pads_follow_the_law_at_the_mean_gap) {
  const auto settings = short_track();
  auto seat = tests::rail_seat(0.0);
  seat.tension_cutoff = true, seat.clip_preload = 9e2;
  const auto rail = GetParam().build(settings, {seat}, fem::SeatOwner::partner);
  const auto& system = rail->track();
  const auto laws = proto::interface_laws(system.coupled_seats);
  fem::WheelSettings wheel;
  wheel.start = -0.9;
  fem::WheelTrack track(*rail, settings, wheel, step, laws);
  const auto n = static_cast<Eigen::Index>(laws.size());
  fem::WindowInput input;
  // The sleeper tilts away below one side of the pad.
  input.sleeper_displacement = Eigen::VectorXd::Zero(n);
  for (int cell = 0; cell < 9; ++cell) input.sleeper_displacement[3 * cell + 2] = cell % 3 == 0 ? -1e-4 : 0.0;
  input.sleeper_velocity = input.carry = Eigen::VectorXd::Zero(n);
  const Eigen::VectorXd before = track.cell_displacement();
  const auto output = track.march(input);
  const Eigen::VectorXd after = track.cell_displacement();
  int n_loose = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double gap = (before[i] + after[i]) / 2 - input.sleeper_displacement[i], rate = (after[i] - before[i]) / step;
    ASSERT_TRUE(near_abs(output.force_robin[i], laws[i].force(gap, rate), 1e-5));
    n_loose += !laws[i].engaged(gap, rate);
  }
  EXPECT_EQ(n_loose, 3);
}

TEST_P(Window, prescribed_force_moves_the_rail_as_the_same_pad_force_does) {
  const auto settings = short_track();
  const auto rail = GetParam().build(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::partner);
  const auto& system = rail->track();
  const auto laws = proto::interface_laws(system.coupled_seats);
  fem::WheelSettings wheel;
  wheel.start = 0.2;
  fem::WheelTrack robin(*rail, settings, wheel, step, laws), given(*rail, settings, wheel, step, laws);
  const auto n = static_cast<Eigen::Index>(laws.size());
  fem::WindowInput input;
  input.sleeper_displacement = Eigen::VectorXd::Constant(n, -1e-4);
  input.sleeper_velocity = Eigen::VectorXd::Constant(n, 0.01);
  input.carry = Eigen::VectorXd::Constant(n, 20.0);
  const auto output = robin.march(input);
  fem::WindowInput force;
  force.prescribed = output.force_used;
  given.march(force);
  EXPECT_TRUE(near_rel(given.contact_force(), robin.contact_force(), 1e-10));
  const Eigen::VectorXd difference = given.state().track.displacement - robin.state().track.displacement;
  EXPECT_TRUE(near_abs(difference.norm() / robin.state().track.displacement.norm(), 0.0, 1e-10));
}

TEST_P(Residual, is_inertia_and_damping_over_the_load) {
  const auto settings = short_track();
  const auto rail = GetParam().build(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::partner);
  const auto& system = rail->track();
  const auto laws = proto::interface_laws(system.coupled_seats);
  fem::WheelSettings wheel;
  wheel.start = 0.2;
  fem::WheelTrack track(*rail, settings, wheel, step, laws);
  const auto n = static_cast<Eigen::Index>(laws.size());
  fem::WindowInput input;
  input.sleeper_displacement = Eigen::VectorXd::Constant(n, -2e-4);
  input.sleeper_velocity = input.carry = Eigen::VectorXd::Zero(n);
  track.rest(input.sleeper_displacement);
  track.relax(input, step);
  EXPECT_TRUE(near_abs(track.residual(), 0.0, 1e-8)) << "the static state is at rest";

  input.sleeper_displacement.setConstant(-3e-4);  // the sleeper is pulled away: rail and supports begin to move
  for (int window = 0; window < 3; ++window) {
    const fem::TrackState before = track.state().track;
    const auto output = track.relax(input, step);
    const fem::TrackState after = track.state().track;
    const Eigen::VectorXd rate = (before.velocity + after.velocity) / 2;
    const Eigen::VectorXd acceleration = (after.velocity - before.velocity) / step;
    Eigen::VectorXd missing = fem::symmetric(system.mass) * (acceleration + settings.initialise_damping * rate).eval();
    missing += system.support_damping.selfadjointView<Eigen::Lower>() * rate;
    missing += system.stiffness_damping * (system.rail_stiffness.selfadjointView<Eigen::Lower>() * rate).eval();
    Eigen::VectorXd load = system.weight - system.cells.transpose() * output.force_used;
    track.band().add_load(track.band().at(wheel.start), -wheel.static_load, load);
    EXPECT_TRUE(near_rel(track.residual(), missing.cwiseAbs().sum() / load.cwiseAbs().sum(), 1e-6)) << window;
    EXPECT_GT(track.residual(), 1e-4);
  }
}

TEST_P(Energy, free_vibration_without_damping_conserves) {
  auto settings = short_track();
  settings.loss_factor = 0.0, settings.end_dashpot_frequency = 0.0;
  settings.support.pad_damping.setZero(), settings.support.ballast_damping.setZero();
  auto seat = tests::rail_seat(0.0);
  seat.damping.setZero();
  const auto rail = GetParam().build(settings, {seat}, fem::SeatOwner::own_supports);
  const auto& system = rail->track();
  const auto& band = rail->band();
  const fem::Statics statics(system, band);
  const fem::Newmark newmark(system, step, 0.0);
  auto state = newmark.state_at_rest(statics.solve({}, {}, band.at(0.1), 80e3).displacement);
  const double energy = newmark.energy(state);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.n_dofs());
  for (int n = 0; n < 1000; ++n) {
    const Eigen::VectorXd right_side = newmark.right_side(state, none);
    newmark.finish(state, newmark.response(right_side), right_side);
    ASSERT_TRUE(near_rel(newmark.energy(state), energy, 1e-10));
  }
  // The internal force that is carried along is still the stiffness times the displacement.
  const Eigen::VectorXd elastic = newmark.state_at_rest(state.displacement).elastic;
  EXPECT_TRUE(near_abs((state.elastic - elastic).norm() / elastic.norm(), 0.0, 1e-7));
}

INSTANTIATE_TEST_SUITE_P(rails, Window, tests::BothRails::kinds(), tests::BothRails::name);
INSTANTIATE_TEST_SUITE_P(rails, Residual, tests::BothRails::kinds(), tests::BothRails::name);
INSTANTIATE_TEST_SUITE_P(rails, Energy, tests::BothRails::kinds(), tests::BothRails::name);

}  // namespace
