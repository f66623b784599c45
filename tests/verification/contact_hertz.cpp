// V11: elastic balls that are pressed on a rigid plane, or on each other, against Hertz (Johnson, Contact Mechanics,
// 1985, ch. 4): approach, contact radius and largest pressure for the force that is found.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/ball_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;

constexpr double radius = 25e-3, approach = 9e-4 * radius;  ///< of a ball to the plane of contact: a = 0.03 R
constexpr double draw = 0.9, drawn_scale = (1 - draw) / (1 + draw);
constexpr double held_from = -0.3 * radius;  ///< z: from there on the ball is held; elements are coarse there

/// A conformal map of the unit ball onto itself (Moebius): elements keep their shape and get smaller towards -z, by
/// drawn_scale at the pole.
Vector3d drawn(const Vector3d& x) {
  const Vector3d a(0, 0, -draw);
  const double xa = x.dot(a), xx = x.squaredNorm(), aa = draw * draw;
  return ((1 + 2 * xa + xx) * a + (1 - aa) * x) / (1 + 2 * xa + aa * xx);
}

/// The quarter x, y >= 0 of a ball about the origin.
qdem::Template quarter_ball(int layers) {
  const tests::Mesh ball = tests::ball_mesh(layers, 1.0);
  tests::Mesh quarter;
  std::vector<int> ids(ball.nodes.size(), -1);
  for (const auto& tet : ball.tets) {
    Vector3d middle = Vector3d::Zero();
    for (const int node : tet) middle += ball.nodes[node];
    if (middle[0] < 0 || middle[1] < 0) continue;
    std::array<int, 4> corners;
    for (int k = 0; k < 4; ++k) {
      int& id = ids[tet[k]];
      if (id < 0)
        id = static_cast<int>(quarter.nodes.size()), quarter.nodes.push_back(radius * drawn(ball.nodes[tet[k]]));
      corners[k] = id;
    }
    quarter.tets.push_back(corners);
  }
  return qdem::make_template("quarter ball", quarter.nodes, quarter.tets);
}

/// What Hertz's theory says for a force, and what is found.
struct Figures {
  double approach = 0.0, contact_radius = 0.0, pressure = 0.0;
  Figures over(const Figures& other) const {
    return {approach / other.approach, contact_radius / other.contact_radius, pressure / other.pressure};
  }
};

Figures hertz(double force, double modulus, double relative_radius) {
  const double a = std::cbrt(3 * force * relative_radius / (4 * modulus));
  return {a * a / relative_radius, a, 3 * force / (2 * M_PI * a * a)};
}

/// Ball 0 stands above z = 0 and comes down by `approach`; ball 1, if there is one, is its image in z = 0.
class PressedBall {
 public:
  PressedBall(int layers, bool on_another)
      : model_(tests::free_bodies(quarter_ball(layers), tests::rock(), on_another ? 2 : 1)) {
    const double edge = drawn_scale * radius / layers, modulus = reduced_modulus();
    model_.contact = {10 * modulus * edge, 0.8, 0.0, 0.0, 0.3 * edge};
    if (on_another) {
      model_.contact.shape = qdem::ContactShape::sphere;
    } else {
      model_.planes.push_back({"plane", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.0});
    }
    model_.local_damping = 0.3;
    hold();
    const double height = radius + model_.contact.rounding - approach;
    Eigen::Matrix3d image = Eigen::Matrix3d::Identity();  // a half turn about x = y changes the quarter's sides
    image << 0, 1, 0, 1, 0, 0, 0, 0, -1;
    std::vector<qdem::Placement> places{{Eigen::Matrix3d::Identity(), {0, 0, height}}};
    if (on_another) places.push_back({image, {0, 0, -height}});
    state_ = qdem::make_state(model_, places);
  }

  static double reduced_modulus() { return tests::rock().young / (1 - std::pow(tests::rock().poisson, 2)); }

  /// At rest: of both balls together.
  std::pair<Figures, double> press() {
    qdem::Engine engine(model_, {1});
    engine.prepare(state_);
    const double dt = 0.8 * qdem::StepBound(model_).at(state_, engine.contacts(), model_.contact.rounding);
    const double wave = radius / std::sqrt(tests::rock().young / tests::rock().density);
    engine.advance(state_, dt, static_cast<std::int64_t>(20 * wave / dt));
    forces_.assign(state_.x.size(), 0.0);
    engine.contacts().gather(0, forces_);
    const double kinetic = engine.kinetic_energy(state_), elastic = engine.energies(state_).strain;
    EXPECT_LT(kinetic, 1e-5 * elastic) << "not at rest";
    return {measured(), total_force()};
  }

