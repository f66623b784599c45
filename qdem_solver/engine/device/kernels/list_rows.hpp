// What comes with a new candidate list: the slips of the old one, and who acts on which particle.
#pragma once

#include "qdem_solver/engine/device/kernels/bisection.hpp"
#include "qdem_solver/engine/device/kernels/contact.hpp"

namespace qdem::device {

/// Items: entries of the new list. Slips of the old list at the new keys; a key without history starts unstretched.
struct CarrySlip {
  Pointer<const ContactKey> keys, old_keys;
  Pointer<const double> old_slip;
  std::int64_t n_old;
  Pointer<double> slip;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t entry) const {
    const ContactKey key = at(keys)[entry];
    const std::int64_t old = first_not(n_old, [&](std::int64_t i) { return at(old_keys)[i] < key; });
    const bool known = old < n_old && at(old_keys)[old] == key;
    for (int c = 0; c < 3; ++c) at(slip)[3 * entry + c] = known ? at(old_slip)[3 * old + c] : 0.0;
  }
};

/// Items: entries. The particles that an entry may act on: counts [item], or row * 2^32 + 2 * entry + side from
/// offsets [item] on; a particle may come twice.
struct TouchedRows {
  ModelView model;
  ListView list;
  Pointer<Count> counts;
  Pointer<const Count> offsets;
  Pointer<unsigned long long> rows;
  bool counting;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t entry) const {
    const ContactKey key = at(list.keys)[entry];
    Count next = counting ? 0 : at(offsets)[entry];
    if (key.is_edge_pair()) {
      const Edge& a = skin_of(at, model, key.body_a).edges[key.feature_a];
      for (int k = 0; k < 2; ++k) put(at, key.body_a, a.nodes[k], 2 * entry, next);
      const SkinView b = skin_of(at, model, key.body_b);
      put_corners(at, key.body_b, b.triangles[b.edges[key.feature_b].triangles[0]], 2 * entry + 1, next);
    } else {
      put(at, key.body_a, key.feature_a, 2 * entry, next);
      for (int i = at(list.triangle_offsets)[entry]; i < at(list.triangle_offsets)[entry + 1]; ++i) {
        const SkinView b = skin_of(at, model, key.body_b);
        put_corners(at, key.body_b, b.triangles[at(list.triangles)[i]], 2 * entry + 1, next);
      }
    }
    if (counting) at(counts)[entry] = next;
  }

 private:
  HOUSE_HOST_DEVICE void put(const Access& at, int body, int node, std::int64_t code, Count& next) const {
    if (!counting) {
      const BodyRecord& record = at(model.bodies)[body];
      const std::int64_t row = record.row + std::int64_t{node} * record.lanes;
      at(rows)[next] = static_cast<unsigned long long>(row) << 32 | static_cast<unsigned long long>(code);
    }
    ++next;
  }
  HOUSE_HOST_DEVICE void put_corners(const Access& at, int body, const Triangle& triangle, std::int64_t code,
                                     Count& next) const {
    for (int k = 0; k < 3; ++k) put(at, body, triangle.nodes[k], code, next);
  }
};

/// Items: rows and one more. Where a row begins among the sorted `rows`.
struct RowOffsets {
  Pointer<const unsigned long long> rows;
  std::int64_t n;
  Pointer<int> offsets;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t row) const {
    const auto before = [&](std::int64_t i) { return static_cast<std::int64_t>(at(rows)[i] >> 32) < row; };
    at(offsets)[row] = static_cast<int>(first_not(n, before));
  }
};

/// Items: sorted `rows`.
struct RowEntries {
  Pointer<const unsigned long long> rows;
  Pointer<unsigned> entries;
  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t i) const {
    at(entries)[i] = static_cast<unsigned>(at(rows)[i] & 0xffffffffu);
  }
};

}  // namespace qdem::device
