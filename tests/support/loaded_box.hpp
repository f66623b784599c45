// A specimen that measures a body's elastic constants: a free box under the tractions of a uniform stress.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"

namespace tests {

/// Box of mirrored bricks whose nodes are moved at random by up to `distortion`; its faces stay plane.
inline qdem::Template plane_faced_box(std::array<int, 3> cells, const Eigen::Vector3d& size, double distortion) {
  Mesh mesh = box_mesh(cells, size, Cut::mirrored);
  const auto regular = mesh.nodes;
  distort(mesh, distortion);
  for (std::size_t i = 0; i < regular.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (regular[i][c] < 1e-9 || regular[i][c] > size[c] - 1e-9) mesh.nodes[i][c] = regular[i][c];
    }
  }
  return qdem::make_template("specimen", mesh.nodes, mesh.tets);
}

/// A plane-faced box; the tractions are there at once, by pads over its six faces that are a millionth as stiff as the
/// box. Three corners hold it as a rigid body without reactions.
class LoadedBox {
 public:
  LoadedBox(std::array<int, 3> cells, const Eigen::Vector3d& size, double distortion, const qdem::Material& material,
            const Eigen::Matrix3d& stress)
      : size_(size), model_(free_bodies(plane_faced_box(cells, size, distortion), material)) {
    for (int face = 0; face < 6; ++face) add_pad(face / 2, face % 2 == 0 ? -1 : 1, stress);
    model_.pad_body = 0;
    hold_corner({0, 0, 0}, 7u), hold_corner({size[0], 0, 0}, 6u), hold_corner({0, size[1], 0}, 4u);
    start_ = state_ = qdem::make_state(model_, {{}});
    engine_ = std::make_unique<qdem::Engine>(model_, qdem::EngineOptions{1});
    engine_->set_pad_reference(start_.x);
    engine_->prepare(state_);
  }
  LoadedBox(const LoadedBox&) = delete;
  LoadedBox& operator=(const LoadedBox&) = delete;

  double stable_step() const {
    return 0.8 * qdem::largest_stable_step(qdem::template_rates(model_.templates[0], model_.materials[0]));
  }
  void advance(double dt, std::int64_t n_steps) { engine_->advance(state_, dt, n_steps, {foot_, foot_}); }

  /// By a drag that is half the critical one of the first longitudinal mode.
  void come_to_rest() {
    const qdem::Material& material = model_.materials[0];
    model_.drag_per_s = M_PI / size_.maxCoeff() * std::sqrt(material.young / material.density);
    const double dt = stable_step();
    qdem::Energies energies;
    int looks = 0;
    do {
      advance(dt, 200);
      energies = engine_->energies(state_);
    } while (++looks < 100 && energies.kinetic > 1e-16 * energies.strain);
    EXPECT_LT(looks, 100) << "it does not come to rest";
  }

  /// Volume mean, from the mean displacements of the faces.
  Eigen::Matrix3d strain() const {
    const auto u = engine_->pad_displacement(state_, start_.x);
    Eigen::Matrix3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      for (int c = 0; c < 3; ++c) gradient(c, axis) = (u[6 * axis + 3 + c] - u[6 * axis + c]) / size_[axis];
    }
    return 0.5 * (gradient + gradient.transpose());
  }
  double strain_energy() const { return engine_->energies(state_).strain; }
  const qdem::Model& model() const { return model_; }
  const qdem::State& state() const { return state_; }

 private:
  void hold_corner(const Eigen::Vector3d& corner, unsigned mask) {
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      if (model_.shape(0).nodes[i] == corner) model_.fixities.push_back({0, i, mask});
    }
  }

  void add_pad(int axis, int side, const Eigen::Matrix3d& stress) {
    const auto& shape = model_.shape(0);
    std::vector<double> area(shape.n_nodes(), 0.0);
    double whole = 0.0;
    for (const auto& triangle : shape.triangles) {
      const auto& n = triangle.nodes;
      const Eigen::Vector3d p = shape.nodes[n[1]] - shape.nodes[n[0]], q = shape.nodes[n[2]] - shape.nodes[n[0]];
      const Eigen::Vector3d normal = 0.5 * p.cross(q);
      if (side * normal[axis] < 0.99 * normal.norm()) continue;
      for (const int node : n) area[node] += normal.norm() / 3, whole += normal.norm() / 3;
    }
    qdem::PadCell cell;
    cell.axes = Eigen::Matrix3d::Identity();
    const double stiffness = 1e-6 * model_.materials[0].young * whole / size_[axis];
    for (int c = 0; c < 3; ++c) {
      cell.laws[c].stiffness = stiffness;
      foot_.push_back(side * stress(c, axis) * whole / stiffness);
    }
    for (int i = 0; i < shape.n_nodes(); ++i) {
      if (area[i] > 0) cell.nodes.push_back(i), cell.weights.push_back(area[i] / whole);
    }
    model_.pads.push_back(cell);
  }

  Eigen::Vector3d size_;
  qdem::Model model_;
  qdem::State state_, start_;
  std::unique_ptr<qdem::Engine> engine_;
  std::vector<double> foot_;
};

}  // namespace tests
