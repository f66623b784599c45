// Steps with other inertia while bodies are brought to rest: cpu::ScaleInertia, a body's sums taken chunk by chunk.
#pragma once

#include <Eigen/LU>

#include "qdem_solver/engine/device/kernels/particles.hpp"

namespace qdem::device {

/// Sums over particles of one body, arms r from its first node: of m, m r, m v, f, m r r, r x m v, r x f.
struct BodySums {
  static constexpr int n_values = 22;
  static constexpr int mass = 0, arm = 1, momentum = 4, force = 7, second = 10, spin = 16, torque = 19;
};

/// Motion of a body as if it were rigid, what is made of its acceleration, and the divisor of all other motion.
struct RigidMotion {
  double centre[3], velocity[3], spin[3];
  double linear[3], angular[3];              ///< acceleration of the rigid part
  double moved_linear[3], moved_angular[3];  ///< the same damped and with other inertia
  double inverse_deformation;                ///< 1 / Inertia::deformation
};

/// Items: ModelView::node_blocks. Writes the force on every particle, laid out like State::x.
struct StoreForces {
  ParticleForces forces;
  Pointer<const Clock> clock;
  Pointer<double> force;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    if (waits(at, clock)) return;
    const Place place = place_of(at, forces.model, forces.model.node_blocks, item, &BatchRecord::n_nodes);
    if (place.batch == nullptr) return;
    double sum[3] = {0.0, 0.0, 0.0};
    forces(at, place, sum);
    for (int c = 0; c < 3; ++c) {
      const std::int64_t i = (std::int64_t{3} * place.number + c) * place.batch->lanes + place.lane;
      at(force)[place.batch->values_at + i] = sum[c];
    }
  }
};

/// Items: ModelView::chunk_blocks. Writes BodySums of every chunk, [value][chunk].
struct SumChunks {
  ModelView model;
  MotionView motion;
  Pointer<const double> force;
  Pointer<const Clock> clock;
  Pointer<double> sums;
  std::int64_t n_chunks;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    if (waits(at, clock)) return;
    const Place place = place_of(at, model, model.chunk_blocks, item, &BatchRecord::n_chunks);
    if (place.batch == nullptr || place.batch->bodies[place.lane] < 0) return;
    const BatchRecord& batch = *place.batch;
    const double mass_factor = at(model.bodies)[batch.bodies[place.lane]].mass_factor;
    const int first = place.number * chunk_size;
    const int last = first + chunk_size < batch.n_nodes ? first + chunk_size : batch.n_nodes;
    double sum[BodySums::n_values] = {};
    for (int node = first; node < last; ++node) {
      const double m = mass_factor * at(model.volumes)[batch.volumes_at + node];
      double r[3], p[3], f[3];
      for (int c = 0; c < 3; ++c) {
        const std::int64_t origin = batch.values_at + c * batch.lanes + place.lane;
        const std::int64_t i = origin + std::int64_t{3} * node * batch.lanes;
        r[c] = at(motion.x)[i] - at(motion.x)[origin];
        p[c] = m * at(motion.v)[i];
        f[c] = at(force)[i];
      }
      add(m, r, p, f, sum);
    }
    const std::int64_t chunk = batch.chunks_at + std::int64_t{place.number} * batch.lanes + place.lane;
    for (int k = 0; k < BodySums::n_values; ++k) at(sums)[k * n_chunks + chunk] = sum[k];
  }

 private:
  HOUSE_HOST_DEVICE static void add(double m, const double* r, const double* p, const double* f, double* sum) {
    sum[BodySums::mass] += m;
    int pair = 0;
    for (int c = 0; c < 3; ++c) {
      const int i = (c + 1) % 3, k = (c + 2) % 3;
      sum[BodySums::arm + c] += m * r[c];
      sum[BodySums::momentum + c] += p[c];
      sum[BodySums::force + c] += f[c];
      sum[BodySums::spin + c] += r[i] * p[k] - r[k] * p[i];
      sum[BodySums::torque + c] += r[i] * f[k] - r[k] * f[i];
      for (int other = c; other < 3; ++other) sum[BodySums::second + pair++] += m * r[c] * r[other];
    }
  }
};

