#include "fem_solver/time/wheel_track.hpp"

#include <cmath>
#include <string>

#include "proto/error.hpp"

namespace fem {

WheelTrack::Stepper::Stepper(const TrackSystem& system, double step, double mass_damping)
    : newmark(system, step, mass_damping) {
  if (system.interface.rows() == 0) return;
  interface_columns = newmark.factor().solve_columns(Eigen::MatrixXd(system.interface.transpose()));
  compliance = system.interface * interface_columns;
}

WheelTrack::WheelTrack(const RailModel& rail, const FemSettings& fem, const WheelSettings& wheel, WheelModel model,
                       double step, std::vector<proto::PadLaw> laws)
    : system_(rail.track()),
      wheel_(wheel),
      wheel_model_(std::move(model)),
      wheel_stepper_(wheel_model_, step),
      step_(step),
      initialise_damping_(fem.initialise_damping),
      laws_(std::move(laws)),
      band_(rail.band()),
      hertz_(wheel.radius, wheel.rail_crown_radius, wheel.wheel, wheel.rail),
      contact_(make_wheel_contact(wheel, step)),
      statics_(system_, band_),
      indentation_(rail.indentation([this](const Eigen::VectorXd& load) { return statics_.flexibility(load); })),
      march_(system_, step, 0.0) {
  rest(Eigen::VectorXd::Zero(system_.cells.rows()));
}

void WheelTrack::rest(const Eigen::VectorXd& sleeper_displacement) {
  const auto laws = sleeper_displacement.size() > 0 ? laws_ : std::vector<proto::PadLaw>{};
  const StaticState s = statics_.solve(laws, sleeper_displacement, band_.at(wheel_.start), wheel_.static_load);
  state_.last = {s.pad_force, wheel_.static_load};
  set_rest(s.displacement);
}

void WheelTrack::set_rest(const Eigen::VectorXd& displacement) {
  state_.track = march_.newmark.state_at_rest(displacement);
  state_.windows = state_.windows_open = 0;
  state_.wheel_position = wheel_.start;
  // The contact takes the excess out of the rail's descent, here as in add_wheel().
  const BandWeights place = band_.at(wheel_.start);
  const double rail = band_.read(place, displacement) + excess_flexibility(place) * wheel_.static_load;
  double approach = 0.0;
  state_.patch = contact_->at_rest(wheel_.start, approach);
  const double wheel =
      rail + wheel_.height_at(wheel_.start) - approach + wheel_model_.local_flexibility * wheel_.static_load;
  state_.wheel = wheel_at_rest(wheel_model_, wheel);
}

WindowOutput WheelTrack::relax(const WindowInput& input, double step) {
  if (!relax_ || relax_->newmark.step() != step) relax_ = std::make_unique<Stepper>(system_, step, initialise_damping_);
  const TrackState before = state_.track;
  WindowOutput output = advance(*relax_, input, Wheel::standing);
  residual_ = static_residual(before, output.force_used);
  return output;
}

double WheelTrack::static_residual(const TrackState& before, const Eigen::VectorXd& force_used) const {
  Eigen::VectorXd load = system_.weight - system_.cells.transpose() * force_used;
  load -= system_.support_pads().transpose() * state_.last.force.tail(system_.support_laws.size());
  band_.add_load(band_.at(wheel_.start), -wheel_.static_load, load);
  return (load - (before.elastic + state_.track.elastic) / 2).lpNorm<1>() / load.lpNorm<1>();
}

void WheelTrack::start() {
  relax_.reset();
  const InterfaceSolution last = state_.last;
  set_rest(Eigen::VectorXd(state_.track.displacement));
  state_.last = last;
}

WindowOutput WheelTrack::march(const WindowInput& input) {
  WindowOutput output = advance(march_, input, Wheel::rolling);
  ++state_.windows;
  return output;
}

Eigen::VectorXd WheelTrack::contact_response(Stepper& stepper, const BandWeights& place) const {
  auto& stations = stepper.stations;
  stations.erase(stations.begin(), stations.lower_bound(place.first_station));
  Eigen::VectorXd response = Eigen::VectorXd::Zero(system_.n_dofs());
  for (std::size_t j = 0; j < place.weights.size(); ++j) {
    const int station = place.first_station + static_cast<int>(j);
    auto found = stations.find(station);
    if (found == stations.end())
      found = stations.emplace(station, stepper.newmark.response(band_.station_load(station))).first;
    response += place.weights[j] * found->second;
  }
  return response;
}

// The wheel's own window equation makes its mean displacement affine in F.
void WheelTrack::add_wheel(InterfaceProblem& problem, const BandWeights& place, double position,
                           const Eigen::VectorXd& response, const Eigen::VectorXd& free) const {
  const double half = step_ / 2;
  const double rail_free = band_.read(place, state_.track.displacement) + half * band_.read(place, free);
  problem.contact_law = contact_->law(position, state_.patch);
  problem.approach_0 = rail_free + wheel_.height_at(position) - wheel_stepper_.free_displacement(state_.wheel);
  problem.contact_slope = half * (band_.read(place, response) + wheel_stepper_.response()) - excess_flexibility(place) -
                          wheel_model_.local_flexibility;
}

WindowOutput WheelTrack::advance(Stepper& stepper, const WindowInput& input, Wheel wheel) {
  const double position =
      wheel == Wheel::rolling ? position_at(static_cast<double>(state_.windows) + 0.5) : wheel_.start;
  const BandWeights place = band_.at(position);
  const Eigen::VectorXd response = contact_response(stepper, place);

  Eigen::VectorXd load = system_.weight;
  if (input.prescribed) load -= system_.cells.transpose() * *input.prescribed;
  Eigen::VectorXd right_side = stepper.newmark.right_side(state_.track, load);
  Eigen::VectorXd velocity = stepper.newmark.response(right_side);

  InterfaceProblem p;
  if (!input.prescribed) p.laws = interface_laws_of(laws_);
  const auto n_coupled = static_cast<Eigen::Index>(p.laws.size());
  p.laws.insert(p.laws.end(), system_.support_laws.begin(), system_.support_laws.end());
  const auto n = static_cast<Eigen::Index>(p.laws.size());
  const auto rows = system_.interface.bottomRows(n);
  p.time_factor = stepper.newmark.step() / 2;
  p.carry = p.gap_0 = p.free_velocity = p.sleeper_velocity = p.contact_column = Eigen::VectorXd::Zero(n);
  if (n > 0) {
    p.gap_0 = rows * state_.track.displacement;
    p.free_velocity = rows * velocity;
    p.compliance = stepper.compliance.bottomRightCorner(n, n);
    p.contact_column = rows * response;
  }
  if (n_coupled > 0) {
    p.carry.head(n_coupled) = input.carry;
    p.gap_0.head(n_coupled) -= input.sleeper_displacement;
    p.sleeper_velocity.head(n_coupled) = input.sleeper_velocity;
  }
  if (wheel == Wheel::rolling)
    add_wheel(p, place, position, response, velocity);
  else
    p.given_contact = wheel_.static_load;

  InterfaceSolution guess = state_.last;
  if (guess.force.size() != n) guess.force = Eigen::VectorXd::Zero(n);
  const std::string where =
      "fem: window " + std::to_string(state_.windows) + ", wheel at x = " + std::to_string(position) + " m";
  const InterfaceSolution solution = solve_interface(p, guess, where.c_str());

  const Eigen::VectorXd used = solution.force - p.carry;
  WindowOutput output{solution.force.head(n_coupled), used.head(n_coupled)};
  if (input.prescribed) output.force_robin = output.force_used = *input.prescribed;
  if (n > 0) {
    velocity -= stepper.interface_columns.rightCols(n) * used;
    right_side -= rows.transpose() * used;
  }
  velocity -= solution.contact * response;
  band_.add_load(place, -solution.contact, right_side);
  stepper.newmark.finish(state_.track, velocity, right_side);

  if (wheel == Wheel::rolling) {
    contact_->roll(position, solution.approach, state_.patch);
    wheel_stepper_.finish(state_.wheel, solution.contact);
  }
  state_.wheel_position = position;
  state_.last = solution;
  if (wheel == Wheel::rolling) watch_contact_loss(where);
  return output;
}

void WheelTrack::watch_contact_loss(const std::string& where) {
  state_.windows_open = state_.last.contact > 0 ? 0 : state_.windows_open + 1;
  const double open = static_cast<double>(state_.windows_open) * step_;
  if (open > wheel_.longest_contact_loss)
    throw proto::Error(
        proto::ExitCode::numerics,
        "the wheel has been off the rail for " + std::to_string(open) + " s, longer than the case allows", where,
        "raise wheel.longest_contact_loss_s, or see what throws the wheel up");
}

}  // namespace fem
