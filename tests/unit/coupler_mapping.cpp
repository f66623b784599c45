// Transfer between a participant's own points and the pad's cells: rigid motions, sums, order, degenerate patches, and
// the schemes through it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "coupler/mapping/mapped_side.hpp"
#include "coupler/mapping/patch_map.hpp"
#include "coupler/scheme/coupling_scheme.hpp"
#include "proto/error.hpp"
#include "tests/support/linear_problems.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using coupler::map_patch;
using coupler::Points;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double round_off = 1e-13;

/// Centres of n x m cells of a patch of 0.15 x 0.14 m, `height` above z = 0.
Points grid(int n, int m, double height = 0.0) {
  Points points;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      points.emplace_back(0.075 * ((2 * i + 1.0) / n - 1), 0.07 * ((2 * j + 1.0) / m - 1), height);
  return points;
}

Points scattered(int n, const Vector3d& size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  Points points;
  for (int i = 0; i < n; ++i) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    points.push_back(size.cwiseProduct(Vector3d(x, y, z)));
  }
  return points;
}

Points turned(Points points) {
  const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (auto& point : points) point = turn * point + Vector3d(0.3, -4.0, 2.0);
  return points;
}

VectorXd field(const Points& points, const std::function<Vector3d(const Vector3d&)>& value) {
  VectorXd values(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    values.segment<3>(3 * static_cast<Eigen::Index>(i)) = value(points[i]);
  return values;
}

Vector3d centre_of(const Points& points) {
  Vector3d centre = Vector3d::Zero();
  for (const auto& point : points) centre += point / static_cast<double>(points.size());
  return centre;
}

/// Largest error of the motion (translations of 1, rotations that move the set's edge by some 1) at `to`.
double error(const Points& from, const Points& to, const std::function<Vector3d(const Vector3d&)>& motion) {
  return (map_patch(from, to).matrix * field(from, motion) - field(to, motion)).lpNorm<Eigen::Infinity>();
}

std::function<Vector3d(const Vector3d&)> rotation(const Vector3d& axis, const Vector3d& about) {
  return [axis, about](const Vector3d& point) -> Vector3d { return 10.0 * axis.cross(point - about); };
}

struct Pair {
  const char* name;
  Points from, to;
  friend void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }
};

/// Sets that show all six rigid motions.
std::vector<Pair> pairs() {
  return {{"grids", grid(3, 3), grid(4, 5)},
          {"off_the_plane", grid(4, 3, 0.02), grid(3, 3)},
          {"turned_off_the_plane", turned(grid(4, 3, 0.02)), turned(grid(5, 2))},
          {"volume", scattered(30, {0.07, 0.07, 0.05}, 3), grid(3, 3)},
          {"wavy_plane", scattered(20, {0.07, 0.07, 1e-3}, 4), grid(3, 3, 5e-3)},
          {"three_points", {{0, 0, 0}, {0.1, 0, 0}, {0, 0.07, 0}}, grid(3, 3)},
          {"many", grid(16, 16, 0.01), grid(3, 3)}};
}

class Rigid : public ::testing::TestWithParam<Pair> {};

TEST_P(Rigid, MotionsAndSumsAreKeptToRoundOff) {
  const auto& [name, from, to] = GetParam();
  const auto map = map_patch(from, to);
  EXPECT_EQ(map.n_rigid_motions, 6);
  const Vector3d about = centre_of(to);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(error(from, to, [k](const Vector3d&) { return Vector3d(Vector3d::Unit(k)); }), round_off) << k;
    EXPECT_LT(error(from, to, rotation(Vector3d::Unit(k), about)), round_off) << k;
  }
  // Forces the other way: some of either sign, of size 1.
  const VectorXd forces = VectorXd::LinSpaced(map.matrix.rows(), -1.0, 1.0).array().cos() - 0.8;
  const VectorXd arrived = map.matrix.transpose() * forces;
  Vector3d force = Vector3d::Zero(), moment = force;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Vector3d f = forces.segment<3>(3 * static_cast<Eigen::Index>(i));
    force += f, moment += (to[i] - about).cross(f);
  }
  const double size = forces.lpNorm<1>();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vector3d f = arrived.segment<3>(3 * static_cast<Eigen::Index>(i));
    force -= f, moment -= (from[i] - about).cross(f);
  }
  EXPECT_LT(force.norm(), round_off * size);
  EXPECT_LT(moment.norm(), round_off * size);
}

INSTANTIATE_TEST_SUITE_P(Of, Rigid, ::testing::ValuesIn(pairs()), [](const auto& test) { return test.param.name; });

