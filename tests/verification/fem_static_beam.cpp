// Static deflection of the rail against an independent Timoshenko beam on the same discrete supports.
#include <cmath>
#include <cstdio>

#include "fem_solver/contact/head_band.hpp"
#include "fem_solver/time/statics.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/timoshenko_beam.hpp"
#include "tests/support/tolerance.hpp"

namespace {

constexpr double load = 80e3;  // [N]

// UIC60 of physics.md 2.2; steel as in the settings.
tests::TimoshenkoBeam uic60(const fem::RailSystem& system, const fem::FemSettings& s) {
  const double shear_modulus = s.material.young / (2 * (1 + s.material.poisson));
  const auto& x = system.mesh->planes();
  tests::TimoshenkoBeam beam(x.front(), x.back(), 6 * (static_cast<int>(x.size()) - 1), s.material.young * 3.037e-5,
                             0.393 * shear_modulus * 76.70e-4);
  const double pad = s.support.pad_stiffness[2], ballast = s.support.ballast_stiffness[2];
  // Three rows of cells along the rail, as the pads of the rail have: a pad of finite length resists rotation.
  for (const auto& seat : system.support_seats) {
    const double x0 = seat.origin[0], row = 2 * seat.half_lengths[0] / 3;
    beam.add_pad({x0 - row, x0, x0 + row}, pad / 3, ballast);
  }
  return beam;
}

class StaticBeam : public ::testing::TestWithParam<double> {
 protected:
  static void SetUpTestSuite() {
    settings_ = tests::small_track();
    system_ = std::make_unique<fem::RailSystem>(
        fem::build_rail_system(settings_, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports));
    band_ = std::make_unique<fem::HeadBand>(*system_);
    statics_ = std::make_unique<fem::Statics>(*system_, *band_);
  }
  static void TearDownTestSuite() { statics_.reset(), band_.reset(), system_.reset(); }

  static double centroid(const Eigen::VectorXd& u, double x) {
    const auto& planes = system_->mesh->planes();
    const auto mean =
        system_->mesh->section_mean(static_cast<int>(std::lround((x - planes.front()) / system_->element_length)));
    double value = 0.0;
    for (std::size_t k = 0; k < mean.nodes.size(); ++k) value += mean.weights[k] * u[3 * mean.nodes[k] + 2];
    return value;
  }

  static fem::FemSettings settings_;
  static std::unique_ptr<fem::RailSystem> system_;
  static std::unique_ptr<fem::HeadBand> band_;
  static std::unique_ptr<fem::Statics> statics_;
};
fem::FemSettings StaticBeam::settings_;
std::unique_ptr<fem::RailSystem> StaticBeam::system_;
std::unique_ptr<fem::HeadBand> StaticBeam::band_;
std::unique_ptr<fem::Statics> StaticBeam::statics_;

TEST_P(StaticBeam, centroid_deflection_within_3_percent) {
  const double x = GetParam();
  const auto u = statics_->solve({}, Eigen::VectorXd(), band_->at(x), load).displacement;
  const double fem_deflection = -centroid(u, x);
  const auto beam = uic60(*system_, settings_);
  const double target = beam.deflection(x, load)[beam.node(x)];
  const double foundation = 90e6 / settings_.sleeper_spacing;
  const double lambda = std::pow(foundation / (4 * settings_.material.young * 3.037e-5), 0.25);
  std::printf("x = %.2f m: FEM %.4f mm, Timoshenko %.4f mm (%+.2f %%), Winkler %.4f mm; unknowns %d\n", x,
              fem_deflection * 1e3, target * 1e3, (fem_deflection / target - 1) * 100,
              load * lambda / (2 * foundation) * 1e3, system_->n_dofs());
  EXPECT_TRUE(tests::near_rel(fem_deflection, target, 0.03));
}
INSTANTIATE_TEST_SUITE_P(seat_and_mid_bay, StaticBeam, ::testing::Values(0.0, 0.3));

}  // namespace
