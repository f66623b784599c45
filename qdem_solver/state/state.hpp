// Everything about a QDEM problem that changes while it is integrated. A copy of it is a snapshot.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/energy_ledger.hpp"

namespace qdem {

/// Identity of a contact across rebuilds of the candidate list.
struct ContactKey {
  int body_a = 0, body_b = 0;         ///< a < b for edge and sphere pairs; a owns the vertex for vertex-surface pairs; b < 0: plane ~b
  int feature_a = 0, feature_b = 0;   ///< node or edge of a; edge of b, with spheres its node, -1 for vertex-surface
  HOUSE_HOST_DEVICE bool is_plane() const { return body_b < 0; }
  HOUSE_HOST_DEVICE bool is_edge_pair() const { return feature_b >= 0; }
  HOUSE_HOST_DEVICE friend bool operator==(const ContactKey& p, const ContactKey& q) {
    return p.body_a == q.body_a && p.body_b == q.body_b && p.feature_a == q.feature_a && p.feature_b == q.feature_b;
  }
  HOUSE_HOST_DEVICE friend bool operator<(const ContactKey& p, const ContactKey& q) {
    if (p.body_a != q.body_a) return p.body_a < q.body_a;
    if (p.body_b != q.body_b) return p.body_b < q.body_b;
    if (p.feature_a != q.feature_a) return p.feature_a < q.feature_a;
    return p.feature_b < q.feature_b;
  }
};

/// Candidate contacts and their tangential history; the contact stage owns the meaning, the state owns the values, so
/// that a snapshot holds them.
struct ContactState {
  std::vector<ContactKey> keys;               ///< ascending
  std::vector<int> triangle_offsets;          ///< CSR of candidate triangles (vertex-surface entries only)
  std::vector<int> triangles;
  std::vector<Eigen::Vector3d> slip;          ///< tangential spring elongation u_t of each key [m]
  std::vector<Eigen::Vector3d> roll;          ///< rolling spring's turn of each key [rad]; empty without rolling friction
  std::vector<double> travel;                 ///< of each body: bound of any node's movement since the last rebuild [m]
  std::int64_t rebuilds = 0;
  double rebuild_time = 0.0;                  ///< State::time of the last rebuild; moving planes travel since then [s]
  std::uint64_t list_id = 0;                  ///< hash of keys and triangles: tells the stage whether its scratch fits
};

/// One of Model::loads.
struct LoadState {
  double origin = 0.0;  ///< the patch's coordinate along the load's direction at the start [m]
  double path = 0.0;    ///< how far it went from there [m]
  double force = 0.0;   ///< on the patch along the direction, part of `a` [N]
  /// Of a falling weight along the direction, from where it first touches the patch [m], [m/s], [m/s2].
  double position = 0.0, velocity = 0.0, acceleration = 0.0;
};

/// Where an engine on a device holds the motion and contact history of a State in the device's memory. Only that engine
/// looks inside.
struct Residence {
  virtual ~Residence() = default;
};

/// Kinematic state at one time level. Arrays are laid out as model.hpp says.
struct State {
  std::int64_t step = 0;              ///< steps taken; time is counted by whoever sets the step length
  double time = 0.0;                  ///< [s]
  std::vector<double> x, v, a;        ///< position [m], velocity [m/s], acceleration [m/s2]
  ContactState contact;
  std::vector<double> pad_force;      ///< on the sleeper per cell and seat axis, part of `a` [N]
  std::vector<LoadState> loads;       ///< of Model::loads; the engine sets them up
  EnergyLedger ledger;
  /// Holds the same values on a device, if the state was last stepped there. Copies of a State share it until one of them
  /// is stepped on, so that a copy is a snapshot on the device too.
  std::shared_ptr<Residence> resident;

  Eigen::Vector3d position(const Model& model, int body, int node) const { return gather(model, x, body, node); }
  Eigen::Vector3d velocity(const Model& model, int body, int node) const { return gather(model, v, body, node); }

  static Eigen::Vector3d gather(const Model& model, const std::vector<double>& values, int body, int node) {
    const auto i = model.index(body, node);
    const auto s = model.stride(body);
    return {values[i], values[i + s], values[i + 2 * s]};
  }
  static void scatter(const Model& model, std::vector<double>& values, int body, int node, const Eigen::Vector3d& value) {
    const auto i = model.index(body, node);
    const auto s = model.stride(body);
    values[i] = value[0], values[i + s] = value[1], values[i + 2 * s] = value[2];
  }
};

/// A rigid placement of a body: x = rotation * (scale * X) + translation.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// State at rest with every body at its placement. Spare lanes get the batch's first body.
State make_state(const Model& model, const std::vector<Placement>& placements);

}  // namespace qdem
