// Pads, mats and half-space ground as springs and dashpots in series with the contact: deflection, decay, step.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "proto/error.hpp"
#include "qdem_solver/contact/entry_laws.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/vibration.hpp"

namespace {

using Eigen::Vector3d;
using qdem::Bearing;
using qdem::Model;
using tests::near_rel;

constexpr double bedding_modulus = 1e8;  // [N/m3]
const Vector3d block(0.2, 0.3, 0.1);
const double area = block[0] * block[1];

/// A mat of the bedding modulus under n contact points that share the area.
Bearing mat(int n_points) {
  const double k = bedding_modulus * area / n_points;
  return {k, 0.3 * k, 0.0, 0.0, area / n_points};
}

/// A block whose bottom lies on a plane, as far from it as its rounding. Stiff against its contacts.
Model block_on_plane(std::array<int, 3> cells, const Bearing& bearing) {
  Model model = tests::free_bodies(tests::box_template(cells, block), tests::rock());
  model.gravity = {0, 0, -9.81};
  model.contact = {4e7, 0.8, 0.0, 0.0, 1e-3};
  model.planes.push_back({"ground", {0, 0, -1e-3}, Vector3d::UnitZ(), Vector3d::Zero(), 0.0, true, true, bearing});
  return model;
}

int bottom_points(const Model& model) {
  const auto& nodes = model.shape(0).nodes;
  return static_cast<int>(std::count_if(nodes.begin(), nodes.end(), [](const Vector3d& x) { return x[2] == 0; }));
}

double mean_height(const Model& model, const qdem::State& state) {
  double sum = 0.0;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    sum += model.shape(0).node_volumes[i] / model.shape(0).volume() * state.position(model, 0, i)[2];
  }
  return sum;
}

double step_of(const Model& model, qdem::State& state) {
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  return qdem::StepBound(model).at(state, engine.contacts(), 0.5e-3);
}

/// How far body 0 comes down until it is at rest, by a drag that is critical for a spring that gives so much [m].
double deflection(Model& model, std::vector<qdem::Placement> places, double about) {
  qdem::State state = qdem::make_state(model, places);
  const double start = mean_height(model, state), dt = 0.8 * step_of(model, state), omega = std::sqrt(9.81 / about);
  model.drag_per_s = 2 * omega;
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  engine.advance(state, dt, static_cast<std::int64_t>(12 / omega / dt));
  return start - mean_height(model, state);
}

}  // namespace

TEST(Series, OfVoigtElementsIsThatOfTheirComplexStiffness) {
  const Bearing p{3e6, 1e6, 300, 200, 1e-3}, q{7e6, 2e6, 100, 50, 2e-3};
  const Bearing both = qdem::in_series(p, q);
  for (const double omega : {0.0, 10.0, 100.0}) {
    using Complex = std::complex<double>;
    const Complex a(p.normal_stiffness, omega * p.normal_damping), b(q.normal_stiffness, omega * q.normal_damping);
    const Complex exact = a * b / (a + b), found(both.normal_stiffness, omega * both.normal_damping);
    const double slowness = omega * (p.normal_damping + q.normal_damping) / (p.normal_stiffness + q.normal_stiffness);
    EXPECT_LE(std::abs(found - exact), slowness * slowness * std::abs(exact) + 1e-9) << omega;
  }
  EXPECT_TRUE(near_rel(both.tangential_stiffness, 2e6 / 3, 1e-12));
  EXPECT_EQ(qdem::in_series(Bearing{}, q).normal_stiffness, q.normal_stiffness);
  qdem::ContactLaw law;
  law.normal_stiffness = 4e7, law.damping_ratio = 0.1;
  EXPECT_EQ(qdem::in_series(law, Bearing{}).normal_stiffness, law.normal_stiffness);
  // The dashpot of the contact, seen through the layer: c (k_l/(k_n + k_l))^2 with c = 2 zeta sqrt(m k_n), m = 1.
  const auto soft = qdem::in_series(law, p);
  EXPECT_TRUE(near_rel(2 * soft.damping_ratio * std::sqrt(soft.normal_stiffness),
                       2 * 0.1 * std::sqrt(4e7) * std::pow(3.0 / 43, 2), 1e-12));
}

