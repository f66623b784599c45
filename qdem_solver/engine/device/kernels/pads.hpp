// The pads: cell values from the sleeper's particles, forces by the law.
#pragma once

#include "proto/pad/pad_law.hpp"
#include "qdem_solver/engine/device/records.hpp"

namespace qdem::device {

/// The pads' immutable arrays (PadTables) and what changes. Values are in order of cell, seat axis.
struct PadView {
  Pointer<const double> axes;
  Pointer<const proto::PadLaw> laws;
  Pointer<const int> cell_offsets, nodes;
  Pointer<const double> weights;
  Pointer<const int> node_offsets, cells;
  Pointer<const double> cell_weights;
  Pointer<const double> reference;   ///< cell values of the positions that count as undisplaced [m]
  Pointer<const double> begin, end;  ///< rail foot before the first and after the last step [m]
  Pointer<double> force;             ///< on the sleeper [N]
  Pointer<double> change;            ///< of force, where pads are exchanged [N]
  Pointer<double> impulse, work;     ///< [N s], [J]
  std::int64_t values_at = 0;        ///< of the pad body
  int lanes = 1;
  int body = -1;
  int n_values = 0;
};

/// Value of a field laid out like State::x at a pad value.
HOUSE_HOST_DEVICE inline double pad_value(const Access& at, const PadView& pads, const double* field, int value) {
  const int cell = value / 3;
  const double* axis = at(pads.axes) + 3 * std::int64_t{value};
  double sum[3] = {0.0, 0.0, 0.0};
  for (int i = at(pads.cell_offsets)[cell]; i < at(pads.cell_offsets)[cell + 1]; ++i) {
    const double* p = field + pads.values_at + std::int64_t{3} * at(pads.nodes)[i] * pads.lanes;
    const double weight = at(pads.weights)[i];
    for (int c = 0; c < 3; ++c) sum[c] += weight * p[c * pads.lanes];
  }
  return axis[0] * sum[0] + axis[1] * sum[1] + axis[2] * sum[2];
}

/// Adds the transposed of pad_value(): the force that pad values make on a node of the pad body.
HOUSE_HOST_DEVICE inline void add_pad_force(const Access& at, const PadView& pads, const double* values, int node,
                                            double* force) {
  for (int i = at(pads.node_offsets)[node]; i < at(pads.node_offsets)[node + 1]; ++i) {
    const int cell = at(pads.cells)[i];
    const double* axes = at(pads.axes) + 9 * std::int64_t{cell};
    const double weight = at(pads.cell_weights)[i];
    for (int c = 0; c < 3; ++c) {
      double global = 0.0;
      for (int axis = 0; axis < 3; ++axis) global += axes[3 * axis + c] * values[3 * cell + axis];
      force[c] += weight * global;
    }
  }
}

/// Force of one pad value for given rail displacement and velocity.
HOUSE_HOST_DEVICE inline double pad_force(const Access& at, const PadView& pads, const MotionView& motion, double u,
                                          double rate, int value) {
  const double moved = pad_value(at, pads, at(motion.x), value) - at(pads.reference)[value];
  return at(pads.laws)[value].force(u - moved, rate - pad_value(at, pads, at(motion.v), value));
}

/// Pad forces at the end of a step whose rail foot moves linearly; adds impulse and work of the step. Items: pad
/// values.
struct PadForces {
  PadView pads;
  MotionView motion;
  Pointer<const Clock> clock;
  StepFrame frame;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    if (waits(at, clock)) return;
    const double u = foot(at, item, at(clock)->done), next_u = foot(at, item, at(clock)->done + 1);
    const double next = pad_force(at, pads, motion, next_u, rate(at, item), static_cast<int>(item));
    const double mean = 0.5 * (at(pads.force)[item] + next);
    at(pads.impulse)[item] += frame.dt * mean;
    at(pads.work)[item] += mean * (next_u - u);
    at(pads.force)[item] = next;
  }

  HOUSE_HOST_DEVICE double foot(const Access& at, std::int64_t value, std::int64_t step) const {
    const double share = static_cast<double>(step) / static_cast<double>(frame.n_steps);
    return at(pads.begin)[value] + share * (at(pads.end)[value] - at(pads.begin)[value]);
  }
  HOUSE_HOST_DEVICE double rate(const Access& at, std::int64_t value) const {
    return (at(pads.end)[value] - at(pads.begin)[value]) / (frame.dt * static_cast<double>(frame.n_steps));
  }
};

/// Exchanges the pad forces of a time level for those of the rail's new motion, or, without a rail, for none; keeps the
/// change. Items: pad values.
struct ExchangePadForces {
  PadForces next;
  bool driven;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    const PadView& pads = next.pads;
    const double force =
        driven ? pad_force(at, pads, next.motion, next.foot(at, item, 0), next.rate(at, item), static_cast<int>(item))
               : 0.0;
    at(pads.change)[item] = force - at(pads.force)[item];
    at(pads.force)[item] = force;
  }
};

/// What that does to the accelerations. Items: nodes of the pad body.
struct AddPadChange {
  PadView pads;
  Pointer<const double> inverse_mass;
  Pointer<double> a;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t node) const {
    double force[3] = {0.0, 0.0, 0.0};
    add_pad_force(at, pads, at(pads.change), static_cast<int>(node), force);
    for (int c = 0; c < 3; ++c) {
      const std::int64_t i = pads.values_at + (3 * node + c) * pads.lanes;
      at(a)[i] += force[c] * at(inverse_mass)[i];
    }
  }
};

}  // namespace qdem::device
