// The FEM participant in a Robin-coupled passage over one sleeper, against the same track solved in one piece.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fem_solver/participant/fem_participant.hpp"
#include "tests/support/fem_rails.hpp"
#include "tests/support/tolerance.hpp"

namespace {

namespace field = proto::field;
using tests::near_abs;
using tests::near_rel;

const char* case_text = R"(
[coupling]
scheme = "R1"
window_s = 5e-5
duration_s = 0.03
output_interval_s = 1e-2
[track]
gauge_m = 1.435
sleeper_spacing_m = 0.6
[[rail_seat]]
name = "seat"
origin_m = [0.0, 0.7535, 0.0]
longitudinal_axis = [1, 0, 0]
lateral_axis = [0, 1, 0]
half_lengths_m = [0.075, 0.07]
cells = [3, 3]
stiffness_n_per_m = [60e6, 60e6, 225e6]
damping_ns_per_m = [15e3, 15e3, 30e3]
[fem]
n_bays = 10
element_length_m = 0.3
gravity = false
[wheel]
speed_m_per_s = 40.0
start_m = -0.9
static_load_n = 65e3
unsprung_mass_kg = 600.0
radius_m = 0.43
)";

// Half a sleeper as the support model has it, explicit: kick-drift-kick with the dashpots at the predicted velocity.
class Sleeper {
 public:
  explicit Sleeper(std::vector<proto::PadLaw> laws) : laws_(std::move(laws)) {}

  /// Window with linear rail motion; returns the impulse of each pad value.
  std::vector<double> advance(const std::vector<double>& u0, const std::vector<double>& u1, double window, int m) {
    const double dt = window / m;
    std::vector<double> impulse(laws_.size(), 0.0);
    for (int j = 0; j < m; ++j) {
      const auto first = forces(u0, u1, window, j * dt);
      const Eigen::Vector3d a0 = acceleration(first), half = velocity + dt / 2 * a0;
      displacement += dt * half;
      velocity += dt * a0;
      const auto second = forces(u0, u1, window, (j + 1) * dt);
      velocity = half + dt / 2 * acceleration(second);
      for (std::size_t i = 0; i < laws_.size(); ++i) impulse[i] += dt * (first[i] + second[i]) / 2;
    }
    return impulse;
  }

  Eigen::Vector3d displacement = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();

 private:
  std::vector<double> forces(const std::vector<double>& u0, const std::vector<double>& u1, double window,
                             double t) const {
    std::vector<double> f(laws_.size());
    for (std::size_t i = 0; i < f.size(); ++i) {
      const double rate = (u1[i] - u0[i]) / window;
      f[i] = laws_[i].force(u0[i] + rate * t - displacement[i % 3], rate - velocity[i % 3]);
    }
    return f;
  }
  Eigen::Vector3d acceleration(const std::vector<double>& f) const {
    const fem::SupportSettings s;
    Eigen::Vector3d sum = -s.ballast_stiffness.cwiseProduct(displacement) - s.ballast_damping.cwiseProduct(velocity);
    for (std::size_t i = 0; i < f.size(); ++i) sum[i % 3] += f[i];
    return sum / s.sleeper_mass;
  }

  std::vector<proto::PadLaw> laws_;
};

class FemParticipantTest : public tests::BothRails {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / "fem_participant";
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "case.toml") << case_text;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  proto::Configure configure(const std::vector<proto::PadLaw>& laws) const {
    proto::Configure request;
    request.window_s = 5e-5, request.windows = 600;
    request.output_directory = folder_.string();
    for (const auto& law : laws) {
      request.stiffness.push_back(law.stiffness), request.damping.push_back(law.damping);
      request.preload.push_back(law.preload), request.tension_cutoff.push_back(law.tension_cutoff);
    }
    return request;
  }

  std::filesystem::path folder_;
};

double vertical_sum(const std::vector<double>& values) {
  double sum = 0.0;
  for (std::size_t i = 2; i < values.size(); i += 3) sum += values[i];
  return sum;
}

