// Loads on a patch of a body's surface: a force over time, a displacement over time, a falling weight.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace qdem {

struct Model;
struct State;

/// Surface particles that a load acts on together. The patch's coordinate is sum of weight x (direction . x), and a
/// force on the patch is shared out by the same weights, so that work is force times the coordinate's change.
struct Patch {
  int body = 0;
  std::vector<int> nodes;
  std::vector<double> weights;          ///< shares of the patch's area; sum to one
  Eigen::Vector3d direction{0, 0, -1};  ///< unit
};

enum class LoadKind {
  force,         ///< history(t) [N]
  displacement,  ///< stiffness x (history(t) - path): history [m] is that of the far end of a spring
  drop_weight,   ///< max(0, stiffness x overlap + damping x its rate) of a mass that moves along the direction
};

struct PatchLoad {
  Patch patch;
  LoadKind kind = LoadKind::force;
  std::function<double(double)> history = {};  ///< of time [s]; not of a drop weight
  double stiffness = 0.0;                      ///< [N/m]
  double damping = 0.0;                        ///< of the drop weight's buffer [N s/m]
  double mass = 0.0;                           ///< of the drop weight [kg]
  double speed = 0.0;                          ///< of the drop weight when it first touches [m/s]
  double start = 0.0;                          ///< when it does [s]
};

/// Where a patch is looked for: a ball, or a box along the axes.
struct Region {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        ///< [m]
  double radius = 0.0;                                     ///< of a ball; 0: a box [m]
  Eigen::Vector3d half_lengths = Eigen::Vector3d::Zero();  ///< of a box [m]
  bool holds(const Eigen::Vector3d& point) const;
};

/// Patch of all surface triangles of `body` that lie inside `region` with all corners at `state`. `direction` need not
/// be a unit vector. Throws proto::Error (bad_data) when there are none.
Patch make_patch(const Model& model, const State& state, int body, const Region& region,
                 const Eigen::Vector3d& direction);

/// The pad cells of all seats together, against the first seat's normal: down onto the sleeper.
Patch make_pad_patch(const Model& model);

}  // namespace qdem
