// The advisor's critical windows against those published for the same lumped seat, and its formulas.
#include "coupler/advisor/advice.hpp"
#include "coupler/advisor/stability.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using proto::Scheme;

/// One bay of rail, half a sleeper on ballast; pads of 3e4 N s/m.
coupler::LumpedTrack seat(double stiffness) {
  coupler::LumpedTrack track;
  track.rail_mass = 36.0, track.sleeper_mass = 150.0;
  track.sleeper_stiffness = 2e7, track.sleeper_damping = 3.1e4;
  track.pad = {stiffness, 3e4, 0.0, false};
  return track;
}

struct Row {
  Scheme scheme;
  double stiffness, window_s;  ///< infinite: above 3e-3 s
};

TEST(Advisor, CriticalWindowsAreThoseOfTheSpectralRadius) {
  // Largest window with a spectral radius of the coupled step of at most 1 + 1e-6 (20 sub-cycles).
  const std::vector<Row> rows = {
      {Scheme::parallel_staggered, 6.5e7, 3.7e-4},  {Scheme::parallel_staggered, 2.25e8, 1.5e-4},
      {Scheme::parallel_staggered, 1e9, 3.6e-5},    {Scheme::serial_staggered, 6.5e7, 5.3e-4},
      {Scheme::serial_staggered, 2.25e8, 1.6e-4},   {Scheme::serial_staggered, 1e9, 3.7e-5},
      {Scheme::serial_extrapolated, 6.5e7, 7.0e-4}, {Scheme::serial_extrapolated, 2.25e8, 3.1e-4},
      {Scheme::serial_extrapolated, 1e9, 1.1e-4}};
  coupler::StabilityScan scan;
  scan.n_windows = 4000, scan.growth = 1e-6;
  for (const auto& row : rows) {
    const double found = coupler::critical_window(row.scheme, {}, seat(row.stiffness), scan);
    std::printf("%s k=%.3g: critical window %.2e s (%.2e)\n", proto::name_of(row.scheme).c_str(), row.stiffness, found,
                row.window_s);
    EXPECT_TRUE(tests::near_rel(found, row.window_s, 0.1)) << proto::name_of(row.scheme) << " " << row.stiffness;
  }
  // Robin with carry on damped pads: no growth up to 5e-4 s.
  for (const double stiffness : {6.5e7, 2.25e8})
    EXPECT_GT(coupler::critical_window(Scheme::robin_explicit, {}, seat(stiffness)), 5e-4);
}

TEST(Advisor, ThePlainIterationDivergesWhereItWasSeenTo) {
  // Beam with ten seats: plain iteration diverges at k = 225e6 N/m with 1e-3 s and at 1e9 N/m with 5e-4 s, and takes 25
  // passes to 1e-6 at 225e6 N/m with 5e-4 s.
  EXPECT_GT(coupler::fixed_point_factor(seat(2.25e8), 1e-3), 1.0);
  EXPECT_GT(coupler::fixed_point_factor(seat(1e9), 5e-4), 1.0);
  const double slow = coupler::fixed_point_factor(seat(2.25e8), 5e-4);
  EXPECT_TRUE(tests::near_rel(std::log(1e-6) / std::log(slow), 24.7, 0.5)) << slow;
  EXPECT_TRUE(tests::near_rel(coupler::fixed_point_factor(seat(2.25e8), coupler::fixed_point_window(seat(2.25e8))), 1.0,
                              1e-12));
}

TEST(Advisor, RefusesWarnsAndStaysSilentAsTheCaseDeserves) {
  const auto axis = [](double damping) {
    auto track = seat(2.25e8);
    track.pad.damping = damping;
    return std::vector<coupler::SeatAxis>{{"seat 'a', normal", track}};
  };
  proto::Coupling coupling;
  coupling.scheme = Scheme::serial_staggered;
  coupling.window_s = 1e-4;
  EXPECT_EQ(coupler::advise(coupling, axis(3e4)).refusal, "");
  EXPECT_NE(coupler::advise(coupling, axis(3e4)).text.find("critical windows on the lumped seat:  E0 "),
            std::string::npos);
  coupling.window_s = 3e-4;
  const auto refused = coupler::advise(coupling, axis(3e4));
  EXPECT_NE(refused.refusal.find("scheme E1 is not stable with windows of 0.0003 s: on seat 'a', normal"),
            std::string::npos)
      << refused.refusal;
  EXPECT_NE(coupler::advise(coupling, axis(0.0)).refusal, "") << "a lag without a dashpot grows with any window";
  coupling.scheme = Scheme::robin_explicit;
  coupling.window_s = 5e-5;
  EXPECT_TRUE(coupler::advise(coupling, axis(3e4)).warnings.empty());
  ASSERT_EQ(coupler::advise(coupling, axis(0.0)).warnings.size(), 1u);
  EXPECT_EQ(coupler::advise(coupling, axis(0.0)).refusal, "");
}

}  // namespace
