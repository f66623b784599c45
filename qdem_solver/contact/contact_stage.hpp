// Contact between the surfaces of different bodies, and with planes.
#pragma once

#include <functional>
#include <memory>

#include "proto/span.hpp"
#include "qdem_solver/contact/rates.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Figures of the contacts at one instant.
struct ContactReport {
  std::int64_t candidates = 0;       ///< entries of the candidate list
  std::int64_t live = 0;             ///< contacts that carry a force
  std::int64_t on_lining = 0;        ///< of these, with the pad body's lined bottom
  std::int64_t on_bearing = 0;       ///< of these, with planes that have a bearing
  double coordination_number = 0.0;  ///< mean number of other bodies that a stone touches [-]
  double largest_penetration = 0.0;  ///< of the rounded surfaces [m]
  double elastic_energy = 0.0;       ///< normal and tangential springs [J]
};

/// Resultant of all contacts between two bodies.
struct PairForce {
  int body_a = 0, body_b = 0;                         ///< a < b; b < 0: plane ~b
  int n_contacts = 0;                                 ///< places at which they touch
  Eigen::Vector3d force_a = Eigen::Vector3d::Zero();  ///< on a; minus it acts on b [N]
};

/// Upper bounds of what contacts add to one body.
struct ContactRates {
  Rates particle;  ///< largest row sums over its particles
  Rates rigid;     ///< of its motion as a rigid body
};

/// Gap below which bodies that hardly move are taken as touching [m].
inline double near_gap(const ContactLaw& law) {
  return 0.1 * law.rounding;
}

/// How much farther than touching the candidate list reaches [m].
double candidate_skin(const ContactLaw& law);

/// ContactState::list_id of a list; never 0.
std::uint64_t candidate_list_id(const ContactState& contact);

struct EntryForce;

/// Finds contacts and computes their forces. Holds scratch only; all history lives in the State.
/// Every sum is taken in an order fixed by the candidate list, so results do not depend on the number of threads.
class ContactStage {
 public:
  /// The model must outlive the stage; its contact law (not skin, shape and radii), bearings, and its planes' points and
  /// velocities may change between calls, nothing else.
  explicit ContactStage(const Model& model);
  ~ContactStage();

  /// Takes `moves` [m], of each body an upper bound of how far any of its nodes moved since the last call (empty: none
  /// did); rebuilds the candidate list when a body or plane has moved by more than half the skin. Returns whether it
  /// rebuilt. Slip and roll of surviving keys are kept. Throws proto::Error (numerics) where the pad body's lining is
  /// pressed in deeper than a list reaches.
  bool update_candidates(State& state, const std::vector<double>& moves = {});

  /// Forces of all contacts at positions state.x and velocities state.v; advances slip and roll by dt [s]. Runs with
  /// the calling program's OpenMP threads. Returns what the contacts dissipate.
  ContactPower compute(State& state, double dt);

  /// Takes the forces of the state's list, one an entry, as somebody else computed them: gather(), rates() and report()
  /// are then of these.
  void adopt(const State& state, std::vector<EntryForce> forces);

  /// Adds the contact forces on the nodes of `body` to `force` [N], an array laid out like state.x.
  void gather(int body, proto::Span<double> force) const;

  /// The bounds of every body if all candidates of the current list touched that are within `gap` [m] of it.
  std::vector<ContactRates> rates(const State& state, double gap) const;

  ContactReport report(const State& state) const;

  /// The pairs that touch in `state`, whose forces were computed last; ascending by (a, b).
  std::vector<PairForce> pair_forces(const State& state) const;

  /// A contact that carries a force: its key, the first of its nodes on body a, its overlap without
  /// what a layer behind it gives way [m].
  using LiveVisitor = std::function<void(const ContactKey&, int node, double overlap)>;
  /// Visits them in the order of the list.
  void for_each_live(const State& state, const LiveVisitor& visit) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace qdem
