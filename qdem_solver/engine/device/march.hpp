// The steps in device memory, for any backend.
#pragma once

#include <atomic>

#include "qdem_solver/engine/device/entry_arrays.hpp"
#include "qdem_solver/engine/device/kernels/drift.hpp"
#include "qdem_solver/engine/device/kernels/elements.hpp"
#include "qdem_solver/engine/device/kernels/relaxation.hpp"
#include "qdem_solver/engine/device/model_arrays.hpp"
#include "qdem_solver/engine/device/pad_arrays.hpp"
#include "qdem_solver/engine/device/resident.hpp"
#include "qdem_solver/engine/relaxation.hpp"
#include "qdem_solver/engine/stepper.hpp"

namespace qdem::device {

inline std::uint64_t next_owner() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Stepper on a backend. Holds the immutable model and scratch; all history is in the State and its Resident.
///
/// The steps of one call are queued without a look at the device. A step that finds the candidate list used up, or a
/// motion that is not finite, stops there: it and all later ones do nothing, until the host, after the last one, has
/// made a new list and queues the rest.
template <class Backend>
class March : public Stepper {
 public:
  /// The model must outlive it. `arguments`: of the backend.
  template <class... Arguments>
  explicit March(const Model& model, Arguments... arguments)
      : model_(model),
        backend_(arguments...),
        arrays_(model),
        view_(arrays_.view()),
        pads_(model),
        search_(backend_, view_, arrays_.tables()),
        skin_(candidate_skin(model.contact)),
        slots_(arrays_.tables().n_slots),
        moves_(arrays_.tables().n_chunks),
        clock_(1) {}

  void prepare(State& state) override {
    begin_call(state, 0.0, 1);
    state.resident.reset();
    take(state);
    if (farthest(state) > skin_ / 2) rebuild(state, state.time);
    state.pad_force.assign(pads_.n_values(), 0.0);
    pads_.begin(state, nullptr);
    contact_forces();
    particles();
    give_back(state);
  }

  PadSums advance(State& state, double dt, std::int64_t n_steps, const PadDrive* drive) override {
    begin_call(state, dt, n_steps);
    take(state);
    pads_.begin(state, drive);
    exchange_pad_forces(drive != nullptr);
    run_steps(state, drive != nullptr);
    state.pad_force = pads_.force().get();
    state.time = frame_.time(n_steps);
    give_back(state);
    return pads_.sums();
  }

  void set_pad_reference(std::vector<double> values) override { pads_.set_reference(values); }

  void show_contacts(const State& state, ContactStage& stage) const override { stage.adopt(state, entries_.forces()); }

 private:
  using Now = Resident<Backend>;
  using Arrays = CandidateArrays<Backend>;

  bool relaxing() const { return !model_.inertia.empty(); }

  void begin_call(const State& state, double dt, std::int64_t n_steps) {
    frame_ = {dt, state.time, n_steps};
    planes_.put(make_plane_records(model_));
    if (relaxing()) {
      inertia_.put(model_.inertia);
      force_.resize(model_.n_values), sums_.resize(BodySums::n_values * arrays_.tables().n_chunks);
      rigid_.resize(model_.bodies.size());
    }
    loads_ = make_loads(model_);
    clock_.put({Clock{}});
  }

  /// Makes the arrays of `state` the current ones, and this state's alone.
  void take(State& state) {
    const auto held = std::dynamic_pointer_cast<Now>(state.resident);
    state.resident.reset();
    const bool ours = held && held->owner == owner_ && state.contact.list_id != 0;
    const bool continues = ours && held->version == version_;
    if (!ours) {
      now_ = upload<Backend>(model_, state);
      now_->owner = owner_;
      now_->list = taken_list(state.contact);
    } else {
      now_ = held.use_count() > 1 ? copy_of(*held) : held;
    }
    now_->version = version_ = ++n_versions_;
    if (!continues) entries_.reset(now_->list->keys.size());
    if (state.contact.list_id == 0) rebuild(state, state.time);
    rebuild_time_ = state.contact.rebuild_time;
    for (auto* values : {&state.x, &state.v, &state.a}) Backend::spoil(*values);
  }

  std::shared_ptr<const Arrays> taken_list(const ContactState& contact) {
    if (contact.list_id != 0) return search_.from_host(contact);
    auto list = std::make_shared<Arrays>();  // for the slips of its keys only
    list->keys.put(contact.keys);
    return list;
  }

  void give_back(State& state) {
    download(*now_, state);
    state.resident = std::move(now_);
  }

  double farthest(const State& state) const {
    double travel = 0.0;
    for (const double of_body : state.contact.travel) travel = std::max(travel, of_body);
    for (const Plane& plane : model_.planes) {
      travel = std::max(travel, plane.velocity.norm() * std::abs(state.time - state.contact.rebuild_time));
    }
    return travel;
  }

  /// A new list for the positions and planes at `time`.
  void rebuild(State& state, double time) {
    const double reach = 2 * model_.contact.rounding + skin_;
    const auto old = now_->list;
    now_->list = search_.find({now_->x.data(), planes_.data(), static_cast<int>(planes_.size()), reach,
                               reach - model_.contact.rounding, time, now_->axis});
    const std::size_t n = now_->list->keys.size();
    Buffer<Backend, double> slip(3 * n);
    backend_.run(CarrySlip{now_->list->keys.data(), old->keys.data(), now_->slip.data(),
                           static_cast<std::int64_t>(old->keys.size()), slip.data()},
                 n);
    now_->slip = std::move(slip);
    now_->travel.put(std::vector<double>(model_.bodies.size(), 0.0));
    entries_.reset(n);
    state.contact.rebuild_time = time;
    ++state.contact.rebuilds;
    download_list(*now_->list, state.contact);
    rebuild_time_ = time;
  }

