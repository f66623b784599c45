// The profile's figures and the operator from the rail foot to the pad cells.
#include <Eigen/Geometry>
#include <memory>

#include "fem_solver/assembly/cell_operator.hpp"
#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/contact/head_band.hpp"
#include "proto/error.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

// physics.md 2.2, UIC60.
TEST(RailSection, uic60_within_one_percent) {
  const fem::SectionProperties p = fem::rail_section("60E1").properties();
  EXPECT_TRUE(near_rel(p.area, 76.70e-4, 0.01));
  EXPECT_TRUE(near_rel(p.inertia_vertical, 3.037e-5, 0.01));
  EXPECT_TRUE(near_rel(p.inertia_lateral, 5.127e-6, 0.01));
  EXPECT_TRUE(near_rel(p.area * fem::Material{}.density, 60.2, 0.01));
}

TEST(RailSection, locates_points_and_refuses_others) {
  const fem::RailSection s = fem::rail_section("60E1");
  for (std::size_t q = 0; q < s.quads.size(); ++q) {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const int v : s.quads[q]) centre += s.vertices[v] / 4;
    const auto place = s.locate(centre);
    EXPECT_EQ(place.quad, static_cast<int>(q));
    EXPECT_TRUE(near_abs(place.local[0], 0.5, 1e-9));
  }
  EXPECT_THROW(s.locate({0.05, 0.08}), proto::Error);
  EXPECT_THROW(fem::rail_section("60E9"), proto::Error);
}

enum class Kind { solid, beam };

class Cells : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    const auto section = fem::rail_section("60E1");
    const std::vector<double> planes{-.45, -.3, -.15, 0, .15, .3, .45};
    if (GetParam() == Kind::solid)
      rail_ = std::make_unique<fem::RailMesh>(section, planes, 0.7535);
    else
      rail_ = std::make_unique<fem::BeamKinematics>(section, fem::Material{}, fem::RailPlanes{planes, 4, 0.15}, 0.7535);
    seats_ = {tests::rail_seat(0.0), tests::rail_seat(0.21)};
    // The second one stands askew and has cells of its own.
    seats_[1].axes = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    seats_[1].half_lengths = {0.06, 0.06};
    seats_[1].cells = {2, 4};
  }
  std::unique_ptr<fem::RailKinematics> rail_;
  std::vector<proto::RailSeat> seats_;
};
INSTANTIATE_TEST_SUITE_P(solid_and_beam, Cells, ::testing::Values(Kind::solid, Kind::beam));

TEST_P(Cells, rigid_motions_and_resultants_are_exact) {
  const auto registered = fem::CellOperator(*rail_, seats_).registration(*rail_, seats_);
  ASSERT_EQ(registered.size(), 2u);
  for (std::size_t s = 0; s < seats_.size(); ++s) {
    const auto& seat = seats_[s];
    const int n = 3 * seat.n_cells();
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d axis = seat.axes.col(i % 3), arm = seat.cell_point(i / 3) - seat.origin;
      for (int mode = 0; mode < 6; ++mode) {
        const Eigen::Vector3d unit = Eigen::Vector3d::Unit(mode % 3);
        const Eigen::Vector3d motion = mode < 3 ? unit : Eigen::Vector3d(unit.cross(arm));
        EXPECT_TRUE(near_abs(registered[s].rigid_response[mode * n + i], axis.dot(motion), 1e-12));
        const Eigen::Vector3d moment = arm.cross(axis);
        EXPECT_TRUE(
            near_abs(registered[s].force_resultants[6 * i + mode], mode < 3 ? axis[mode] : moment[mode - 3], 1e-12));
      }
    }
  }
}

TEST_P(Cells, a_pad_wider_than_the_foot_is_refused) {
  auto seats = seats_;
  seats[0].half_lengths[1] = 0.09;
  EXPECT_THROW(fem::CellOperator(*rail_, seats), proto::Error);
}

TEST(HeadBand, weights_sum_to_one_and_reproduce_the_place) {
  const auto system = fem::build_rail_system(tests::small_track(), {tests::rail_seat(0.0)}, fem::SeatOwner::partner);
  const fem::HeadBand band(system);
  Eigen::VectorXd one = Eigen::VectorXd::Ones(system.n_dofs()), ramp = one;
  for (int n = 0; n < system.mesh->n_nodes(); ++n) ramp[3 * n + 2] = system.mesh->nodes()[n][0];
  for (const double x : {-0.31, 0.0, 0.07, 0.075, 0.149}) {
    EXPECT_TRUE(near_abs(band.read(band.at(x), one), 1.0, 1e-12));
    EXPECT_TRUE(near_abs(band.read(band.at(x), ramp), x, 1e-12));
    Eigen::VectorXd load = Eigen::VectorXd::Zero(system.n_dofs());
    band.add_load(band.at(x), -5.0, load);
    EXPECT_TRUE(near_abs(load.dot(ramp), -5.0 * x, 1e-11));
  }
  EXPECT_THROW(band.at(3.2), proto::Error);
}

TEST(BeamBand, weights_reproduce_deflection_and_slope) {
  const fem::BeamRail rail(tests::small_track(), {tests::rail_seat(0.0)}, fem::SeatOwner::partner);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(rail.track().n_dofs()), turn = shift;
  const Eigen::MatrixXd rigid = rail.kinematics().rigid_motions(Eigen::Vector3d::Zero());
  shift.head(rigid.rows()) = rigid.col(2), turn.head(rigid.rows()) = rigid.col(4);
  for (const double x : {-0.31, 0.0, 0.07, 0.149}) {
    const auto place = rail.band().at(x);
    EXPECT_TRUE(near_abs(rail.band().read(place, shift), 1.0, 1e-12));
    EXPECT_TRUE(near_abs(rail.band().read(place, turn), -x, 1e-12));
    Eigen::VectorXd load = Eigen::VectorXd::Zero(rail.track().n_dofs());
    rail.band().add_load(place, -5.0, load);
    EXPECT_TRUE(near_abs(load.dot(turn), 5.0 * x, 1e-11));
  }
  EXPECT_THROW(rail.band().at(3.2), proto::Error);
}

TEST(RailSystem, refuses_a_seat_between_the_sleepers) {
  EXPECT_THROW(fem::build_rail_system(tests::small_track(), {tests::rail_seat(0.25)}, fem::SeatOwner::partner),
               proto::Error);
  EXPECT_THROW(fem::build_rail_system(tests::small_track(), {tests::rail_seat(6.0)}, fem::SeatOwner::partner),
               proto::Error);
}

}  // namespace
