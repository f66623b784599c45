// A state in device memory.
#pragma once

#include <algorithm>
#include <memory>

#include "qdem_solver/engine/device/candidate_search.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem::device {

/// Arrays of one State. What State::resident points to; never changed while more than one State does so.
template <class Backend>
struct Resident : Residence {
  std::uint64_t owner = 0;    ///< the stepper that made it
  std::uint64_t version = 0;  ///< told apart from all others of its owner
  int axis = 0;               ///< along which the bodies are spread most when it was made
  Buffer<Backend, double> x, v, a;
  Buffer<Backend, double> slip;    ///< [entry][3]
  Buffer<Backend, double> travel;  ///< of every body, see ContactState
  std::shared_ptr<const CandidateArrays<Backend>> list;

  MotionView motion() { return {x.data(), v.data(), a.data()}; }
};

/// The axis along which the bodies of a state are spread most.
inline int longest_axis(const Model& model, const State& state) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    const Eigen::Vector3d x = state.position(model, body, 0);
    low = low.cwiseMin(x), high = high.cwiseMax(x);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

/// Takes motion and contact history to the device; the list is left to the caller.
template <class Backend>
std::shared_ptr<Resident<Backend>> upload(const Model& model, State& state) {
  auto resident = std::make_shared<Resident<Backend>>();
  state.contact.travel.resize(model.bodies.size(), 0.0);
  resident->axis = longest_axis(model, state);
  resident->x.put(state.x), resident->v.put(state.v), resident->a.put(state.a);
  resident->travel.put(state.contact.travel);
  resident->slip.resize(3 * state.contact.slip.size());
  if (!state.contact.slip.empty()) resident->slip.put(state.contact.slip[0].data(), 3 * state.contact.slip.size());
  return resident;
}

template <class Backend>
std::shared_ptr<Resident<Backend>> copy_of(const Resident<Backend>& other) {
  auto resident = std::make_shared<Resident<Backend>>();
  resident->owner = other.owner, resident->axis = other.axis, resident->list = other.list;
  resident->x = other.x.copy(), resident->v = other.v.copy(), resident->a = other.a.copy();
  resident->slip = other.slip.copy(), resident->travel = other.travel.copy();
  return resident;
}

/// Brings motion and contact history back.
template <class Backend>
void download(const Resident<Backend>& resident, State& state) {
  resident.x.get(state.x.data()), resident.v.get(state.v.data()), resident.a.get(state.a.data());
  resident.travel.get(state.contact.travel.data());
  state.contact.slip.resize(resident.slip.size() / 3);
  if (!state.contact.slip.empty()) resident.slip.get(state.contact.slip[0].data());
}

/// Brings a new list back.
template <class Backend>
void download_list(const CandidateArrays<Backend>& list, ContactState& contact) {
  contact.keys = list.keys.get();
  contact.triangle_offsets = list.triangle_offsets.get();
  contact.triangles = list.triangles.get();
  contact.list_id = candidate_list_id(contact);
}

}  // namespace qdem::device
