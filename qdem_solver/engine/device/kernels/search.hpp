// Candidate search: what find_candidates() does on the CPU, cut into independent items.
//
// Bodies are sorted along one axis and swept for pairs of near boxes; every surface node of a pair's first body looks
// for triangles of the second, every sharp edge for sharp edges, every surface node for planes. All of it runs twice:
// once to count, so that a scan gives everybody a place of its own, once to write. Sorting makes the order that of
// ContactState.
#pragma once

#include "qdem_solver/contact/closest_point.hpp"
#include "qdem_solver/engine/device/kernels/bisection.hpp"
#include "qdem_solver/engine/device/kernels/contact.hpp"

namespace qdem::device {

struct BoxRecord {
  double low[3], high[3];
};

HOUSE_HOST_DEVICE inline bool boxes_near(const BoxRecord& a, const BoxRecord& b, double reach) {
  for (int c = 0; c < 3; ++c) {
    if (!(a.low[c] <= b.high[c] + reach) || !(b.low[c] <= a.high[c] + reach)) return false;
  }
  return true;
}

HOUSE_HOST_DEVICE inline void grow(BoxRecord& box, const Eigen::Vector3d& x) {
  for (int c = 0; c < 3; ++c) {
    if (x[c] < box.low[c]) box.low[c] = x[c];
    if (x[c] > box.high[c]) box.high[c] = x[c];
  }
}

HOUSE_HOST_DEVICE inline BoxRecord box_at(const Eigen::Vector3d& x) {
  return {{x[0], x[1], x[2]}, {x[0], x[1], x[2]}};
}

/// What the search reads.
struct SearchView {
  ModelView model;
  Pointer<const double> x;
  Pointer<const PlaneRecord> planes;
  int n_planes;
  Pointer<const BoxRecord> boxes;
  Pointer<const std::int64_t> surface_rows;  ///< Tables::surface_rows
  double reach, plane_reach, time;

  HOUSE_HOST_DEVICE Eigen::Vector3d node(const Access& at, int body, int node) const {
    return skin_of(at, model, body).at(at(x), node);
  }
  HOUSE_HOST_DEVICE int surface_node(const Access& at, int body, std::int64_t number) const {
    return at(model.surface_nodes)[at(model.bodies)[body].surface_at + number];
  }
};

/// Items: bodies. Box of a body's surface nodes, its lower end along the sweep's axis, and its number.
struct BodyBoxes {
  SearchView view;
  int axis;
  Pointer<BoxRecord> boxes;
  Pointer<double> low;
  Pointer<int> order;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    const int body = static_cast<int>(item);
    BoxRecord box = box_at(view.node(at, body, 0));
    for (int i = 0; i < at(view.model.bodies)[body].n_surface_nodes; ++i) {
      grow(box, view.node(at, body, view.surface_node(at, body, i)));
    }
    at(boxes)[body] = box;
    at(low)[body] = box.low[axis];
    at(order)[body] = body;
  }
};

/// Items: places in the sorted order. Pairs (both directions) of a body with those after it; counts [item] them, or
/// writes them from offsets [item] on as first * 2^32 + second.
struct SweepBodies {
  SearchView view;
  int axis;
  Pointer<const int> order;
  Pointer<Count> counts;
  Pointer<const Count> offsets;
  Pointer<unsigned long long> pairs;
  bool counting;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    const BoxRecord* boxes = at(view.boxes);
    const auto a = static_cast<unsigned long long>(at(order)[item]);
    Count n = counting ? 0 : at(offsets)[item];
    for (std::int64_t j = item + 1; j < view.model.n_bodies; ++j) {
      const auto b = static_cast<unsigned long long>(at(order)[j]);
      if (boxes[b].low[axis] > boxes[a].high[axis] + view.reach) break;
      if (!boxes_near(boxes[a], boxes[b], view.reach)) continue;
      if (!counting) at(pairs)[n] = a << 32 | b, at(pairs)[n + 1] = b << 32 | a;
      n += 2;
    }
    if (counting) at(counts)[item] = n;
  }
};

/// Items: pairs. How many nodes and edges of the first body look at the second.
struct PairWork {
  ModelView model;
  Pointer<const unsigned long long> pairs;
  Pointer<Count> nodes, edges;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t pair) const {
    const auto a = static_cast<int>(at(pairs)[pair] >> 32), b = static_cast<int>(at(pairs)[pair] & 0xffffffffu);
    at(nodes)[pair] = at(model.bodies)[a].n_surface_nodes;
    at(edges)[pair] = a < b ? at(model.bodies)[a].n_edges : 0;
  }
};

/// Candidate triangles of body b for a point of body a; a visitor is called with each, ascending.
template <class Visitor>
HOUSE_HOST_DEVICE inline void visit_triangles(const Access& at, const SearchView& view, int a, int node, int b,
                                              const Visitor& visit) {
  const Eigen::Vector3d p = view.node(at, a, node);
  const BoxRecord own = box_at(p);
  if (!boxes_near(own, at(view.boxes)[b], view.reach)) return;
  const SkinView skin = skin_of(at, view.model, b);
  for (int t = 0; t < at(view.model.bodies)[b].n_triangles; ++t) {
    const TriangleNow now(skin, at(view.x), t);
    BoxRecord box = box_at(now.x[0]);
    grow(box, now.x[1]), grow(box, now.x[2]);
    if (!boxes_near(box, own, view.reach) || !boxes_near(box, at(view.boxes)[a], view.reach)) continue;
    const double height = now.area_vector.normalized().dot(p - now.x[0]);
    if (height > view.reach || height < -view.reach) continue;
    if (closest_on_triangle(p, now.x[0], now.x[1], now.x[2], now.area_vector).distance2 > view.reach * view.reach) {
      continue;
    }
    visit(t);
  }
}

