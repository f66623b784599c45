// A column of ground whose particles move along one axis only: waves in it are plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"

namespace tests {

inline qdem::Material soil() {
  return {"soil", 50e6, 0.3, 2000.0, 0.0, 0.0};
}

/// Column of square bricks along z, from z = 0 down; `axis` is the one that particles move along: 2 for P, 0 for S.
class GroundColumn {
 public:
  enum class Bottom { absorbing, fixed };

  GroundColumn(int n_bricks, double brick, int axis, Bottom bottom, double alpha = 0.0)
      : depth_(n_bricks * brick),
        axis_(axis),
        n_levels_(n_bricks + 1),
        model_(free_bodies(shape_of(n_bricks, brick), soil())) {
    state_ = qdem::make_state(model_, {{}});
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      const bool is_held = bottom == Bottom::fixed && height(i) < 1e-9 - depth_;
      model_.fixities.push_back({0, i, is_held ? 7u : 7u & ~(1u << axis)});
    }
    if (bottom == Bottom::fixed) return;
    qdem::FarField far;
    far.normal_stiffness = far.tangential_stiffness = alpha;
    model_.boundary = qdem::absorbing_boundary(model_, state_, 0, {{2, -1}}, far);
  }

  qdem::Model& model() { return model_; }
  qdem::State& state() { return state_; }
  double height(int node) const { return model_.shape(0).nodes[node][2]; }
  double wave_speed() const {
    const qdem::Material& m = model_.materials[0];
    return std::sqrt((axis_ == 2 ? m.lambda() + 2 * m.mu() : m.mu()) / m.density);
  }
  double stable_step() const {
    qdem::Engine engine(model_, {1});
    qdem::State copy = state_;
    engine.prepare(copy);
    return qdem::StepBound(model_).at(copy, engine.contacts(), 0.0);
  }

  /// A smooth pulse of this length [m] around a height, on its way down: u(z, t) = f(z + c t), f = a cos^2.
  void start_pulse(double centre, double length, double amplitude) {
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      const double s = (height(i) - centre) / length;
      if (std::abs(s) >= 0.5) continue;
      Eigen::Vector3d x = state_.position(model_, 0, i), v = Eigen::Vector3d::Zero();
      x[axis_] += amplitude * std::pow(std::cos(M_PI * s), 2);
      v[axis_] = -wave_speed() * amplitude * M_PI / length * std::sin(2 * M_PI * s);
      qdem::State::scatter(model_, state_.x, 0, i, x);
      qdem::State::scatter(model_, state_.v, 0, i, v);
    }
  }

  /// Largest mean displacement of the four particles of a level [m].
  double largest_displacement() const {
    std::vector<double> sums(n_levels_, 0.0);
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      sums[i % n_levels_] += state_.position(model_, 0, i)[axis_] - model_.shape(0).nodes[i][axis_];
    }
    double largest = 0.0;
    for (const double sum : sums) largest = std::max(largest, std::abs(sum) / 4);
    return largest;
  }

 private:
  static qdem::Template shape_of(int n_bricks, double brick) {
    Mesh mesh = box_mesh({1, 1, n_bricks}, {brick, brick, n_bricks * brick});
    for (auto& node : mesh.nodes) node[2] -= n_bricks * brick;
    return qdem::make_template("column", mesh.nodes, mesh.tets);
  }

  double depth_;
  int axis_, n_levels_;
  qdem::Model model_;
  qdem::State state_;
};

}  // namespace tests
