// The explicit schemes, one way and the switch between schemes on the split oscillator, with model participants.
#include <Eigen/LU>
#include <complex>

#include "coupler/scheme/one_way.hpp"
#include "proto/error.hpp"
#include "tests/support/scheme_run.hpp"

namespace {

using proto::Scheme;
using tests::SchemeCase;

constexpr double end_time = 4.0;
const Eigen::Vector4d exact = tests::exact_state(tests::Oscillator(), end_time);

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

/// A side that keeps what it was asked.
template <class Model>
struct Listening : Model {
  using Model::Model;
  proto::Result advance(const proto::Advance& request) override {
    seen = request;
    return Model::advance(request);
  }
  proto::Advance seen;
};

struct Expectation {
  Scheme scheme;
  double order;
};

class ExplicitScheme : public ::testing::TestWithParam<Expectation> {};

TEST_P(ExplicitScheme, HasItsOrder) {
  const SchemeCase c(GetParam().scheme);
  // E0 and E1 pump energy: their order shows in shorter windows only.
  const std::vector<int> windows =
      GetParam().order < 2 ? std::vector<int>{640, 1280, 2560} : std::vector<int>{160, 320, 640};
  for (const std::uint32_t sub_cycles : {1, 10, 50})
    EXPECT_TRUE(tests::near_abs(tests::observed_order(c, exact, sub_cycles, windows), GetParam().order, 0.15))
        << proto::name_of(c.coupling.scheme) << " with " << sub_cycles << " sub-cycles";
}

INSTANTIATE_TEST_SUITE_P(Each, ExplicitScheme,
                         ::testing::Values(Expectation{Scheme::robin_explicit, 2},
                                           Expectation{Scheme::robin_corrected, 2},
                                           Expectation{Scheme::serial_extrapolated, 2},
                                           Expectation{Scheme::serial_staggered, 1},
                                           Expectation{Scheme::parallel_staggered, 1}),
                         [](const auto& test) { return proto::name_of(test.param.scheme); });

/// F sin(w t) on the rail (test problem T3), as mean over the window.
struct ForcedRail : tests::RailModel {
  using tests::RailModel::RailModel;
  static constexpr double force = 3.0, frequency = 2.5;
  double mean_load(const proto::Advance& request) const override {
    const double h = request.window_s, t = static_cast<double>(request.window) * h;
    return force * (std::cos(frequency * t) - std::cos(frequency * (t + h))) / (frequency * h);
  }
};

TEST(ExplicitSchemes, FollowASinusoidalLoadWithTheRightAmplitudeAndPhase) {
  using Complex = std::complex<double>;
  const tests::Oscillator o;
  const Complex iw(0.0, ForcedRail::frequency), pad = o.pad.stiffness + iw * o.pad.damping;
  Eigen::Matrix2cd dynamic;
  dynamic << iw * iw * o.rail_mass + o.rail_stiffness + pad, -pad, -pad,
      iw * iw * o.sleeper_mass + o.sleeper_stiffness + pad;
  const Eigen::Vector2cd amplitude = dynamic.inverse() * Eigen::Vector2cd(ForcedRail::force, 0.0);
  const auto steady = [&](double t) -> Eigen::Vector4d {
    const Eigen::Vector2cd z = amplitude * std::exp(iw * t), rate = iw * z;
    return {z[0].imag(), rate[0].imag(), z[1].imag(), rate[1].imag()};
  };
  const auto start = steady(0.0);
  for (const auto& [scheme, order] : {std::pair(Scheme::robin_explicit, 2.0), std::pair(Scheme::robin_corrected, 2.0),
                                      std::pair(Scheme::implicit, 2.0), std::pair(Scheme::serial_staggered, 1.0)}) {
    SchemeCase c(scheme);
    c.track.u = start[0], c.track.v = start[1], c.track.x = start[2], c.track.y = start[3];
    const std::vector<int> windows = order < 2 ? std::vector<int>{640, 1280, 2560} : std::vector<int>{160, 320, 640};
    const double found = tests::observed_order<ForcedRail, tests::SleeperModel>(c, steady(c.end_time), 10, windows);
    EXPECT_TRUE(tests::near_abs(found, order, 0.15)) << proto::name_of(scheme);
  }
}

TEST(CouplingScheme, EveryWindowGetsTheSubCyclesOfItsOwnBound) {
  const SchemeCase c(Scheme::robin_explicit);
  const auto order = tests::observed_order<tests::RailModel, FitfulSleeper>(c, exact, FitfulSleeper::sub_cycles_of(0));
  EXPECT_TRUE(tests::near_abs(order, 2.0, 0.15));
}

TEST(CouplingScheme, R1AndR2KeepTheMomentumUpToTheLastWindowsRawDefect) {
  for (const auto scheme : {Scheme::robin_explicit, Scheme::robin_corrected}) {
    const auto run = tests::run_scheme(SchemeCase(scheme), 320, 10);
    EXPECT_TRUE(tests::near_abs(run.momentum_sum, run.raw_defect, 1e-13));
    EXPECT_GT(std::abs(run.raw_defect), 1e-12);
  }
}

TEST(CouplingScheme, TheCorrectorLowersTheEnergyDefect) {
  EXPECT_LT(tests::run_scheme(SchemeCase(Scheme::robin_corrected), 320, 10).energy_defect,
            tests::run_scheme(SchemeCase(Scheme::robin_explicit), 320, 10).energy_defect);
}

TEST(CouplingScheme, TheAuditTellsR1FromE1) {
  const auto r1 = tests::run_scheme(SchemeCase(Scheme::robin_explicit), 1280, 10);
  const auto e1 = tests::run_scheme(SchemeCase(Scheme::serial_staggered), 1280, 10);
  EXPECT_LT(r1.energy_defect, 1e-3);
  EXPECT_LT(r1.momentum_defect, 1e-4);
  EXPECT_GT(e1.energy_defect, 1e-3);
  EXPECT_GT(e1.momentum_defect, 1e-4);
}

TEST(CouplingScheme, FirstForceOfE1IsThePadsAtTheInitialValues) {
  const SchemeCase c(Scheme::serial_staggered);
  Listening<tests::RailModel> rail(c.track);
  tests::SleeperModel sleeper(c.track);
  tests::scheme_of(c, 0.01, 1)->advance(proto::Phase::march, 0, {rail, sleeper});
  EXPECT_TRUE(tests::near_abs(rail.seen.data.get(proto::field::force_mean).at(0), 10.0 * 1.5 + 0.2 * -0.3, 1e-14));
}

TEST(CouplingScheme, R1PredictsTheSleepersMeanMotion) {
  const SchemeCase c(Scheme::robin_explicit);
  const double h = 0.02;
  Listening<tests::RailModel> rail(c.track);
  tests::SleeperModel sleeper(c.track);
  const auto scheme = tests::scheme_of(c, h, 3);
  const auto first = scheme->advance(proto::Phase::march, 0, {rail, sleeper});
  scheme->advance(proto::Phase::march, 1, {rail, sleeper});
  const auto& seen = rail.seen.data;
  const double x = first.sleeper_displacement[0], y = first.sleeper_velocity[0], a = (y - c.track.y) / h;
  EXPECT_TRUE(
      tests::near_abs(seen.get(proto::field::sleeper_mean_displacement).at(0), x + h * y / 2 + h * h * a / 6, 1e-15));
  EXPECT_TRUE(tests::near_abs(seen.get(proto::field::sleeper_mean_velocity).at(0), y + h * a / 2, 1e-15));
  EXPECT_TRUE(
      tests::near_abs(seen.get(proto::field::force_carry).at(0), first.force_robin[0] - first.impulse[0] / h, 1e-12));
  EXPECT_FALSE(rail.seen.data.has(proto::field::path_velocity)) << "only a cubic path has slopes";
}

/// A side that writes down when it is begun and when its end is awaited.
template <class Model>
struct Noting : Model {
  Noting(const coupler::LumpedTrack& track, std::string& c, char n) : Model(track), calls(c), name(n) {}
  void begin(const proto::Advance& request) override { calls += {'+', name}, Model::begin(request); }
  proto::Result end() override { return calls += {'-', name}, Model::end(); }
  std::string& calls;
  char name;
};

TEST(CouplingScheme, E0BeginsBothSidesBeforeItEndsOne) {
  const SchemeCase c(Scheme::parallel_staggered);
  std::string calls;
  Noting<tests::RailModel> rail(c.track, calls, 'r');
  Noting<tests::SleeperModel> sleeper(c.track, calls, 's');
  tests::scheme_of(c, 0.01, 1)->advance(proto::Phase::march, 0, {rail, sleeper});
  EXPECT_EQ(calls, "+r+s-r-s");
}

TEST(CouplingScheme, OneWayTheRailIsThatOfItsStandInSupport) {
  // The rail alone on its own spring and the pad: a damped oscillator with a closed form; the sleeper does not matter.
  SchemeCase c(Scheme::one_way);
  const auto laws = coupler::stand_in_laws({c.track.pad}, {c.track.sleeper_stiffness});
  const double share = 4.0 / 14.0;
  EXPECT_TRUE(tests::near_rel(laws[0].stiffness, 10.0 * share, 1e-15));
  EXPECT_TRUE(tests::near_rel(laws[0].damping, 0.2 * share * share, 1e-15));
  const double k = 1.0 + c.track.pad.stiffness, damping = c.track.pad.damping / 2;
  const double frequency = std::sqrt(k - damping * damping);
  const double wanted = std::exp(-damping * c.end_time) *
                        (std::cos(frequency * c.end_time) + damping / frequency * std::sin(frequency * c.end_time));
  std::vector<double> steps, errors;
  for (const int n : {160, 320, 640}) {
    steps.push_back(c.end_time / n);
    errors.push_back(std::abs(tests::run_scheme(c, n, 10).end[0] - wanted));
  }
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.15));
}