/// Finds the keys. Items: node work, then edge work, then surface nodes of all bodies times planes. Counts keys [item],
/// or writes keys and their numbers of triangles from offsets [item] on.
struct FindKeys {
  SearchView view;
  Pointer<const unsigned long long> pairs;
  Pointer<const Count> node_offsets, edge_offsets;  ///< [n_pairs + 1]
  std::int64_t n_pairs, n_node_items, n_edge_items;
  Pointer<Count> counts;
  Pointer<const Count> offsets;
  Pointer<ContactKey> keys;
  Pointer<int> n_triangles;
  bool counting;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    Count next = counting ? 0 : at(offsets)[item];
    if (item < n_node_items) {
      node_keys(at, item, next);
    } else if (item < n_node_items + n_edge_items) {
      edge_keys(at, item - n_node_items, next);
    } else {
      plane_keys(at, item - n_node_items - n_edge_items, next);
    }
    if (counting) at(counts)[item] = next;
  }

 private:
  HOUSE_HOST_DEVICE void put(const Access& at, const ContactKey& key, int triangles, Count& next) const {
    if (!counting) at(keys)[next] = key, at(n_triangles)[next] = triangles;
    ++next;
  }

  HOUSE_HOST_DEVICE void node_keys(const Access& at, std::int64_t item, Count& next) const {
    const std::int64_t pair = part_of(at(node_offsets), n_pairs, item);
    const auto a = static_cast<int>(at(pairs)[pair] >> 32), b = static_cast<int>(at(pairs)[pair] & 0xffffffffu);
    const int node = view.surface_node(at, a, item - at(node_offsets)[pair]);
    int count = 0;
    visit_triangles(at, view, a, node, b, [&](int) { ++count; });
    if (count > 0) put(at, {a, b, node, -1}, count, next);
  }

  HOUSE_HOST_DEVICE void edge_keys(const Access& at, std::int64_t item, Count& next) const {
    const std::int64_t pair = part_of(at(edge_offsets), n_pairs, item);
    const auto a = static_cast<int>(at(pairs)[pair] >> 32), b = static_cast<int>(at(pairs)[pair] & 0xffffffffu);
    const auto own = static_cast<int>(item - at(edge_offsets)[pair]);
    const SkinView skin_a = skin_of(at, view.model, a), skin_b = skin_of(at, view.model, b);
    if (!skin_a.edges[own].sharp) return;
    const EdgeNow edge_a(skin_a, at(view.x), own);
    BoxRecord box_a = box_at(edge_a.x[0]);
    grow(box_a, edge_a.x[1]);
    if (!boxes_near(box_a, at(view.boxes)[b], view.reach)) return;
    for (int other = 0; other < at(view.model.bodies)[b].n_edges; ++other) {
      if (!skin_b.edges[other].sharp) continue;
      const EdgeNow edge_b(skin_b, at(view.x), other);
      BoxRecord box_b = box_at(edge_b.x[0]);
      grow(box_b, edge_b.x[1]);
      if (!boxes_near(box_b, at(view.boxes)[a], view.reach) || !boxes_near(box_a, box_b, view.reach)) continue;
      if (segment_distance2(edge_a.x[0], edge_a.x[1], edge_b.x[0], edge_b.x[1]) > view.reach * view.reach) continue;
      put(at, {a, b, own, other}, 0, next);
    }
  }

  HOUSE_HOST_DEVICE void plane_keys(const Access& at, std::int64_t item, Count& next) const {
    const auto number = static_cast<int>(item % view.n_planes);
    const std::int64_t row = item / view.n_planes;
    const auto a = static_cast<int>(part_of(at(view.surface_rows), view.model.n_bodies, row));
    const int node = view.surface_node(at, a, row - at(view.surface_rows)[a]);
    const PlaneRecord& record = at(view.planes)[number];
    if (at(view.model.bodies)[a].is_sleeper ? !record.touches_sleeper : !record.touches_stones) return;
    const PlaneNow plane(record);
    const Eigen::Vector3d point = plane.point + view.time * plane.velocity;
    if (plane.normal.dot(view.node(at, a, node) - point) > view.plane_reach) return;
    put(at, {a, ~number, node, -1}, 0, next);
  }
};

/// Items: entries of the sorted list. Writes the triangles of the node entries.
struct FillTriangles {
  SearchView view;
  Pointer<const ContactKey> keys;
  Pointer<const int> offsets;
  Pointer<int> triangles;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t entry) const {
    const ContactKey key = at(keys)[entry];
    if (key.is_plane() || key.is_edge_pair()) return;
    int* next = at(triangles) + at(offsets)[entry];
    visit_triangles(at, view, key.body_a, key.feature_a, key.body_b, [&](int triangle) { *next++ = triangle; });
  }
};

}  // namespace qdem::device
