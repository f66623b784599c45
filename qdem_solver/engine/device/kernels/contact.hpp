// Forces of the contact candidates, each into entries of its own.
#pragma once

#include "qdem_solver/contact/entry_force.hpp"
#include "qdem_solver/engine/device/records.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem::device {

/// The candidate list (ContactState) and, for every particle, who acts on it.
struct ListView {
  Pointer<const ContactKey> keys;
  Pointer<const int> triangle_offsets, triangles;
  Pointer<const int> row_offsets;       ///< CSR over rows (see BatchRecord) of `row_entries`
  Pointer<const unsigned> row_entries;  ///< 2 * entry + side, side 0: body a; ascending in a row
  std::int64_t n_entries = 0;
};

/// What the entries of a list do; [k * n_entries + entry] for value k.
struct EntryView {
  Pointer<double> slip;   ///< [entry][3]: ContactState::slip
  Pointer<double> wake;   ///< travel of both sides together below which an entry cannot touch [m]
  Pointer<int> live;      ///< 1: carries a force
  Pointer<int> nodes;     ///< [5]: two of body a, three of body b; -1: none
  Pointer<double> force;  ///< [5][3] [N]
  Pointer<double> overlap, energy;
};

/// One candidate. Items: entries. Reads x, v, travel; writes the entry. Entries that do not touch sleep until their two
/// sides have travelled the gap, as in the CPU's ContactStage.
struct ContactForces {
  ModelView model;
  Pointer<const PlaneRecord> planes;
  ListView list;
  EntryView entries;
  MotionView motion;
  Pointer<const double> travel;
  Pointer<const Clock> clock;
  ContactLaw law;
  StepFrame frame;
  double rebuild_time;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t entry) const {
    if (waits(at, clock)) return;
    const ContactKey key = at(list.keys)[entry];
    const double time = frame.time(at(clock)->done + 1);
    const double moved = at(travel)[key.body_a] + other_travel(at, key, time);
    if (moved < at(entries.wake)[entry]) return;
    double* kept = at(entries.slip) + 3 * entry;
    Eigen::Vector3d slip(kept[0], kept[1], kept[2]);
    const EntryForce force = push(at, key, entry, time, slip);
    for (int c = 0; c < 3; ++c) kept[c] = slip[c];
    at(entries.live)[entry] = force.live ? 1 : 0;
    if (force.live) {
      write(at, entry, force);
    } else {
      at(entries.wake)[entry] = moved + force.gap;
    }
  }

 private:
  HOUSE_HOST_DEVICE double other_travel(const Access& at, const ContactKey& key, double time) const {
    if (!key.is_plane()) return at(travel)[key.body_b];
    return PlaneNow(at(planes)[~key.body_b]).velocity.norm() * std::abs(time - rebuild_time);
  }

  HOUSE_HOST_DEVICE EntryForce push(const Access& at, const ContactKey& key, std::int64_t entry, double time,
                                    Eigen::Vector3d& slip) const {
    const Motion now{at(motion.x), at(motion.v), frame.dt};
    const SkinView a = skin_of(at, model, key.body_a);
    if (key.is_plane()) {
      return push_on_plane(law, a, key.feature_a, PlaneNow(at(planes)[~key.body_b]), time, now, slip);
    }
    const SkinView b = skin_of(at, model, key.body_b);
    if (key.is_edge_pair()) return push_edges(law, a, key.feature_a, b, key.feature_b, now, slip);
    const int* first = at(list.triangles) + at(list.triangle_offsets)[entry];
    const int* last = at(list.triangles) + at(list.triangle_offsets)[entry + 1];
    return push_node(law, a, key.feature_a, b, first, last, now, slip);
  }

  HOUSE_HOST_DEVICE void write(const Access& at, std::int64_t entry, const EntryForce& force) const {
    const std::int64_t n = list.n_entries;
    for (int k = 0; k < 5; ++k) {
      const bool used = k < 2 ? k < force.n_a : k - 2 < force.n_b;
      at(entries.nodes)[k * n + entry] = !used ? -1 : (k < 2 ? force.nodes_a[k] : force.nodes_b[k - 2]);
      for (int c = 0; c < 3; ++c) {
        const double value = !used ? 0.0 : (k < 2 ? force.force_a[k][c] : force.force_b[k - 2][c]);
        at(entries.force)[(3 * k + c) * n + entry] = value;
      }
    }
    at(entries.overlap)[entry] = force.overlap;
    at(entries.energy)[entry] = force.energy;
  }
};

/// Adds the contact forces on the particle of a row, in the order of the list.
HOUSE_HOST_DEVICE inline void add_contact_force(const Access& at, const ListView& list, const EntryView& entries,
                                                std::int64_t row, int node, double* force) {
  const std::int64_t n = list.n_entries;
  for (int i = at(list.row_offsets)[row]; i < at(list.row_offsets)[row + 1]; ++i) {
    const unsigned code = at(list.row_entries)[i];
    const std::int64_t entry = code / 2;
    if (at(entries.live)[entry] == 0) continue;
    const int first = code % 2 == 0 ? 0 : 2, last = code % 2 == 0 ? 2 : 5;
    for (int k = first; k < last; ++k) {
      if (at(entries.nodes)[k * n + entry] != node) continue;
      for (int c = 0; c < 3; ++c) force[c] += at(entries.force)[(3 * k + c) * n + entry];
    }
  }
}

}  // namespace qdem::device
