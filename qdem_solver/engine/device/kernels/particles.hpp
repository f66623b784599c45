// Second half of a step: all forces of a particle, its acceleration, the end of the kick.
#pragma once

#include "qdem_solver/engine/device/kernels/contact.hpp"
#include "qdem_solver/engine/device/kernels/pads.hpp"

namespace qdem::device {

/// All forces on one particle, gathered in a fixed order: contacts, pads, load, elements.
struct ParticleForces {
  ModelView model;
  ListView list;
  EntryView entries;
  PadView pads;
  Loads loads;
  Pointer<const double> slots;

  HOUSE_HOST_DEVICE void operator()(const Access& at, const Place& place, double* force) const {
    const BatchRecord& batch = *place.batch;
    const int body = batch.bodies[place.lane];
    if (body >= 0) {
      const std::int64_t row = batch.rows_at + std::int64_t{place.number} * batch.lanes + place.lane;
      add_contact_force(at, list, entries, row, place.number, force);
    }
    if (body >= 0 && body == pads.body) {
      if (pads.n_values > 0) add_pad_force(at, pads, at(pads.force), place.number, force);
      const double volume = at(model.volumes)[batch.volumes_at + place.number];
      for (int c = 0; c < 3; ++c) force[c] += volume * loads.load_density[c];
    }
    const int* offsets = at(model.offsets) + batch.offsets_at + place.number;
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = offsets[0]; i < offsets[1]; ++i) {
      const std::int64_t corner = at(model.adjacency)[batch.adjacency_at + i];
      const double* slot = at(slots) + batch.slots_at + 3 * corner * batch.lanes + place.lane;
      for (int c = 0; c < 3; ++c) sum[c] += slot[c * batch.lanes];
    }
    for (int c = 0; c < 3; ++c) force[c] += sum[c];
  }
};

/// a_new = force / m + gravity, damped; v += dt/2 (a_new - a); a = a_new. See cpu::Kick.
struct Kick {
  MotionView motion;
  Pointer<const double> inverse_mass;
  Loads loads;
  double dt;

  HOUSE_HOST_DEVICE void operator()(const Access& at, const Place& place, const double* force) const {
    for (int c = 0; c < 3; ++c) {
      const std::int64_t i =
          place.batch->values_at + (std::int64_t{3} * place.number + c) * place.batch->lanes + place.lane;
      const double inverse = at(inverse_mass)[i], v = at(motion.v)[i];
      double accel = inverse > 0 ? force[c] * inverse + loads.gravity[c] : 0.0;
      const double size = accel < 0 ? -accel : accel;
      const double sign = v > 0 ? 1.0 : (v < 0 ? -1.0 : 0.0);
      accel -= loads.local_damping * size * sign + loads.drag * v;
      at(motion.v)[i] = v + 0.5 * dt * (accel - at(motion.a)[i]);
      at(motion.a)[i] = accel;
    }
  }
};

/// Items: ModelView::node_blocks.
struct ForceAndKick {
  ParticleForces forces;
  Kick kick;
  Pointer<const Clock> clock;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    if (waits(at, clock)) return;
    const Place place = place_of(at, forces.model, forces.model.node_blocks, item, &BatchRecord::n_nodes);
    if (place.batch == nullptr) return;
    double force[3] = {0.0, 0.0, 0.0};
    forces(at, place, force);
    kick(at, place, force);
  }
};

}  // namespace qdem::device
