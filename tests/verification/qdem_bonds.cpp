// Ordinary DEM for comparison: two-particle Voigt bonds. What they keep (momenta, E, the Voigt model in one dimension)
// and what they do not (Poisson's ratio, bulk and shear modulus), against quadruples in the same specimens.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>

#include "qdem_solver/engine/stress.hpp"
#include "qdem_solver/model/bond_network.hpp"
#include "tests/support/loaded_box.hpp"
#include "tests/support/particle_forces.hpp"
#include "tests/support/tolerance.hpp"

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tests::bonded;
using tests::near_abs;
using tests::near_rel;

namespace {

constexpr double cell = 0.01, distortion = 2e-3;  ///< [m]
const Matrix3d tension = 1e6 * Vector3d::UnitX() * Vector3d::UnitX().transpose();

qdem::Material bonded_rock(double tau = 0.0) {
  return bonded(tests::with_retardation(tests::rock(), tau));
}

Matrix3d some_rotation() {
  return Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

/// Volume mean of the elements' stress [Pa].
Matrix3d mean_stress(const tests::LoadedBox& box) {
  const auto& shape = box.model().shape(0);
  Matrix3d sum = Matrix3d::Zero();
  for (int e = 0; e < shape.n_tets(); ++e) {
    sum += shape.volumes[e] / shape.volume() * qdem::element_stress(box.model(), box.state(), 0, e);
  }
  return sum;
}

/// A body alone and one in lanes: both loops over elements are met.
std::vector<qdem::Model> alone_and_in_lanes(const qdem::Material& material) {
  const auto shape = tests::box_template({3, 2, 2}, {0.06, 0.04, 0.04}, 2e-3);
  return {tests::free_bodies(shape, material, 1), tests::free_bodies(shape, material, 3)};
}

}  // namespace

TEST(Bonds, OneForEveryEdgeOfTheTetrahedra) {
  const auto shape = tests::box_template({3, 2, 2}, {0.06, 0.04, 0.04}, 2e-3);
  const auto bonds = qdem::make_bond_network(shape);
  // Euler's formula of a ball: nodes - edges + faces - tetrahedra = 1, with 4 t = 2 faces - skin.
  const int faces = (4 * shape.n_tets() + static_cast<int>(shape.triangles.size())) / 2;
  EXPECT_EQ(static_cast<int>(bonds.nodes.size()), shape.n_nodes() + faces - shape.n_tets() - 1);
  double shares = 0.0, weights = 0.0;
  for (int e = 0; e < shape.n_tets(); ++e) shares += 6 * bonds.calibration * qdem::bond_share(shape, e);
  for (const double stiffness : bonds.stiffness) weights += stiffness;
  EXPECT_TRUE(near_rel(weights, shares, 1e-12));
}

TEST(Bonds, ForcesHaveNoResultantAndNoMoment) {
  for (const auto& model : alone_and_in_lanes(bonded_rock(1e-7))) {
    Matrix3d f = some_rotation();
    f.row(1) *= 1.02;
    qdem::State state = qdem::make_state(model, std::vector<qdem::Placement>(model.bodies.size(), {f, {0.3, 0, 0}}));
    for (std::size_t i = 0; i < state.v.size(); ++i) state.v[i] = std::sin(1.7 * static_cast<double>(i));
    Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
    double size = 0.0;
    const auto found = tests::forces(model, state);
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
      sum += found[i], size += found[i].norm();
      moment += (state.position(model, 0, i) - Vector3d(0.3, 0, 0)).cross(found[i]);
    }
    ASSERT_GT(size, 1e4);
    EXPECT_LT(sum.norm(), 1e-14 * size);
    EXPECT_LT(moment.norm(), 1e-14 * size * 0.06);
  }
}

TEST(Bonds, RigidMotionGivesNoForce) {
  for (const auto& model : alone_and_in_lanes(bonded_rock(1e-7))) {
    const qdem::Placement place{some_rotation(), {0.3, -0.2, 0.1}};
    qdem::State state = qdem::make_state(model, std::vector<qdem::Placement>(model.bodies.size(), place));
    const Vector3d spin(300, -200, 500), speed(3, 4, -5);
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
      qdem::State::scatter(model, state.v, 0, i, speed + spin.cross(state.position(model, 0, i)));
    }
    // As for quadruples: the stress that round-off makes, on a face of the mesh.
    const double face = 0.02 * 0.02, round_off = (60e9 + 6e3 * spin.norm()) * 1e-15 * face * 100;
    for (const Vector3d& force : tests::forces(model, state)) EXPECT_LT(force.norm(), round_off);
  }
}

TEST(Bonds, MirroredCubesAreAnIsotropicLattice) {
  // C = sum k L^2 n n n n / V of an even number of cubes, before the skin makes it softer.
  const auto shape = tests::box_template({4, 4, 4}, Vector3d::Constant(0.04), 0.0, tests::Cut::mirrored);
  const auto bonds = qdem::make_bond_network(shape);
  const auto modulus = [&](int i, int j, int k, int l) {
    double sum = 0.0;
    for (std::size_t b = 0; b < bonds.nodes.size(); ++b) {
      const Vector3d d = shape.nodes[bonds.nodes[b][1]] - shape.nodes[bonds.nodes[b][0]];
      sum += bonds.stiffness[b] / bonds.calibration * d[i] * d[j] * d[k] * d[l] / d.squaredNorm() / shape.volume();
    }
    return sum;
  };
  // lambda = mu = 0.4 E: E and nu = 1/4.
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    EXPECT_TRUE(near_abs(modulus(i, i, i, i), 1.2, 1e-12));
    EXPECT_TRUE(near_abs(modulus(i, i, j, j), 0.4, 1e-12));
    EXPECT_TRUE(near_abs(modulus(i, i, i, j), 0.0, 1e-12));
    EXPECT_TRUE(near_abs(modulus(i, i, j, k), 0.0, 1e-12));
  }
}

