// V7: free vibration of a ball and of a cube of rock.
//
// Ball: closed form of Lamb, "On the vibrations of an elastic sphere", Proc. London Math. Soc. 13 (1882); also Love,
// A Treatise on the Mathematical Theory of Elasticity (1927), art. 194-195.
#include <gtest/gtest.h>

#include "tests/support/ball_mesh.hpp"
#include "tests/support/free_modes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tests::near_rel;

constexpr double radius = 0.025;

/// omega a / (pi c_s) of the gravest torsional and spheroidal mode of order two, and omega a / (pi c_p) of the radial
/// mode, for nu = 1/4: his .7961, .840 and .8160, with more digits from his equations.
constexpr double lamb_torsional = 0.796135, lamb_spheroidal = 0.840297, lamb_radial = 0.815966;

double wave_frequency(double modulus) {  // c / (2 a)
  return std::sqrt(modulus / tests::rock().density) / (2 * radius);
}
double shear_frequency() {
  return wave_frequency(tests::rock().mu());
}
double radial_frequency() {
  return lamb_radial * wave_frequency(tests::rock().lambda() + 2 * tests::rock().mu());
}

qdem::Model ball(int layers) {
  const auto mesh = tests::ball_mesh(layers, radius);
  return tests::free_bodies(qdem::make_template("ball", mesh.nodes, mesh.tets), tests::rock());
}

double j1(double x) {
  return (std::sin(x) / x - std::cos(x)) / x;
}
double j2(double x) {
  return 3 * j1(x) / x - std::sin(x) / x;
}

template <class Function>
double slope(Function f, double x) {
  const double d = 1e-4 * x;
  return (f(x + d) - f(x - d)) / (2 * d);
}

/// u = j_1(h r) r / |r|, h a = 0.816 pi.
Vector3d radial_mode(const Vector3d& p) {
  const double r = p.norm();
  return j1(lamb_radial * M_PI * r / radius) / r * p;
}

/// The five surface harmonics of order two, Y = n^T Q n of the direction n.
std::array<Matrix3d, 5> harmonics() {
  std::array<Matrix3d, 5> q;
  for (auto& matrix : q) matrix.setZero();
  for (int i = 0; i < 3; ++i) q[i](i, (i + 1) % 3) = q[i]((i + 1) % 3, i) = 1;
  q[3].diagonal() << 1, -1, 0;
  q[4].diagonal() << -1, -1, 2;
  return q;
}

/// u = j_2(k r) grad(Y) x r.
struct TorsionalMode {
  Matrix3d q;
  Vector3d operator()(const Vector3d& p) const {
    const double r = p.norm();
    return j2(lamb_torsional * M_PI * r / radius) / (r * r) * (q * p).cross(p);
  }
};

/// u = grad(j_2(h r) Y) + c curl curl(r j_2(k r) Y), c such that the surface bears no shear.
class SpheroidalMode {
 public:
  explicit SpheroidalMode(const Matrix3d& q) : q_(q) {
    const double none = surface_shear(0.0), one = surface_shear(1.0);
    weight_ = none / (none - one);
  }
  Vector3d operator()(const Vector3d& p) const {
    const double r = p.norm(), y = p.dot(q_ * p) / (r * r);
    const Vector3d gradient = 2 / r * (q_ * p - y * p);  // r grad Y
    return radius * (radially(r) * y / r * p + along(r) * gradient);
  }

 private:
  static double k() { return lamb_spheroidal * M_PI / radius; }
  static double h() { return k() * std::sqrt(1.0 / 3); }  // c_s / c_p for nu = 1/4
  double radially(double r) const {
    return slope([](double s) { return j2(h() * s); }, r) + 6 * weight_ * j2(k() * r) / r;
  }
  double along(double r) const {
    return (j2(h() * r) + weight_ * slope([](double s) { return s * j2(k() * s); }, r)) / r;
  }
  double surface_shear(double weight) {
    weight_ = weight;
    return slope([this](double r) { return along(r); }, radius) + (radially(radius) - along(radius)) / radius;
  }

  Matrix3d q_;
  double weight_ = 0.0;
};

template <class Field>
double free_frequency(const qdem::Model& model, Field field, double about) {
  tests::MotionShape shape;
  for (const Vector3d& node : model.shape(0).nodes) {
    shape.push_back(node.norm() > 0 ? field(node) : Vector3d(Vector3d::Zero()));
  }
  return tests::frequency(tests::vibration(model, shape, 1.3 / about, 0.9));
}

/// Values that close in on `target` from mesh to mesh, the last within 5 %, and in the end with the square of the
/// element size.
void expect_convergence(const char* name, const std::vector<double>& sizes, const std::vector<double>& values,
                        double target) {
  std::vector<double> errors;
  for (const double value : values) errors.push_back(std::abs(value - target));
  const std::vector<double> last_sizes(sizes.end() - 2, sizes.end()), last_errors(errors.end() - 2, errors.end());
  std::cout << name << ":";
  for (const double value : values) std::cout << ' ' << value;
  std::cout << " Hz, closed form " << target << ", order " << tests::fitted_order(last_sizes, last_errors) << "\n";
  EXPECT_TRUE(std::is_sorted(errors.rbegin(), errors.rend())) << name;
  EXPECT_TRUE(near_rel(values.back(), target, 0.05)) << name;
  EXPECT_TRUE(tests::converges_with_order(last_sizes, last_errors, 2.0, 0.3)) << name;
}

}  // namespace

TEST(V7, FreeBallConvergesToLamb) {
  const double torsional = lamb_torsional * shear_frequency(), spheroidal = lamb_spheroidal * shear_frequency();
  std::vector<double> sizes, t2, s2, s0;
  for (const int layers : {6, 8, 12, 16, 20}) {
    const auto model = ball(layers);
    sizes.push_back(radius / layers);
    t2.push_back(0), s2.push_back(0);
    for (const Matrix3d& q : harmonics()) {
      t2.back() += free_frequency(model, TorsionalMode{q}, torsional) / 5;
      s2.back() += free_frequency(model, SpheroidalMode(q), spheroidal) / 5;
    }
    s0.push_back(free_frequency(model, radial_mode, radial_frequency()));
  }
  expect_convergence("torsional T2", sizes, t2, torsional);
  expect_convergence("spheroidal S2", sizes, s2, spheroidal);
  expect_convergence("radial S0", sizes, s0, radial_frequency());
}

TEST(V7, FreeCubePerMesh) {
  // Lowest mode [Hz] of a cube of 50 mm by number of bricks along its edge: the assembled linear elements with lumped
  // masses by an eigen-solver that shares no code with the solver.
  constexpr std::pair<int, double> table[] = {{2, 29.56e3}, {4, 29.13e3}, {6, 28.28e3}, {8, 27.85e3}, {12, 27.47e3}};
  for (const auto& [n, expected] : table) {
    const auto model = tests::free_bodies(tests::box_template({n, n, n}, Vector3d::Constant(0.05)), tests::rock());
    const auto mode = tests::free_modes(model.shape(0), model.materials[0], 1, expected).front();
    const double found = tests::frequency(tests::vibration(model, mode.shape, 1.3 / mode.frequency, 0.2));
    std::cout << n << " along the edge: " << found << " Hz (" << expected << ")\n";
    EXPECT_TRUE(near_rel(found, expected, 0.005));
  }
}
