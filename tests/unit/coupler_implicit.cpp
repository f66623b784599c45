// The implicit scheme on model participants: order, exact balances, its negative controls, accelerations, limits.
#include "coupler/scheme/iqn_ils.hpp"
#include "proto/error.hpp"
#include "tests/support/scheme_run.hpp"

namespace {

using Acceleration = proto::Iteration::Acceleration;
using proto::Scheme;
using tests::SchemeCase;

const Eigen::Vector4d exact = tests::exact_state(tests::Oscillator(), 4.0);

TEST(Implicit, IsOfSecondOrder) {
  for (const auto prolongation : {proto::Prolongation::linear, proto::Prolongation::hermite}) {
    SchemeCase c(Scheme::implicit);
    c.coupling.prolongation = prolongation;
    c.converged();
    for (const std::uint32_t sub_cycles : {1, 10, 50})
      EXPECT_TRUE(tests::near_abs(tests::observed_order(c, exact, sub_cycles), 2.0, 0.15)) << sub_cycles;
  }
}

TEST(Implicit, PredictorAndTwoPassesIsOfSecondOrderToo) {
  SchemeCase c(Scheme::implicit);
  c.coupling.iteration.acceleration = Acceleration::constant;
  c.coupling.iteration.relaxation = 1.0;
  c.coupling.iteration.max_iterations = 2;
  c.coupling.iteration.accept_at_limit = true;
  EXPECT_TRUE(tests::near_abs(tests::observed_order(c, exact, 10), 2.0, 0.15));
  EXPECT_EQ(tests::run_scheme(c, 160, 10).mean_solves, 2.0);
}

TEST(Implicit, WithTheLinearPathNothingIsLostAtTheInterface) {
  for (const bool cut_off : {false, true}) {
    SchemeCase c(Scheme::implicit);
    c.track.pad.tension_cutoff = cut_off, c.track.pad.preload = 1.0;
    const auto run = tests::run_scheme(c.converged(), 320, 10);
    EXPECT_LT(run.energy_defect, 1e-12) << cut_off;
    EXPECT_LT(run.momentum_defect, 1e-13) << cut_off;
  }
}

TEST(Implicit, WithTheCubicPathAndTheMeanForceEnergyIsLostAtSecondOrder) {
  SchemeCase c(Scheme::implicit);
  c.coupling.prolongation = proto::Prolongation::hermite;
  c.converged();
  std::vector<double> steps, defects;
  for (const int n : {160, 320, 640}) {
    const auto run = tests::run_scheme(c, n, 10);
    steps.push_back(4.0 / n);
    defects.push_back(run.energy_defect);
    EXPECT_LT(run.momentum_defect, 1e-13);
  }
  EXPECT_GT(defects.back(), 1e-7) << "this control must see a defect";
  EXPECT_TRUE(tests::converges_with_order(steps, defects, 2.0, 0.15));
}

TEST(Implicit, AnUpliftCaseOfR1ConvergesToItAtSecondOrder) {
  // The pad opens and closes; the same law with its cut-off on both sides.
  SchemeCase implicit(Scheme::implicit), robin(Scheme::robin_explicit);
  implicit.converged();
  for (auto* c : {&implicit, &robin}) c->track.pad.tension_cutoff = true, c->track.pad.preload = 1.0;
  const auto reference = tests::run_scheme(implicit, 5120, 10);
  const double lowest = *std::min_element(reference.pad_force.begin(), reference.pad_force.end()),
               highest = *std::max_element(reference.pad_force.begin(), reference.pad_force.end());
  EXPECT_TRUE(tests::near_abs(highest, 1.0, 1e-9)) << "the pad never opened";
  EXPECT_LT(lowest, -1.0) << "the pad never closed";
  EXPECT_TRUE(tests::near_abs(tests::observed_order(robin, reference.end, 10, {320, 640, 1280}), 2.0, 0.3));
}

struct Sweeps {
  Acceleration acceleration;
  double most;
};

class Accelerated : public ::testing::TestWithParam<Sweeps> {};

TEST_P(Accelerated, ConvergesWhereThePlainIterationDiverges) {
  // Fixed-point factor above one: k H^2 / (4 m) = 1.6, before a sleeper too heavy to follow.
  SchemeCase c(Scheme::implicit);
  c.track.sleeper_mass = 5.0;
  c.end_time = 0.8 * 200;
  auto& iteration = c.coupling.iteration;
  iteration.acceleration = GetParam().acceleration;
  iteration.relaxation = 0.3;
  iteration.max_iterations = 100;
  const auto run = tests::run_scheme(c, 200, 20);
  EXPECT_LE(run.mean_solves, GetParam().most);
  EXPECT_GT(run.mean_solves, 1.0);
  iteration.acceleration = Acceleration::constant;
  iteration.relaxation = 1.0;
  EXPECT_THROW(tests::run_scheme(c, 200, 20), proto::Error);
}

INSTANTIATE_TEST_SUITE_P(Each, Accelerated,
                         ::testing::Values(Sweeps{Acceleration::constant, 30}, Sweeps{Acceleration::aitken, 6},
                                           Sweeps{Acceleration::iqn_ils, 4}),
                         [](const auto& test) {
                           return std::string(test.param.acceleration == Acceleration::constant ? "constant"
                                              : test.param.acceleration == Acceleration::aitken ? "aitken"
                                                                                                : "iqn_ils");
                         });

TEST(Implicit, AtItsLimitItStopsOrFlagsAsTheCaseSays) {
  SchemeCase c(Scheme::implicit);
  c.coupling.iteration.acceleration = Acceleration::constant;
  c.coupling.iteration.max_iterations = 3;
  try {
    tests::run_scheme(c, 40, 10);
    FAIL() << "nothing was thrown";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("did not converge in 3 passes"), std::string::npos) << error.what();
  }
  c.coupling.iteration.accept_at_limit = true;
  tests::RailModel rail(c.track);
  tests::SleeperModel sleeper(c.track);
  const auto record = tests::scheme_of(c, 0.1, 10)->advance(proto::Phase::march, 0, {rail, sleeper});
  EXPECT_FALSE(record.converged);
  EXPECT_EQ(record.solves, 3);
}