TEST(CouplingScheme, ARunGoesOnWithAnotherSchemeFromTheStateOfTheFirst) {
  // R1 for half the time, then R2: still of second order, and better than R1 alone.
  const auto error = [&](int n_windows) {
    const SchemeCase first(Scheme::robin_explicit), second(Scheme::robin_corrected);
    const double h = end_time / n_windows;
    tests::RailModel rail(first.track);
    tests::SleeperModel sleeper(first.track);
    auto scheme = tests::scheme_of(first, h, 10);
    for (int n = 0; n < n_windows; ++n) {
      if (n == n_windows / 2) {
        auto next = tests::scheme_of(second, h, 10);
        next->resume(scheme->state());
        scheme = std::move(next);
      }
      scheme->advance(proto::Phase::march, n, {rail, sleeper});
    }
    return (Eigen::Vector4d(rail.displacement(), rail.velocity(), sleeper.displacement(), sleeper.velocity()) - exact)
        .norm();
  };
  EXPECT_TRUE(tests::converges_with_order({1.0, 0.5, 0.25}, {error(160), error(320), error(640)}, 2.0, 0.15));
}

TEST(CouplingScheme, ResumedFromItsStateItGivesTheSameBits) {
  for (const auto scheme : {Scheme::robin_explicit, Scheme::robin_corrected, Scheme::parallel_staggered,
                            Scheme::serial_staggered, Scheme::serial_extrapolated, Scheme::implicit, Scheme::one_way,
                            Scheme::rigid_per_window, Scheme::rigid_per_step}) {
    const SchemeCase c(scheme);
    const auto run = [&](int resumed_at) {
      tests::RailModel rail(c.track);
      tests::SleeperModel sleeper(c.track);
      auto windows = tests::scheme_of(c, 0.02, 4);
      for (int n = 0; n < 60; ++n) {
        if (n == resumed_at) {
          const auto state = windows->state();
          windows = tests::scheme_of(c, 0.02, 4);
          windows->resume(state);
        }
        windows->advance(proto::Phase::march, n, {rail, sleeper});
      }
      return std::vector<double>{rail.displacement(), rail.velocity(), sleeper.displacement(), sleeper.velocity()};
    };
    EXPECT_EQ(run(-1), run(31)) << proto::name_of(scheme);
  }
}

TEST(CouplingScheme, NamesTheMissingField) {
  struct Mute : coupler::Side {
    proto::Result advance(const proto::Advance&) override { return {}; }
    void rollback(const proto::Rollback&) override {}
    void commit(const proto::Commit&) override {}
  } mute;
  const auto scheme = tests::scheme_of(SchemeCase(Scheme::robin_explicit), 0.01, 1);
  try {
    scheme->advance(proto::Phase::march, 0, {mute, mute});
    FAIL() << "nothing was thrown";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
    EXPECT_NE(std::string(error.what()).find("fem did not return the field 'rail_displacement'"), std::string::npos);
  }
}

TEST(CouplingScheme, SubCyclesAreTheSmallestWholeNumber) {
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, std::nullopt), 1u);
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, 5e-6), 10u);
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, 4.9e-6), 11u);
  EXPECT_EQ(coupler::sub_cycles_for(0.025, 0.0025), 10u);
  EXPECT_EQ(coupler::sub_cycles_for(5e-5, 1.0), 1u);
  EXPECT_THROW(coupler::sub_cycles_for(5e-5, 0.0), proto::Error);
  EXPECT_THROW(coupler::sub_cycles_for(5e-5, 1e-15), proto::Error);
}

}  // namespace