 private:
  void hold() {
    const auto& nodes = model_.templates[0].nodes;
    for (int body = 0; body < static_cast<int>(model_.bodies.size()); ++body) {
      for (int i = 0; i < model_.templates[0].n_nodes(); ++i) {
        unsigned mask = 0;
        const double same = 1e-9 * radius;
        const bool on_x = nodes[i][0] < same, on_y = nodes[i][1] < same;
        if (on_x) mask |= body == 0 ? 1u : 2u;  // the image has x and y exchanged
        if (on_y) mask |= body == 0 ? 2u : 1u;
        if (nodes[i][2] > held_from) mask = 7u;
        if (mask != 0) model_.fixities.push_back({body, i, mask});
      }
    }
  }

  double force(int node) const { return qdem::State::gather(model_, forces_, 0, node)[2]; }

  /// On the whole ball [N].
  double total_force() const {
    double sum = 0;
    for (const int node : model_.templates[0].surface_nodes) sum += 4 * force(node);
    return sum;
  }

  Figures measured() const {
    // Hertz's pressure has sum(F r^2) = 2/5 a^2 sum(F).
    double sum = 0, moment = 0;
    for (const int node : model_.templates[0].surface_nodes) {
      sum += force(node), moment += force(node) * across(node);
    }
    const double a2 = 2.5 * moment / sum;
    double inner = 0, weight = 0;
    const std::vector<double> areas = areas_of_nodes();
    for (const int node : model_.templates[0].surface_nodes) {
      if (across(node) > 0.16 * a2 || areas[node] == 0 || model_.templates[0].nodes[node][2] > held_from) continue;
      inner += force(node), weight += areas[node] * std::sqrt(1 - across(node) / a2);
    }
    return {approach * static_cast<double>(model_.bodies.size()), std::sqrt(a2), inner / weight};
  }

  /// Distance from the axis, squared [m2].
  double across(int node) const { return state_.position(model_, 0, node).head<2>().squaredNorm(); }

  /// A third of each triangle of the sphere at the node.
  std::vector<double> areas_of_nodes() const {
    const qdem::Template& shape = model_.templates[0];
    std::vector<double> areas(shape.nodes.size(), 0.0);
    for (const auto& triangle : shape.triangles) {
      std::array<Vector3d, 3> x;
      bool outside = true;
      for (int k = 0; k < 3; ++k) {
        x[k] = shape.nodes[triangle.nodes[k]];
        outside = outside && std::abs(x[k].norm() - radius) < 1e-9 * radius;
      }
      if (!outside) continue;
      for (const int node : triangle.nodes) areas[node] += (x[1] - x[0]).cross(x[2] - x[0]).norm() / 6;
    }
    return areas;
  }

  qdem::Model model_;
  qdem::State state_;
  std::vector<double> forces_;
};

void expect_hertz(bool on_another) {
  const double sides = on_another ? 2 : 1;
  std::vector<Figures> errors;
  for (const int layers : {6, 9, 13}) {
    const auto [found, force] = PressedBall(layers, on_another).press();
    const Figures exact = hertz(force, PressedBall::reduced_modulus() / sides, radius / sides);
    const Figures ratio = found.over(exact);
    std::cout << layers << " layers, a/h = " << exact.contact_radius / (drawn_scale * radius / layers) << ", " << force
              << " N: approach " << ratio.approach << ", radius " << ratio.contact_radius << ", pressure "
              << ratio.pressure << " of Hertz's\n";
    errors.push_back({std::abs(ratio.approach - 1), std::abs(ratio.contact_radius - 1), std::abs(ratio.pressure - 1)});
  }
  const Figures& finest = errors.back();
  EXPECT_LT(finest.approach, 0.05);
  EXPECT_LT(finest.contact_radius, 0.05);
  EXPECT_LT(finest.pressure, 0.05);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_LT(errors[i].approach, errors[i - 1].approach);
    EXPECT_LT(errors[i].contact_radius, errors[i - 1].contact_radius);
    EXPECT_LT(errors[i].pressure, errors[i - 1].pressure);
  }
}

}  // namespace

TEST(V11, BallOnARigidPlane) {
  expect_hertz(false);
}

TEST(V11, TwoBallsWithContactSpheres) {
  expect_hertz(true);
}
