// What the contact candidates do, in device memory: scratch of one list.
#pragma once

#include "qdem_solver/engine/device/buffer.hpp"
#include "qdem_solver/engine/device/kernels/contact.hpp"

namespace qdem::device {

template <class Backend>
class EntryArrays {
 public:
  /// For a list of `n` entries, all of them awake.
  void reset(std::size_t n) {
    wake_.put(std::vector<double>(n, 0.0));
    live_.resize(n), nodes_.resize(5 * n), force_.resize(15 * n), overlap_.resize(n), energy_.resize(n);
  }

  EntryView view(Pointer<double> slip) {
    return {slip, wake_.data(), live_.data(), nodes_.data(), force_.data(), overlap_.data(), energy_.data()};
  }

  /// The last step's forces, one an entry.
  std::vector<EntryForce> forces() const {
    const std::size_t n = live_.size();
    const auto live = live_.get(), nodes = nodes_.get();
    const auto force = force_.get(), overlap = overlap_.get(), energy = energy_.get();
    std::vector<EntryForce> result(n);
    for (std::size_t i = 0; i < n; ++i) {
      EntryForce& entry = result[i];
      if (live[i] == 0) continue;
      entry.live = true, entry.overlap = overlap[i], entry.energy = energy[i];
      for (std::size_t k = 0; k < 5; ++k) {
        const int node = nodes[k * n + i];
        if (node < 0) continue;
        const Eigen::Vector3d f(force[3 * k * n + i], force[(3 * k + 1) * n + i], force[(3 * k + 2) * n + i]);
        if (k < 2) {
          entry.nodes_a[entry.n_a] = node, entry.force_a[entry.n_a++] = f;
        } else {
          entry.nodes_b[entry.n_b] = node, entry.force_b[entry.n_b++] = f;
        }
      }
    }
    return result;
  }

 private:
  Buffer<Backend, double> wake_, force_, overlap_, energy_;
  Buffer<Backend, int> live_, nodes_;
};

}  // namespace qdem::device