TEST(Bonds, SpecimenAnswersWithYoungsModulus) {
  for (const double amount : {0.0, distortion}) {
    for (const int n : {2, 4}) {
      const Vector3d size(12 * cell, n * cell, n * cell);
      tests::LoadedBox bar({12, n, n}, size, amount, bonded_rock(), tension);
      bar.come_to_rest();
      const double strain = bar.strain()(0, 0);
      std::printf("%d x %d cells, moved by %.0f %%: E %.5f of the wanted one, nu %.3f, calibration %.3f\n", n, n,
                  100 * amount / cell, tension(0, 0) / strain / 60e9, -bar.strain()(1, 1) / strain,
                  bar.model().shape(0).bonds->calibration);
      EXPECT_TRUE(near_rel(tension(0, 0) / strain, 60e9, 0.01));
      // Clapeyron: the energy is half the work of the tension; and the mean stress is the tension.
      EXPECT_TRUE(near_rel(bar.strain_energy(), 0.5 * tension(0, 0) * strain * size.prod(), 1e-3));
      EXPECT_LT((mean_stress(bar) - tension).norm(), 1e-3 * tension.norm());
    }
  }
}

TEST(Bonds, BarCreepsAsAVoigtModel) {
  const Vector3d size(12 * cell, 2 * cell, 2 * cell);
  const double tau = 5 * size[0] / std::sqrt(60e9 / 2700);  // inertia is over long before
  tests::LoadedBox bar({12, 2, 2}, size, distortion, bonded_rock(tau), tension);
  const double final_strain = tension(0, 0) / 60e9;
  const auto n_steps = static_cast<std::int64_t>(std::ceil(0.5 * tau / bar.stable_step()));
  for (int half = 1; half <= 8; ++half) {
    bar.advance(0.5 * tau / static_cast<double>(n_steps), n_steps);
    const double expected = final_strain * (1 - std::exp(-0.5 * half));
    std::printf("t = %.1f tau: strain %.4f of s/E, Voigt %.4f\n", 0.5 * half, bar.strain()(0, 0) / final_strain,
                expected / final_strain);
    EXPECT_TRUE(near_abs(bar.strain()(0, 0), expected, 0.01 * final_strain));
  }
}

namespace {

/// Of one specimen; moduli over what was asked for.
struct Constants {
  double young, poisson, bulk, shear;
};

Matrix3d strain_under(const Matrix3d& stress, const qdem::Material& material) {
  tests::LoadedBox box({12, 4, 4}, {12 * cell, 4 * cell, 4 * cell}, distortion, material, stress);
  box.come_to_rest();
  return box.strain();
}

Constants measured(const qdem::Material& m) {
  const double size = 1e6;
  const Matrix3d pulled = strain_under(tension, m), swollen = strain_under(size * Matrix3d::Identity(), m);
  Matrix3d shear = Matrix3d::Zero();
  shear(0, 1) = shear(1, 0) = size;
  const Matrix3d sheared = strain_under(shear, m);
  const double bulk = m.young / (3 * (1 - 2 * m.poisson));
  return {tension(0, 0) / pulled(0, 0) / m.young, -(pulled(1, 1) + pulled(2, 2)) / (2 * pulled(0, 0)),
          size / swollen.trace() / bulk, size / (2 * sheared(0, 1)) / m.mu()};
}

Constants print(const char* law, double asked, const Constants& found) {
  std::printf("%-10s nu asked %.2f: E %.4f, nu %.4f, K %.4f, G %.4f\n", law, asked, found.young, found.poisson,
              found.bulk, found.shear);
  return found;
}

}  // namespace

TEST(Bonds, HaveAPoissonsRatioOfTheirOwnAndQuadruplesTheOneAskedFor) {
  constexpr double allowed = 0.01;
  std::vector<Constants> lattices;
  for (const double asked : {0.1, 0.35}) {
    qdem::Material rock = tests::rock();
    rock.poisson = asked;
    const Constants solid = print("quadruple", asked, measured(rock));
    EXPECT_TRUE(near_rel(solid.young, 1, allowed));
    EXPECT_TRUE(near_rel(solid.poisson, asked, allowed));
    EXPECT_TRUE(near_rel(solid.bulk, 1, allowed));
    EXPECT_TRUE(near_rel(solid.shear, 1, allowed));
    const Constants lattice = print("bond", asked, measured(bonded(rock)));
    EXPECT_TRUE(near_rel(lattice.young, 1, allowed));
    EXPECT_FALSE(near_rel(lattice.poisson, asked, allowed));
    EXPECT_FALSE(near_rel(lattice.bulk, 1, allowed));
    EXPECT_FALSE(near_rel(lattice.shear, 1, allowed));
    lattices.push_back(lattice);
  }
  // Bonds do not know what was asked for: one ratio, and moduli that differ as those asked for do.
  EXPECT_EQ(lattices[0].poisson, lattices[1].poisson);
  EXPECT_TRUE(near_rel(lattices[0].bulk / (1 - 2 * 0.1), lattices[1].bulk / (1 - 2 * 0.35), 1e-12));
  EXPECT_TRUE(near_rel(lattices[0].shear / (1 + 0.1), lattices[1].shear / (1 + 0.35), 1e-12));
}