/// g(z) = A z + b with a spectral radius above one; n unknowns.
struct LinearMap {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  explicit LinearMap(int n) : a(n, n), b(n) {
    for (int i = 0; i < n; ++i) {
      b[i] = 1.0 + i;
      for (int j = 0; j < n; ++j) a(i, j) = i == j ? -1.0 - 0.3 * i : 0.4 / (1.0 + i + 2 * j);
    }
  }
  std::vector<double> operator()(const std::vector<double>& z) const {
    const Eigen::VectorXd image = a * Eigen::Map<const Eigen::VectorXd>(z.data(), b.size()) + b;
    return {image.data(), image.data() + image.size()};
  }
};

/// Iterations until the residual is below 1e-9 of the image.
int iterations(const coupler::Acceleration& acceleration, coupler::AccelerationState& memory, const LinearMap& map,
               std::vector<double> z) {
  for (int k = 1; k <= 60; ++k) {
    const auto image = map(z);
    if (coupler::norm(coupler::residual_of(z, image)) < 1e-9 * coupler::norm(image)) {
      acceleration.end_window(memory, z, image);
      return k;
    }
    z = acceleration.next(memory, z, image);
  }
  return 61;
}

TEST(IqnIls, SolvesALinearSystemInItsDimensionAndReusesWhatItLearned) {
  const int n = 5;
  proto::Iteration settings;
  const coupler::IqnIls acceleration(settings);
  coupler::AccelerationState memory;
  LinearMap map(n);
  EXPECT_LE(iterations(acceleration, memory, map, std::vector<double>(n, 0.0)), n + 3);
  EXPECT_EQ(memory.columns_of_window.size(), 2u);
  map.b *= 1.5;
  EXPECT_LE(iterations(acceleration, memory, map, std::vector<double>(n, 0.0)), 3) << "the same system, another load";
  for (int window = 0; window < 20; ++window) iterations(acceleration, memory, map, std::vector<double>(n, window));
  EXPECT_LE(memory.columns.size(), std::size_t{n});
  EXPECT_EQ(memory.columns_of_window.size(), 9u) << "eight windows and the next one";
}

TEST(IqnIls, WithoutReuseEveryWindowBeginsAnew) {
  proto::Iteration settings;
  settings.reused_windows = 0;
  const coupler::IqnIls acceleration(settings);
  coupler::AccelerationState memory;
  const LinearMap map(5);
  const int first = iterations(acceleration, memory, map, std::vector<double>(5, 0.0));
  EXPECT_TRUE(memory.columns.empty());
  EXPECT_EQ(iterations(acceleration, memory, map, std::vector<double>(5, 0.0)), first);
}

TEST(IqnIls, ForgetsColumnsThatSayNothingNew) {
  const coupler::IqnIls acceleration(proto::Iteration{});
  coupler::AccelerationState memory;
  memory.columns = {{{1, 0, 0}, {2, 0, 0}}, {{1, 1e-4, 0}, {2, 0, 0}}, {{0, 1, 0}, {0, 3, 0}}};
  memory.columns_of_window = {0, 3};
  acceleration.next(memory, {0, 0, 0}, {1, 1, 1});
  ASSERT_EQ(memory.columns.size(), 2u);
  EXPECT_EQ(memory.columns[1].residual, (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(memory.columns_of_window.back(), 2u);
}

TEST(IqnIls, AStepThatStandsStillForgetsTheOldestHalfAndRelaxes) {
  const coupler::IqnIls acceleration(proto::Iteration{});
  coupler::AccelerationState memory;
  // The only column says that the residual goes away without a change of the iterate: image + W c = iterate.
  memory.columns = {{{1, 0}, {1, 0}}};
  memory.columns_of_window = {0, 1};
  const auto next = acceleration.next(memory, {2, 0}, {3, 0});
  EXPECT_EQ(next, (std::vector<double>{2.5, 0}));
  EXPECT_TRUE(memory.columns.empty());
}

TEST(Aitken, SurvivesAResidualThatDoesNotChange) {
  const coupler::AitkenRelaxation acceleration(0.5);
  coupler::AccelerationState memory;
  acceleration.next(memory, {1.0}, {2.0});
  EXPECT_EQ(acceleration.next(memory, {1.0}, {2.0}), std::vector<double>{1.5});
}

}  // namespace