/// Items: bodies.
struct FitRigidMotion {
  ModelView model;
  Pointer<const double> x, sums;
  Pointer<const Clock> clock;
  Pointer<const Inertia> inertia;
  Pointer<RigidMotion> rigid;
  Loads loads;
  double local_damping;  ///< of rigid motion [-]
  std::int64_t n_chunks;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t number) const {
    if (waits(at, clock)) return;
    using Eigen::Matrix3d, Eigen::Vector3d;
    const BodyRecord& body = at(model.bodies)[number];
    double s[BodySums::n_values];
    gather(at, body, s);
    const Vector3d free_moves = part(at(model.free_motions) + 6 * number, 0);
    const Vector3d free_turns = part(at(model.free_motions) + 6 * number, 3);
    const double mass = s[BodySums::mass];
    const Vector3d centre = part(s, BodySums::arm) / mass, momentum = part(s, BodySums::momentum);
    const Vector3d force = part(s, BodySums::force);
    const Vector3d velocity = free_moves.cwiseProduct(momentum) / mass;
    const Vector3d linear = free_moves.cwiseProduct(force / mass + part(loads.gravity, 0));
    Matrix3d second;  // of m r r about the centre
    for (int c = 0, pair = BodySums::second; c < 3; ++c) {
      for (int k = c; k < 3; ++k, ++pair) second(c, k) = second(k, c) = s[pair] - mass * centre[c] * centre[k];
    }
    Matrix3d moment = second.trace() * Matrix3d::Identity() - second;
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) moment(c, k) *= free_turns[c] * free_turns[k];
      moment(c, c) += 1 - free_turns[c];
    }
    const Matrix3d inverse = moment.inverse();
    const Vector3d spin = inverse * free_turns.cwiseProduct(part(s, BodySums::spin) - centre.cross(momentum));
    const Vector3d angular = inverse * free_turns.cwiseProduct(part(s, BodySums::torque) - centre.cross(force));
    RigidMotion& out = at(rigid)[number];
    for (int c = 0; c < 3; ++c) {
      out.centre[c] = at(x)[body.values_at + c * body.lanes] + centre[c];
      out.velocity[c] = velocity[c], out.spin[c] = spin[c];
      out.linear[c] = linear[c], out.angular[c] = angular[c];
      out.moved_linear[c] = damped(linear[c], velocity[c]) / at(inertia)[number].rigid;
      out.moved_angular[c] = damped(angular[c], spin[c]) / at(inertia)[number].rigid;
    }
    out.inverse_deformation = 1 / at(inertia)[number].deformation;
  }

 private:
  HOUSE_HOST_DEVICE void gather(const Access& at, const BodyRecord& body, double* s) const {
    const BatchRecord& batch = at(model.batches)[body.batch];
    for (int k = 0; k < BodySums::n_values; ++k) {
      s[k] = 0.0;
      const double* of_value = at(sums) + k * n_chunks + batch.chunks_at + body.lane;
      for (int chunk = 0; chunk < batch.n_chunks; ++chunk) s[k] += of_value[std::int64_t{chunk} * batch.lanes];
    }
  }
  HOUSE_HOST_DEVICE static Eigen::Vector3d part(const double* values, int first) {
    return {values[first], values[first + 1], values[first + 2]};
  }
  /// Cundall's damping of one component.
  HOUSE_HOST_DEVICE double damped(double acceleration, double velocity) const {
    const double size = acceleration < 0 ? -acceleration : acceleration;
    const double sign = velocity > 0 ? 1.0 : (velocity < 0 ? -1.0 : 0.0);
    return acceleration - local_damping * size * sign;
  }
};

/// Items: ModelView::node_blocks. Turns the forces into those that move the bodies with their other inertia, and kicks.
struct RelaxedKick {
  ModelView model;
  Pointer<const double> force;
  Pointer<const RigidMotion> rigid;
  Pointer<const Clock> clock;
  Kick kick;
  double deformation_drag;  ///< [1/s]

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    if (waits(at, clock)) return;
    const Place place = place_of(at, model, model.node_blocks, item, &BatchRecord::n_nodes);
    if (place.batch == nullptr || place.batch->bodies[place.lane] < 0) return;
    const BatchRecord& batch = *place.batch;
    const int number = batch.bodies[place.lane];
    const RigidMotion& body = at(rigid)[number];
    const double m = at(model.bodies)[number].mass_factor * at(model.volumes)[batch.volumes_at + place.number];
    const std::int64_t first = batch.values_at + std::int64_t{3} * place.number * batch.lanes + place.lane;
    double r[3], moved_force[3];
    for (int c = 0; c < 3; ++c) r[c] = at(kick.motion.x)[first + c * batch.lanes] - body.centre[c];
    for (int c = 0; c < 3; ++c) {
      const std::int64_t here = first + c * batch.lanes;
      const double gravity = kick.loads.gravity[c];
      const double whole = at(force)[here] / m + gravity;
      const double stiff = body.linear[c] + turned(body.angular, r, c);
      const double drift = body.velocity[c] + turned(body.spin, r, c);
      const double moved = body.moved_linear[c] + turned(body.moved_angular, r, c);
      const double bent =
          body.inverse_deformation * (whole - stiff) - deformation_drag * (at(kick.motion.v)[here] - drift);
      moved_force[c] = m * (moved + bent - gravity);
    }
    kick(at, place, moved_force);
  }

 private:
  /// Component c of w x r.
  HOUSE_HOST_DEVICE static double turned(const double* w, const double* r, int c) {
    const int i = (c + 1) % 3, k = (c + 2) % 3;
    return w[i] * r[k] - w[k] * r[i];
  }
};

}  // namespace qdem::device