  void exchange_pad_forces(bool driven) {
    if (pads_.n_values() == 0 || (driven && relaxing())) return;
    const PadView pads = pads_.view();
    backend_.run(ExchangePadForces{{pads, now_->motion(), clock_.data(), frame_}, driven}, pads.n_values);
    backend_.run(AddPadChange{pads, view_.inverse_mass, now_->a.data()}, model_.shape(pads.body).n_nodes());
  }

  void run_steps(State& state, bool driven) {
    std::int64_t done = 0;
    while (done < frame_.n_steps) {
      backend_.repeat(frame_.n_steps - done, [&] {
        drift();
        forces_and_kick(driven);
      });
      Clock clock = clock_.value(0);
      state.step += clock.done - done;
      done = clock.done;
      if (clock.blown != 0) blow_up(state, done + 1);
      if (clock.stale == 0) continue;
      rebuild(state, frame_.time(done + 1));
      clock_.put({Clock{done, 0, 0, 0}});
      forces_and_kick(driven);
      ++done, ++state.step;
    }
  }

  [[noreturn]] void blow_up(State& state, std::int64_t step) {
    state.time = frame_.time(step);
    give_back(state);
    report_blow_up(model_, state);
  }

  void drift() {
    backend_.run(Drift{view_, now_->motion(), clock_.data(), frame_.dt, moves_.data()}, arrays_.n_chunk_items());
    backend_.run(Travel{view_, moves_.data(), planes_.data(), clock_.data(), now_->travel.data(), frame_, rebuild_time_,
                        skin_ / 2},
                 view_.n_bodies + static_cast<std::int64_t>(planes_.size()));
  }

  void forces_and_kick(bool driven) {
    contact_forces();
    if (driven) {
      backend_.run(PadForces{pads_.view(), now_->motion(), clock_.data(), frame_}, pads_.n_values());
    }
    particles();
    backend_.run(FinishStep{clock_.data()}, 1);
  }

  void contact_forces() {
    backend_.run(
        ContactForces{view_, planes_.data(), now_->list->view(), entries_.view(now_->slip.data()), now_->motion(),
                      now_->travel.data(), clock_.data(), model_.contact, frame_, rebuild_time_},
        static_cast<std::int64_t>(now_->list->keys.size()));
  }

  /// Elements, all sums, the kick.
  void particles() {
    Backend::forget(slots_.data(), slots_.size());
    elements<QuadrupleLaw>(view_.quadruple_blocks, arrays_.n_quadruple_items());
    elements<BondLaw>(view_.bond_blocks, arrays_.n_bond_items());
    const ParticleForces forces{view_,  now_->list->view(), entries_.view(now_->slip.data()), pads_.view(),
                                loads_, slots_.data()};
    const Kick kick{now_->motion(), view_.inverse_mass, loads_, frame_.dt};
    if (relaxing()) {
      relaxed_kick(forces, kick);
    } else {
      backend_.run(ForceAndKick{forces, kick, clock_.data()}, arrays_.n_node_items());
    }
  }

  template <class Law>
  void elements(Pointer<const WorkBlock> blocks, std::int64_t n_items) {
    backend_.run(ElementForces<Law>{view_, blocks, now_->x.data(), now_->v.data(), clock_.data(), slots_.data()},
                 n_items);
  }

  void relaxed_kick(const ParticleForces& forces, const Kick& kick) {
    const std::int64_t n_chunks = arrays_.tables().n_chunks;
    backend_.run(StoreForces{forces, clock_.data(), force_.data()}, arrays_.n_node_items());
    backend_.run(SumChunks{view_, now_->motion(), force_.data(), clock_.data(), sums_.data(), n_chunks},
                 arrays_.n_chunk_items());
    backend_.run(FitRigidMotion{view_, now_->x.data(), sums_.data(), clock_.data(), inertia_.data(), rigid_.data(),
                                loads_, model_.local_damping, n_chunks},
                 view_.n_bodies);
    backend_.run(RelaxedKick{view_, force_.data(), rigid_.data(), clock_.data(), kick,
                             relaxation_drag(model_.local_damping, frame_.dt)},
                 arrays_.n_node_items());
  }

  const Model& model_;
  Backend backend_;
  ModelArrays<Backend> arrays_;
  ModelView view_;
  PadArrays<Backend> pads_;
  CandidateSearch<Backend> search_;
  double skin_;
  std::uint64_t owner_ = next_owner(), version_ = 0, n_versions_ = 0;

  // Of the current call.
  std::shared_ptr<Now> now_;
  StepFrame frame_{};
  Loads loads_{};
  double rebuild_time_ = 0.0;

  // Scratch.
  EntryArrays<Backend> entries_;
  Buffer<Backend, double> slots_, moves_;
  Buffer<Backend, Clock> clock_;
  Buffer<Backend, PlaneRecord> planes_;
  Buffer<Backend, Inertia> inertia_;
  Buffer<Backend, double> force_, sums_;  ///< while relaxing
  Buffer<Backend, RigidMotion> rigid_;    ///< while relaxing
};

}  // namespace qdem::device
