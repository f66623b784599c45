// The candidate list in device memory, and how it is made there.
#pragma once

#include <memory>

#include "qdem_solver/engine/device/buffer.hpp"
#include "qdem_solver/engine/device/kernels/list_rows.hpp"
#include "qdem_solver/engine/device/kernels/search.hpp"
#include "qdem_solver/engine/device/tables.hpp"

namespace qdem::device {

template <class Backend>
struct CandidateArrays {
  Buffer<Backend, ContactKey> keys;
  Buffer<Backend, int> triangle_offsets, triangles, row_offsets;
  Buffer<Backend, unsigned> row_entries;

  ListView view() const {
    return {keys.data(),        triangle_offsets.data(), triangles.data(),
            row_offsets.data(), row_entries.data(),      static_cast<std::int64_t>(keys.size())};
  }
};

/// Where to look: positions, planes, and how far.
struct SearchRequest {
  Pointer<const double> x;
  Pointer<const PlaneRecord> planes;
  int n_planes;
  double reach, plane_reach;  ///< [m]
  double time;                ///< [s]
  int axis;                   ///< along which bodies are swept; any gives the same list
};

/// Makes candidate lists. The host waits for counts, which are the sizes of what comes next: several times a list,
/// never in a step that keeps its list.
template <class Backend>
class CandidateSearch {
 public:
  template <class T>
  using Array = Buffer<Backend, T>;
  using List = std::shared_ptr<const CandidateArrays<Backend>>;

  /// `model` must outlive the search.
  CandidateSearch(Backend& backend, const ModelView& model, const Tables& tables)
      : backend_(backend),
        model_(model),
        n_rows_(tables.n_rows),
        n_surface_nodes_(tables.surface_rows.back()),
        surface_rows_(tables.surface_rows) {}

  List find(const SearchRequest& request) {
    Array<BoxRecord> boxes(model_.n_bodies);
    SearchView view{model_,           request.x,           request.planes,
                    request.n_planes, boxes.data(),        surface_rows_.data(),
                    request.reach,    request.plane_reach, request.time};
    const Array<unsigned long long> pairs = near_pairs(view, request.axis, boxes);
    auto list = std::make_shared<CandidateArrays<Backend>>();
    find_keys(view, pairs, *list);
    const auto n = static_cast<std::int64_t>(list->keys.size());
    list->triangles.resize(list->triangle_offsets.value(n));
    backend_.run(FillTriangles{view, list->keys.data(), list->triangle_offsets.data(), list->triangles.data()}, n);
    add_rows(*list);
    return list;
  }

  /// The list that a host state holds.
  List from_host(const ContactState& contact) {
    auto list = std::make_shared<CandidateArrays<Backend>>();
    list->keys.put(contact.keys);
    list->triangle_offsets.put(contact.triangle_offsets);
    list->triangles.put(contact.triangles);
    add_rows(*list);
    return list;
  }

 private:
  /// Runs a counting kernel; what it returns are the offsets of its items and, last, the sum.
  template <class Kernel>
  Array<Count> count(Kernel kernel, std::int64_t n_items) {
    Array<Count> counts(n_items + 1);
    kernel.counting = true, kernel.counts = counts.data();
    backend_.run(kernel, n_items);
    backend_.scan(counts.data(), n_items + 1);
    return counts;
  }

  Array<unsigned long long> near_pairs(const SearchView& view, int axis, Array<BoxRecord>& boxes) {
    const std::int64_t n = model_.n_bodies;
    Array<double> low(n);
    Array<int> order(n);
    backend_.run(BodyBoxes{view, axis, boxes.data(), low.data(), order.data()}, n);
    backend_.sort_by_key(low.data(), order.data(), n);
    SweepBodies sweep{view, axis, order.data(), {}, {}, {}, true};
    const Array<Count> offsets = count(sweep, n);
    Array<unsigned long long> pairs(offsets.value(n));
    sweep.counting = false, sweep.offsets = offsets.data(), sweep.pairs = pairs.data();
    backend_.run(sweep, n);
    backend_.sort(pairs.data(), pairs.size());
    return pairs;
  }

  void find_keys(const SearchView& view, const Array<unsigned long long>& pairs, CandidateArrays<Backend>& list) {
    const auto n_pairs = static_cast<std::int64_t>(pairs.size());
    Array<Count> nodes(n_pairs + 1), edges(n_pairs + 1);
    backend_.run(PairWork{model_, pairs.data(), nodes.data(), edges.data()}, n_pairs);
    backend_.scan(nodes.data(), n_pairs + 1);
    backend_.scan(edges.data(), n_pairs + 1);
    FindKeys kernel{view, pairs.data(), nodes.data(), edges.data(), n_pairs, nodes.value(n_pairs), edges.value(n_pairs),
                    {},   {},           {},           {},           true};
    const std::int64_t n_items = kernel.n_node_items + kernel.n_edge_items + n_surface_nodes_ * view.n_planes;
    const Array<Count> offsets = count(kernel, n_items);
    const std::int64_t n = offsets.value(n_items);
    list.keys.resize(n), list.triangle_offsets.resize(n + 1);
    kernel.counting = false, kernel.offsets = offsets.data();
    kernel.keys = list.keys.data(), kernel.n_triangles = list.triangle_offsets.data();
    backend_.run(kernel, n_items);
    backend_.sort_by_key(list.keys.data(), list.triangle_offsets.data(), n);
    backend_.scan(list.triangle_offsets.data(), n + 1);
  }

  /// Sorts who acts on whom by particle.
  void add_rows(CandidateArrays<Backend>& list) {
    const auto n_entries = static_cast<std::int64_t>(list.keys.size());
    TouchedRows kernel{model_, list.view(), {}, {}, {}, true};
    const Array<Count> offsets = count(kernel, n_entries);
    Array<unsigned long long> rows(offsets.value(n_entries));
    kernel.counting = false, kernel.offsets = offsets.data(), kernel.rows = rows.data();
    backend_.run(kernel, n_entries);
    backend_.sort(rows.data(), rows.size());
    const std::int64_t n = backend_.unique(rows.data(), rows.size());
    list.row_offsets.resize(n_rows_ + 1), list.row_entries.resize(n);
    backend_.run(RowOffsets{rows.data(), n, list.row_offsets.data()}, n_rows_ + 1);
    backend_.run(RowEntries{rows.data(), list.row_entries.data()}, n);
  }

  Backend& backend_;
  ModelView model_;
  std::int64_t n_rows_, n_surface_nodes_;
  Array<std::int64_t> surface_rows_;
};

}  // namespace qdem::device