TEST(UnderBallastMat, UniformPressureGivesPressureOverBeddingModulus) {
  for (const std::array<int, 3> cells : {std::array{2, 3, 1}, std::array{4, 6, 2}}) {
    Model model = block_on_plane(cells, {});
    const int n = bottom_points(model);
    model.planes[0].bearing = mat(n);
    const double weight = 9.81 * model.body_mass(0);
    const double expected = weight / (bedding_modulus * area) + weight / (n * model.contact.normal_stiffness);
    const double found = deflection(model, {{}}, expected);
    std::cout << n << " points: " << 1e6 * found << " um for " << 1e6 * expected << " um\n";
    EXPECT_TRUE(near_rel(found, expected, 1e-3)) << n << " points";
  }
}

namespace {

/// Body 0 on a block that is held, too coarse to have a particle under it.
Model block_on_block() {
  Model model = block_on_plane({2, 3, 1}, {});
  model.contact.normal_stiffness = 5e5;  // gives way about as much as a pad
  model.pad_body = 0;
  model.templates.push_back(tests::box_template({1, 1, 1}, {1.0, 1.0, 0.2}));
  qdem::Body held;
  held.kind = qdem::BodyKind::other, held.name = "held", held.template_id = 1;
  model.bodies.push_back(held);
  model.planes.clear();
  qdem::make_batches(model);
  for (int i = 0; i < model.shape(1).n_nodes(); ++i) model.fixities.push_back({1, i, 7u});
  return model;
}

std::vector<qdem::Placement> on_top(const Model& model) {
  std::vector<qdem::Placement> places(2);
  places[1].translation = {-0.3, -0.27, -0.2 - 2 * model.contact.rounding};
  return places;
}

}  // namespace

TEST(UnderSleeperPad, IsInSeriesWithTheContactOfItsBottomOnly) {
  Model model = block_on_block();
  const auto places = on_top(model);
  const int n = bottom_points(model);
  model.lining = mat(n);
  const double weight = 9.81 * model.body_mass(0), bare = weight / (n * model.contact.normal_stiffness);
  const double expected = weight / (bedding_modulus * area) + bare;
  EXPECT_TRUE(near_rel(deflection(model, places, expected), expected, 1e-3));
  // Of the block below the top is not lined.
  model.pad_body = 1;
  EXPECT_TRUE(near_rel(deflection(model, places, bare), bare, 1e-3));
}

TEST(UnderSleeperPad, PressedDeeperThanContactsAreFollowedIsAnError) {
  Model model = block_on_block();
  model.lining = {1e4, 3e3, 0.0, 0.0, 1e-3};
  model.pad_body_load = {0, 0, -1.2 * 4e-3 * 1e4 * bottom_points(model)};
  try {
    deflection(model, on_top(model), 4e-3);
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("deeper than contacts are followed (4 mm)"), std::string::npos)
        << error.what();
  }
}

namespace {

/// Body 0 is pushed from its rest on the ground: frequency [Hz] and damping ratio of its bounce.
struct Bounce {
  double frequency, damping_ratio;
};

Bounce bounce(Model model, double omega) {
  model.gravity.setZero();
  for (auto& plane : model.planes) plane.point[2] += 1e-5;  // touching from the start: the springs never let go
  qdem::State state = qdem::make_state(model, {{}});
  // A load takes the place of gravity, so that the rest is known.
  model.pad_body = 0;
  const auto law = qdem::in_series(model.contact, model.planes[0].bearing);
  model.pad_body_load = {0, 0, -1e-5 * law.normal_stiffness * bottom_points(model)};
  const double dt = 0.5 * step_of(model, state);
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    qdem::State::scatter(model, state.v, 0, i, Vector3d(0, 0, 5e-6 * omega));
  }
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  const double start = mean_height(model, state);
  tests::Signal signal{{}, dt};
  for (double time = 0; time < 2.3 * 2 * M_PI / omega; time += dt) {
    signal.values.push_back(mean_height(model, state) - start);
    engine.advance(state, dt, 1);
  }
  const double frequency = tests::frequency(signal);
  const auto peak = [&](double from, double to) {
    const auto at = [&](double t) { return signal.values.begin() + static_cast<std::ptrdiff_t>(t / frequency / dt); };
    return *std::max_element(at(from), at(to));
  };
  const double decrement = std::log(peak(0, 0.5) / peak(1, 1.5));
  return {frequency, decrement / std::sqrt(4 * M_PI * M_PI + decrement * decrement)};
}

}  // namespace

