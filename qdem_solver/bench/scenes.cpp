#include "qdem_solver/bench/scenes.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "qdem_solver/bed/sleeper_shape.hpp"

namespace qdem::bench {
namespace {

using Eigen::Vector3d;

Material rock() {
  Material rock{"rock", 60e9, 0.25, 2700, 0, 0};
  rock.lame_viscosity = 1e-7 * rock.lambda(), rock.shear_viscosity = 1e-7 * rock.mu();
  return rock;
}

Model model_of(Template shape, int n_bodies) {
  Model model;
  model.materials.push_back(rock());
  model.templates.push_back(std::move(shape));
  model.bodies.resize(n_bodies);
  for (Body& body : model.bodies) body.kind = BodyKind::stone;
  model.gravity = {0, 0, -9.81};
  return model;
}

Template stone_shape() {
  return bed::box_shape("stone", {-0.03, -0.03, -0.02}, {0.03, 0.03, 0.02}, 0.02);
}

Scene finished(Model model, const std::vector<Placement>& places) {
  make_batches(model);
  State state = make_state(model, places);
  return {std::move(model), std::move(state)};
}

}  // namespace

Scene stones(int n_elements) {
  Template shape = stone_shape();
  const int n = n_elements / shape.n_tets();
  const int side = static_cast<int>(std::ceil(std::cbrt(n)));
  std::vector<Placement> places(n);
  for (int i = 0; i < n; ++i) {
    places[i].translation = 0.1 * Vector3d(i % side, i / side % side, i / (side * side));
  }
  return finished(model_of(std::move(shape), n), places);
}

Scene single_mesh(int n_elements) {
  const double cell = 1.0 / std::cbrt(n_elements / 6.0);
  return finished(model_of(bed::box_shape("mesh", Vector3d::Zero(), Vector3d::Ones(), cell), 1), {Placement{}});
}

Scene pile() {
  constexpr int side = 10, layers = 10;
  constexpr double rounding = 1e-3, overlap = 2e-5;
  Model model = model_of(stone_shape(), side * side * layers);
  model.contact = {2.5e7, 0.8, 0.03, 0.6, rounding};
  model.planes.push_back({"ground", {0, 0, -0.02 - rounding + overlap}, Vector3d::UnitZ()});
  std::vector<Placement> places;
  for (int layer = 0; layer < layers; ++layer) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3 * (layer % 2), Vector3d::UnitZ()).toRotationMatrix();
    for (int i = 0; i < side * side; ++i) {
      places.push_back({turn, {0.1 * (i % side), 0.1 * (i / side), layer * (0.04 + 2 * rounding - overlap)}});
    }
  }
  return finished(std::move(model), places);
}

}  // namespace qdem::bench