TEST(PatchMap, LinearFieldsInThePlaneAreExact) {
  const auto strain = [](const Vector3d& p) { return Vector3d(2 * p[0] - p[1], p[0], 3 * p[1]); };
  EXPECT_LT(error(grid(3, 3), grid(5, 4), strain), round_off);
}

TEST(PatchMap, IsAtLeastOfSecondOrderOnRefinedSeats) {
  const auto smooth = [](const Vector3d& p) {
    return Vector3d(std::sin(20 * p[0]) * std::cos(15 * p[1]), std::exp(10 * p[0] - 8 * p[1]), std::cos(25 * p[1]));
  };
  std::vector<double> sizes, errors;
  for (const int n : {4, 8, 16}) {
    sizes.push_back(1.0 / n);
    errors.push_back(error(grid(n, n), grid(n + 1, n - 1), smooth));
    std::printf("%d x %d points: largest error %.3e\n", n, n, errors.back());
  }
  std::printf("order %.2f\n", tests::fitted_order(sizes, errors));
  EXPECT_GE(tests::fitted_order(sizes, errors), 2.0 - 0.15);
}

TEST(PatchMap, OfOnePointCarriesTranslationsAndTheForce) {
  const auto map = map_patch({{0.01, 0.02, 0.0}}, grid(3, 3));
  EXPECT_EQ(map.n_rigid_motions, 3);
  for (Eigen::Index i = 0; i < 9; ++i) EXPECT_TRUE(map.matrix.middleRows<3>(3 * i).isIdentity(round_off));
}

TEST(PatchMap, OfALineCarriesAllButTheTwist) {
  const Points line{{-0.07, 0, 0}, {-0.02, 0, 0}, {0.03, 0, 0}, {0.08, 0, 0}};
  EXPECT_EQ(map_patch(line, grid(3, 3, 0.01)).n_rigid_motions, 5);
  EXPECT_LT(error(line, grid(3, 3, 0.01), rotation(Vector3d::UnitY(), Vector3d::Zero())), round_off);
  EXPECT_LT(error(line, grid(3, 3, 0.01), rotation(Vector3d::UnitZ(), Vector3d::Zero())), round_off);
  EXPECT_GT(error(line, grid(3, 3, 0.01), rotation(Vector3d::UnitX(), Vector3d::Zero())), 0.1);
  // On the line itself a twist moves nothing.
  EXPECT_EQ(map_patch(line, {{0.0, 0, 0}, {0.05, 0, 0}}).n_rigid_motions, 6);
}

TEST(PatchMap, RefusesAPointThatIsThereTwice) {
  auto points = grid(3, 2);
  points.push_back(points[4]);
  try {
    map_patch(points, grid(3, 3));
    FAIL();
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
    EXPECT_NE(std::string(error.what()).find("points 4 and 6 lie at the same place"), std::string::npos);
  }
}

// The plate of linear_problems.hpp: 4 x 4 points of the rail, off the plane of 3 x 3 cells.

proto::RailSeat plate_seat() {
  proto::RailSeat seat;
  seat.name = "seat0";
  seat.origin = Vector3d::Zero();
  seat.axes = Matrix3d::Identity();
  seat.half_lengths = {0.1, 0.1};
  seat.cells = {3, 3};
  return seat;
}

coupler::PadMap plate_map(const tests::LinearProblem& problem) {
  proto::SeatRegistration r;
  r.own_points = true;
  for (const auto& point : problem.rail_points) r.points.insert(r.points.end(), point.data(), point.data() + 3);
  return *coupler::map_to_pad("fem", {{}, {r}}, {plate_seat()});
}

/// Normal components of the operator, [cells][points].
MatrixXd normal_map(const coupler::PadMap& map, Eigen::Index cells, Eigen::Index points) {
  const auto all = map.pad_map();
  MatrixXd result(cells, points);
  for (Eigen::Index i = 0; i < cells; ++i)
    for (Eigen::Index j = 0; j < points; ++j)
      result(i, j) = all.at(static_cast<std::size_t>((3 * i + 2) * 3 * points + 3 * j + 2));
  return result;
}