TEST(UnderBallastMat, ALossFactorIsTwiceTheDampingRatioAtItsFrequency) {
  Model model = block_on_plane({2, 3, 1}, {});
  model.contact.normal_stiffness = 4e9;  // the mat alone gives way
  const int n = bottom_points(model);
  Bearing bearing = mat(n);
  const double omega = std::sqrt(bedding_modulus * area / model.body_mass(0)), loss_factor = 0.2;
  bearing.normal_damping = loss_factor * bearing.normal_stiffness / omega;
  model.planes[0].bearing = bearing;
  const auto found = bounce(model, omega);
  std::cout << "damping ratio " << found.damping_ratio << "\n";
  EXPECT_TRUE(near_rel(found.damping_ratio, loss_factor / 2, 0.02));
  EXPECT_TRUE(near_rel(found.frequency, omega / (2 * M_PI) * std::sqrt(1 - 0.01), 0.005));
}

TEST(HalfSpaceGround, ABouncingFootingIsLysmersAnalogue) {
  // Lysmer and Richart 1966: with B = (1 - nu) m/(4 rho r^3) the damping ratio is 0.425/sqrt(B).
  Model model = block_on_plane({1, 1, 1}, {});
  model.contact.normal_stiffness = 4e10;
  const qdem::Material soil{"soil", 50e6, 0.3, 2000, 0, 0};
  const double radius = 0.05;
  const int n = bottom_points(model);
  model.planes[0].bearing = qdem::half_space(soil, radius);
  const double mass = model.body_mass(0) / n;  // on each footing
  const double ratio = (1 - soil.poisson) * mass / (4 * soil.density * std::pow(radius, 3));
  const double omega = std::sqrt(4 * soil.mu() * radius / (1 - soil.poisson) / mass);
  const auto found = bounce(model, omega);
  const double expected = 0.425 / std::sqrt(ratio);
  std::cout << "damping ratio " << found.damping_ratio << " for " << expected << "\n";
  EXPECT_TRUE(near_rel(found.damping_ratio, expected, 0.02));
  EXPECT_TRUE(near_rel(found.frequency, omega / (2 * M_PI) * std::sqrt(1 - expected * expected), 0.01));
}

TEST(StepBound, CountsTheDashpotsOfLayers) {
  Model model = block_on_plane({2, 3, 1}, {});
  Bearing bearing = mat(bottom_points(model));
  // Behind a contact a hundred times softer than itself a dashpot hardly shows; in front of one it does.
  model.contact.normal_stiffness = 1e9;
  model.planes[0].bearing = bearing;
  qdem::State state = qdem::make_state(model, {{}});
  const double without = step_of(model, state);
  bearing.normal_damping = 2e6;
  model.planes[0].bearing = bearing;
  const double bound = step_of(model, state);
  EXPECT_LT(bound, 0.5 * without);
  model.gravity *= 50;  // so that it does not jump off
  const auto speed_after = [&](double share) {
    qdem::State copy = state;
    qdem::Engine engine(model, {1});
    engine.prepare(copy);
    try {
      engine.advance(copy, share * bound, 3000);
    } catch (const proto::Error&) {
      return 1e99;
    }
    return engine.largest_speed(copy);
  };
  EXPECT_LT(speed_after(1.0), 0.1);
  EXPECT_GT(speed_after(8.0), 1.0);  // and it is not a bound of something else
}