TEST_P(FemParticipantTest, robin_passage_equals_the_track_in_one_piece) {
  const auto input = fem::read_fem_case((folder_ / "case.toml").string());
  const auto laws = proto::interface_laws(input.seats);
  const double h = 5e-5;
  fem::FemParticipant participant(input, "fem_solver", "fem", GetParam().build);
  ASSERT_EQ(participant.describe().seats.size(), 1u);
  participant.configure(configure(laws));
  Sleeper sleeper(laws);
  proto::Progress progress;
  std::vector<double> carry(laws.size(), 0.0), u;
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  double largest_force = 0.0, largest_error = 0.0;

  const auto window = [&](proto::Phase phase, std::int64_t n) {
    proto::Advance request{phase, n, 0, h, 1, {}};
    std::vector<double> x(laws.size()), y(laws.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = sleeper.displacement[i % 3] + h / 2 * sleeper.velocity[i % 3] + h * h / 6 * acceleration[i % 3];
      y[i] = sleeper.velocity[i % 3] + h / 2 * acceleration[i % 3];
    }
    request.data.set(field::sleeper_mean_displacement, x);
    request.data.set(field::sleeper_mean_velocity, y);
    request.data.set(field::force_carry, carry);
    const auto result = participant.advance(request, progress);
    const auto& u1 = result.get(field::rail_displacement);
    const Eigen::Vector3d before = sleeper.velocity;
    const auto impulse = sleeper.advance(u.empty() ? u1 : u, u1, h, 20);
    acceleration = (sleeper.velocity - before) / h;
    const auto& robin = result.get(field::force_robin);
    for (std::size_t i = 0; i < carry.size(); ++i) carry[i] = robin[i] - impulse[i] / h;
    u = u1;
    participant.commit({n});
    return vertical_sum(impulse) / h;
  };

  for (int n = 0; n < 800; ++n) window(proto::Phase::initialise, n);
  EXPECT_LT(participant.residual().value(), 1e-3);
  sleeper.velocity.setZero(), acceleration.setZero();
  std::fill(carry.begin(), carry.end(), 0.0);
  u = participant.start().get(field::rail_displacement);

  const auto rail = GetParam().build(input.fem, input.seats, fem::SeatOwner::own_supports);
  const auto& system = rail->track();
  fem::WheelTrack whole(*rail, input.fem, input.wheel, h, {});
  const int seat = input.fem.n_bays / 2;
  ASSERT_EQ(system.support_seats[seat].name, "seat");
  for (int n = 0; n < 600; ++n) {
    const auto state = whole.state().track;
    whole.march({});
    const Eigen::VectorXd mean = (state.displacement + whole.state().track.displacement) / 2,
                          rate = (state.velocity + whole.state().track.velocity) / 2;
    const Eigen::VectorXd cell = system.support_cells.middleRows(27 * seat, 27) * mean.head(system.n_rail_dofs);
    const Eigen::VectorXd cell_rate = system.support_cells.middleRows(27 * seat, 27) * rate.head(system.n_rail_dofs);
    double target = 0.0;
    for (int i = 2; i < 27; i += 3)
      target +=
          laws[i].force(cell[i] - mean[system.sleeper_dof(seat, 2)], cell_rate[i] - rate[system.sleeper_dof(seat, 2)]);
    const double force = window(proto::Phase::march, n);
    largest_force = std::max(largest_force, std::abs(target));
    largest_error = std::max(largest_error, std::abs(force - target));
  }
  std::printf("largest seat force %.3f kN, largest difference %.3g of it\n", largest_force * 1e-3,
              largest_error / largest_force);
  EXPECT_GT(largest_force, 20e3);
  EXPECT_TRUE(near_abs(largest_error / largest_force, 0.0, 2e-3));
  const auto facts = participant.finish();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "fem.h5"));
  EXPECT_EQ(facts.at(1).key, "fem.largest_contact_force_n");
}

TEST_P(FemParticipantTest, a_window_after_rollback_repeats_itself) {
  const auto input = fem::read_fem_case((folder_ / "case.toml").string());
  const auto laws = proto::interface_laws(input.seats);
  fem::FemParticipant participant(input, "fem_solver", "fem", GetParam().build);
  participant.configure(configure(laws));
  participant.start();
  proto::Progress progress;
  proto::Advance request{proto::Phase::march, 0, 0, 5e-5, 1, {}};
  request.data.set(field::sleeper_mean_displacement, std::vector<double>(27, -1e-5));
  request.data.set(field::sleeper_mean_velocity, std::vector<double>(27, 1e-3));
  request.data.set(field::force_carry, std::vector<double>(27, 1.0));
  const auto first = participant.advance(request, progress).get(field::rail_displacement);
  participant.rollback({0});
  EXPECT_EQ(participant.advance(request, progress).get(field::rail_displacement), first);
}

TEST_P(FemParticipantTest, bad_cases_name_the_key) {
  const auto refuses = [&](const std::string& from, const std::string& to, const std::string& named) {
    std::string text = case_text;
    text.replace(text.find(from), from.size(), to);
    std::ofstream(folder_ / "bad.toml") << text;
    try {
      fem::read_fem_case((folder_ / "bad.toml").string());
      ADD_FAILURE() << "accepted: " << to;
    } catch (const proto::Error& error) {
      EXPECT_EQ(error.code(), proto::ExitCode::config);
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
  };
  refuses("n_bays = 10", "n_bay = 10", "n_bays");
  refuses("n_bays = 10", "n_bays = 9", "n_bays");
  refuses("unsprung_mass_kg = 600.0", "unsprung_mass_kg = -600.0", "unsprung_mass_kg");
  refuses("radius_m = 0.43", "", "radius_m");
  refuses("output_interval_s = 1e-2", "output_interval_s = 1.02e-4", "output_interval_s");
}

INSTANTIATE_TEST_SUITE_P(rails, FemParticipantTest, tests::BothRails::kinds(), tests::BothRails::name);

}  // namespace