/// Error of the motion at the cells at the end against the matrix exponential; the rail's pad has `rail_map`.
double end_error(const tests::LinearProblem& p, proto::Scheme name, const MatrixXd& rail_map, int n_windows) {
  const auto map = plate_map(p);
  proto::Coupling coupling;
  coupling.iteration.force_tolerance = coupling.iteration.displacement_tolerance = 1e-12;
  tests::LinearRail rail(p.rail, {p.laws(), rail_map});
  tests::LinearSleeper sleeper(p.sleeper, p.laws());
  coupler::MappedSide mapped(rail, map);
  std::vector<proto::PadLaw> laws;
  for (const auto& law : p.laws()) laws.insert(laws.end(), {proto::PadLaw{}, proto::PadLaw{}, law});
  const double h = p.end_time / n_windows;
  auto scheme = coupler::make_scheme(name, coupling, {h, 4, laws});
  const auto start = coupler::at_cells(map, rail.motion()), foot = sleeper.motion();
  scheme->start({start.get(proto::field::rail_displacement), start.get(proto::field::rail_velocity),
                 foot.get(proto::field::sleeper_displacement), foot.get(proto::field::sleeper_velocity)});
  for (int n = 0; n < n_windows; ++n) {
    scheme->advance(proto::Phase::march, n, {mapped, sleeper});
    scheme->commit(n, {mapped, sleeper});
  }
  VectorXd state(2 * (16 + 9));
  state << rail.body().q, sleeper.body().q, rail.body().v, sleeper.body().v;
  const MatrixXd exact_map = normal_map(map, 9, 16);
  const VectorXd exact = tests::exact_motion(p, exact_map, p.end_time);
  return (tests::at_cells(p, exact_map, state) - exact).norm() / exact.norm();
}

TEST(MappedSide, SchemesKeepTheirOrder) {
  const auto p = tests::plate(true);
  const auto map = normal_map(plate_map(p), 9, 16);
  for (const auto scheme : {proto::Scheme::robin_explicit, proto::Scheme::robin_corrected, proto::Scheme::implicit}) {
    std::vector<double> steps, errors;
    for (const int n : {160, 320, 640}) {
      steps.push_back(1.0 / n);
      errors.push_back(end_error(p, scheme, map, n));
    }
    std::printf("%s: order %.3f, error %.2e\n", proto::name_of(scheme).c_str(), tests::fitted_order(steps, errors),
                errors.back());
    EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.15)) << proto::name_of(scheme);
  }
}

TEST(MappedSide, ARailWithAnotherOperatorInItsPadDoesNotConverge) {
  const auto p = tests::plate(true);
  MatrixXd nearest = MatrixXd::Zero(9, 16);
  for (Eigen::Index c = 0; c < 9; ++c) nearest(c, 4 * (c / 3 + (c / 3 > 1)) + c % 3 + (c % 3 > 1)) = 1.0;
  const double coarse = end_error(p, proto::Scheme::robin_explicit, nearest, 160),
               fine = end_error(p, proto::Scheme::robin_explicit, nearest, 640);
  std::printf("error %.2e, with a quarter of the window %.2e\n", coarse, fine);
  EXPECT_GT(fine, 0.01);
  EXPECT_GT(fine, 0.8 * coarse) << "it falls with the window";
}

TEST(MappedSide, GivenForcesAndMotionsDoTheSameWorkAtPointsAndCells) {
  const auto p = tests::plate(true);
  const auto map = plate_map(p);
  std::vector<double> motion, force;
  for (int i = 0; i < 48; ++i) motion.push_back(std::sin(1.0 + i));
  for (int i = 0; i < 27; ++i) force.push_back(std::cos(2.0 * i));
  const auto cells = map.to_cells(motion), points = map.to_points(force);
  double at_cells = 0.0, at_points = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) at_cells += force[i] * cells[i];
  for (std::size_t i = 0; i < points.size(); ++i) at_points += points[i] * motion[i];
  EXPECT_TRUE(tests::near_abs(at_points, at_cells, 1e-12));
  EXPECT_THROW(map.to_cells(force), proto::Error);
}

/// Loads itself by something else than the force that it was given.
struct Disobedient : coupler::Side {
  proto::Result advance(const proto::Advance& request) override {
    proto::Result result;
    auto used = request.data.get(proto::field::force_mean);
    used[2] *= 1.001;
    result.data.set(proto::field::force_used, used);
    return result;
  }
  void rollback(const proto::Rollback&) override {}
  void commit(const proto::Commit&) override {}
};

TEST(MappedSide, NamesARailThatTookAnotherForce) {
  Disobedient rail;
  coupler::MappedSide mapped(rail, plate_map(tests::plate(true)));
  proto::Advance request;
  request.data.set(proto::field::force_mean, std::vector<double>(27, 1.0));
  EXPECT_THROW(mapped.advance(request), proto::Error);
}

}  // namespace
