// The pads in device memory.
#pragma once

#include "qdem_solver/engine/device/buffer.hpp"
#include "qdem_solver/engine/device/kernels/pads.hpp"
#include "qdem_solver/engine/device/tables.hpp"
#include "qdem_solver/engine/engine.hpp"

namespace qdem::device {

template <class Backend>
class PadArrays {
 public:
  explicit PadArrays(const Model& model) : PadArrays(model, make_pad_tables(model)) {}

  std::int64_t n_values() const { return n_values_; }
  Buffer<Backend, double>& force() { return force_; }

  void set_reference(const std::vector<double>& values) { reference_.put(values); }

  /// Before the steps of a call. drive: nullptr without a rail.
  void begin(const State& state, const PadDrive* drive) {
    std::vector<double> force = state.pad_force;
    force.resize(n_values_, 0.0);
    force_.put(force);
    impulse_.put(std::vector<double>(n_values_, 0.0)), work_.put(std::vector<double>(n_values_, 0.0));
    change_.resize(n_values_);
    if (drive == nullptr) return;
    begin_.put(drive->begin.data(), drive->begin.size()), end_.put(drive->end.data(), drive->end.size());
  }

  PadSums sums() const { return {impulse_.get(), work_.get()}; }

  PadView view() {
    PadView view;
    view.axes = axes_.data(), view.laws = laws_.data();
    view.cell_offsets = cell_offsets_.data(), view.nodes = nodes_.data(), view.weights = weights_.data();
    view.node_offsets = node_offsets_.data(), view.cells = cells_.data(), view.cell_weights = cell_weights_.data();
    view.reference = reference_.data(), view.begin = begin_.data(), view.end = end_.data();
    view.force = force_.data(), view.change = change_.data();
    view.impulse = impulse_.data(), view.work = work_.data();
    view.values_at = values_at_, view.lanes = lanes_, view.body = body_, view.n_values = n_values_;
    return view;
  }

 private:
  PadArrays(const Model& model, const PadTables& tables)
      : n_values_(static_cast<int>(3 * model.pads.size())),
        body_(model.pad_body),
        lanes_(body_ < 0 ? 1 : model.stride(body_)),
        values_at_(body_ < 0 ? 0 : model.index(body_, 0)),
        axes_(tables.axes),
        laws_(tables.laws),
        cell_offsets_(tables.cell_offsets),
        nodes_(tables.nodes),
        weights_(tables.weights),
        node_offsets_(tables.node_offsets),
        cells_(tables.cells),
        cell_weights_(tables.cell_weights) {}

  template <class T>
  using Array = Buffer<Backend, T>;

  int n_values_, body_, lanes_;
  std::int64_t values_at_;
  Array<double> axes_;
  Array<proto::PadLaw> laws_;
  Array<int> cell_offsets_, nodes_;
  Array<double> weights_;
  Array<int> node_offsets_, cells_;
  Array<double> cell_weights_;
  Array<double> reference_, begin_, end_, force_, change_, impulse_, work_;
};

}  // namespace qdem::device
