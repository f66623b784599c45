#include "qdem_solver/contact/contact_stage.hpp"

#include <xxhash.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/contact/candidates.hpp"
#include "qdem_solver/contact/contact_rates.hpp"
#include "qdem_solver/contact/entry_force.hpp"
#include "qdem_solver/contact/entry_laws.hpp"
#include "qdem_solver/contact/live_entries.hpp"
#include "qdem_solver/contact/sphere_contacts.hpp"

namespace qdem {
namespace {

/// Elongations of springs of the old list at the keys of the new one; a key without history starts unstretched.
std::vector<Eigen::Vector3d> carried(const std::vector<ContactKey>& old_keys, const std::vector<Eigen::Vector3d>& old,
                                     const std::vector<ContactKey>& keys) {
  std::vector<Eigen::Vector3d> values(keys.size(), Eigen::Vector3d::Zero());
  std::size_t i = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    while (i < old_keys.size() && old_keys[i] < keys[k]) ++i;
    if (i < old_keys.size() && old_keys[i] == keys[k]) values[k] = old[i];
  }
  return values;
}

}  // namespace

double candidate_skin(const ContactLaw& law) {
  if (law.skin > 0) return law.skin;
  return law.rounding > 0 ? law.rounding : 1e-3;
}

std::uint64_t candidate_list_id(const ContactState& contact) {
  const auto keys = XXH3_64bits(contact.keys.data(), contact.keys.size() * sizeof(ContactKey));
  const auto hash = XXH3_64bits_withSeed(contact.triangles.data(), contact.triangles.size() * sizeof(int), keys);
  return hash == 0 ? 1 : hash;
}

struct ContactStage::Data {
  const Model& model;
  double skin;
  std::vector<BodySkin> skins;
  EntryLaws laws;
  std::optional<SphereContacts> spheres;  ///< none with facets

  // Scratch of the list with this id.
  std::uint64_t list_id = 0;
  std::vector<EntryForce> forces;
  LiveEntries live;
  std::vector<ContactPower> powers;  ///< of the chunks of `live`
  std::vector<double> wake;          ///< sum of both sides' travel below which an entry cannot touch [m]
  double last_travel = 0.0;
  std::int64_t last_step = -1;

  Data(const Model& m, double s) : model(m), skin(s), skins(make_skins(m)), laws(m) {
    if (m.contact.shape == ContactShape::sphere) spheres.emplace(model, skins);
  }

  double plane_travel(const State& state, const Plane& plane) const {
    return plane.velocity.norm() * std::abs(state.time - state.contact.rebuild_time);
  }

  /// Bound of how far any node or plane moved since the rebuild [m].
  double farthest(const State& state) const {
    double travel = 0.0;
    for (const double of_body : state.contact.travel) travel = std::max(travel, of_body);
    for (const Plane& plane : model.planes) travel = std::max(travel, plane_travel(state, plane));
    return travel;
  }

  /// Bound of how far the two sides of an entry moved against each other since the rebuild [m].
  double travel_of(const State& state, const ContactKey& key) const {
    const double other =
        key.is_plane() ? plane_travel(state, model.planes[~key.body_b]) : state.contact.travel[key.body_b];
    return state.contact.travel[key.body_a] + other;
  }

  /// A new list finds no side of the pad body's bottom that is deeper inside another body than it reaches. Rigid
  /// contacts never are; on a soft pad they may be.
  void check_lining(const State& state) const {
    const ContactState& contact = state.contact;
    if (model.lining.is_rigid() || list_id != contact.list_id) return;
    const double deepest = 4 * model.contact.rounding;
    for (const std::int64_t i : live.all()) {
      if (forces[i].overlap < deepest || contact.keys[i].is_plane() || !laws.is_lined(contact, i)) continue;
      std::ostringstream problem, where;
      problem << "the pad under the sleeper is pressed in by " << 1e3 * forces[i].overlap
              << " mm, deeper than contacts are followed (" << 1e3 * deepest << " mm)";
      where << "step " << state.step << ", t = " << state.time << " s, body '"
            << model.bodies[contact.keys[i].body_a].name << "' and body '" << model.bodies[contact.keys[i].body_b].name
            << "'";
      throw proto::Error(proto::ExitCode::numerics, problem.str(), where.str(),
                         "raise its footprint_m2 or bedding_modulus_n_per_m3, or [qdem.contact] rounding_m");
    }
  }

  void fit_scratch(const ContactState& contact) {
    if (list_id == contact.list_id && forces.size() == contact.keys.size()) return;
    forces.resize(contact.keys.size());
    wake.assign(contact.keys.size(), 0.0);
    live.clear(contact.keys.size(), skins.size());
    powers.resize(live.n_chunks());
    list_id = contact.list_id;
  }

  static double total_travel(const State& state) {
    return std::accumulate(state.contact.travel.begin(), state.contact.travel.end(), 0.0);
  }

  /// The wake travels hold along one motion only, not for a state from elsewhere, such as a restored one.
  bool wakes_hold(const State& state) const {
    return list_id == state.contact.list_id && total_travel(state) >= last_travel &&
           (state.step == last_step || state.step == last_step + 1);
  }

  void follow(const State& state) {
    if (!wakes_hold(state)) std::fill(wake.begin(), wake.end(), 0.0);
    last_travel = total_travel(state), last_step = state.step;
  }

  EntryForce push(State& state, std::size_t i, double dt) {
    ContactState& contact = state.contact;
    const ContactLaw& law = laws.of(contact, i);
    if (spheres) return spheres->push(law, state, i, dt);
    Eigen::Vector3d& slip = contact.slip[i];
    const ContactKey& key = contact.keys[i];
    const Motion motion{state.x.data(), state.v.data(), dt};
    const BodySkin& a = skins[key.body_a];
    if (key.is_plane()) {
      return push_on_plane(law, a, key.feature_a, model.planes[~key.body_b], state.time, motion, slip);
    }
    const BodySkin& b = skins[key.body_b];
    if (key.is_edge_pair()) return push_edges(law, a, key.feature_a, b, key.feature_b, motion, slip);
    const int* first = contact.triangles.data() + contact.triangle_offsets[i];
    const int* last = contact.triangles.data() + contact.triangle_offsets[i + 1];
    return push_node(law, a, key.feature_a, b, first, last, motion, slip);
  }
};

ContactStage::ContactStage(const Model& model) : data_(std::make_unique<Data>(model, candidate_skin(model.contact))) {}
ContactStage::~ContactStage() = default;

bool ContactStage::update_candidates(State& state, const std::vector<double>& moves) {
  Data& d = *data_;
  ContactState& contact = state.contact;
  contact.travel.resize(d.skins.size(), 0.0);
  for (std::size_t b = 0; b < moves.size(); ++b) contact.travel[b] += moves[b];
  if (contact.list_id != 0 && d.farthest(state) <= d.skin / 2) {
    d.fit_scratch(contact);
    return false;
  }
  d.check_lining(state);
  CandidateList list = find_candidates(d.model, d.skins, state.x.data(), d.skin, state.time);
  contact.slip = carried(contact.keys, contact.slip, list.keys);
  if (!contact.roll.empty()) contact.roll = carried(contact.keys, contact.roll, list.keys);
  contact.keys = std::move(list.keys);
  contact.triangle_offsets = std::move(list.triangle_offsets);
  contact.triangles = std::move(list.triangles);
  std::fill(contact.travel.begin(), contact.travel.end(), 0.0);
  contact.rebuild_time = state.time;
  ++contact.rebuilds;
  contact.list_id = candidate_list_id(contact);
  d.list_id = 0;  // an equal list of an earlier time has other wake travels
  d.fit_scratch(contact);
  return true;
}

ContactPower ContactStage::compute(State& state, double dt) {
  Data& d = *data_;
  ContactState& contact = state.contact;
  d.fit_scratch(contact);
  d.follow(state);
  d.laws.refresh();
  if (d.spheres) d.spheres->begin(state);
  const std::int64_t n_chunks = d.live.n_chunks();
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int64_t chunk = 0; chunk < n_chunks; ++chunk) {
    const auto [first, last] = d.live.chunk(chunk);
    std::int64_t* const live = d.live.begin_chunk(chunk);
    std::int64_t n_live = 0;
    ContactPower power;
    for (std::int64_t i = first; i < last; ++i) {
      const double travel = d.travel_of(state, contact.keys[i]);
      if (travel < d.wake[i]) continue;
      EntryForce force = d.push(state, i, dt);
      if (force.live) {
        d.forces[i] = force;
        power += force.dissipated;
        live[n_live++] = i;
      } else {
        d.wake[i] = travel + force.gap;
      }
    }
    d.live.end_chunk(chunk, n_live);
    d.powers[chunk] = power;
  }
  d.live.sort_by_body(contact.keys);
  if (d.spheres) d.spheres->end(state, d.live);
  ContactPower sum;
  for (const ContactPower& power : d.powers) sum += power;
  return sum;
}

void ContactStage::adopt(const State& state, std::vector<EntryForce> forces) {
  Data& d = *data_;
  d.list_id = 0;  // wake travels of an earlier list do not hold
  d.forces = std::move(forces);
  d.fit_scratch(state.contact);
  d.follow(state);
  for (std::int64_t chunk = 0; chunk < d.live.n_chunks(); ++chunk) {
    const auto [first, last] = d.live.chunk(chunk);
    std::int64_t* const live = d.live.begin_chunk(chunk);
    std::int64_t n_live = 0;
    for (std::int64_t i = first; i < last; ++i) {
      if (d.forces[i].live) live[n_live++] = i;
    }
    d.live.end_chunk(chunk, n_live);
  }
  d.live.sort_by_body(state.contact.keys);
}

void ContactStage::gather(int body, proto::Span<double> force) const {
  const Data& d = *data_;
  const BodySkin& skin = d.skins[body];
  const auto add = [&](int node, const Eigen::Vector3d& f) {
    double* p = force.data() + skin.offset + 3 * skin.stride * node;
    p[0] += f[0], p[skin.stride] += f[1], p[2 * skin.stride] += f[2];
  };
  for (const std::int64_t i : d.live.first_of(body)) {
    for (int k = 0; k < d.forces[i].n_a; ++k) add(d.forces[i].nodes_a[k], d.forces[i].force_a[k]);
  }
  for (const std::int64_t i : d.live.second_of(body)) {
    for (int k = 0; k < d.forces[i].n_b; ++k) add(d.forces[i].nodes_b[k], d.forces[i].force_b[k]);
  }
  if (d.spheres) d.spheres->add_couples(body, force);
}

std::vector<ContactRates> ContactStage::rates(const State& state, double gap) const {
  const Data& d = *data_;
  EntryLaws laws(d.model);
  ContactRateSums sums(d.model, d.skins, laws, state, gap);
  const bool asleep = d.wakes_hold(state);
  for (std::size_t i = 0; i < state.contact.keys.size(); ++i) {
    if (asleep && d.wake[i] - d.travel_of(state, state.contact.keys[i]) > gap) continue;
    sums.add(i);
  }
  return sums.result();
}

void ContactStage::for_each_live(const State& state, const LiveVisitor& visit) const {
  const Data& d = *data_;
  if (d.list_id != state.contact.list_id) return;
  for (const std::int64_t i : d.live.all()) {
    const double own_share = d.laws.of(state.contact, i).normal_stiffness / d.model.contact.normal_stiffness;
    visit(state.contact.keys[i], d.forces[i].nodes_a[0], own_share * d.forces[i].overlap);
  }
}

ContactReport ContactStage::report(const State& state) const {
  const Data& d = *data_;
  const ContactState& contact = state.contact;
  ContactReport report;
  report.candidates = static_cast<std::int64_t>(contact.keys.size());
  std::vector<std::set<int>> others(d.skins.size());
  if (d.list_id != contact.list_id) return report;
  for (const std::int64_t i : d.live.all()) {
    ++report.live;
    report.largest_penetration = std::max(report.largest_penetration, d.forces[i].overlap);
    report.elastic_energy += d.forces[i].energy;
    const ContactKey& key = contact.keys[i];
    if (d.laws.is_lined(contact, i)) ++report.on_lining;
    if (key.is_plane() && !d.model.planes[~key.body_b].bearing.is_rigid()) ++report.on_bearing;
    if (key.is_plane()) continue;
    others[key.body_a].insert(key.body_b);
    others[key.body_b].insert(key.body_a);
  }
  int n_stones = 0;
  for (std::size_t b = 0; b < others.size(); ++b) {
    if (d.model.bodies[b].kind != BodyKind::stone) continue;
    ++n_stones;
    report.coordination_number += static_cast<double>(others[b].size());
  }
  if (n_stones > 0) report.coordination_number /= n_stones;
  return report;
}

std::vector<PairForce> ContactStage::pair_forces(const State& state) const {
  const Data& d = *data_;
  if (d.list_id != state.contact.list_id) return {};
  std::map<std::pair<int, int>, PairForce> pairs;
  for (const std::int64_t i : d.live.all()) {
    const ContactKey& key = state.contact.keys[i];
    const EntryForce& entry = d.forces[i];
    Eigen::Vector3d on_a = Eigen::Vector3d::Zero();
    for (int k = 0; k < entry.n_a; ++k) on_a += entry.force_a[k];
    const bool in_order = key.is_plane() || key.body_a < key.body_b;
    const auto [a, b] = in_order ? std::make_pair(key.body_a, key.body_b) : std::make_pair(key.body_b, key.body_a);
    PairForce& pair = pairs[{a, b}];
    pair.body_a = a, pair.body_b = b;
    pair.force_a += in_order ? on_a : Eigen::Vector3d(-on_a);
    ++pair.n_contacts;
  }
  std::vector<PairForce> result;
  for (const auto& entry : pairs) result.push_back(entry.second);
  return result;
}

}  // namespace qdem
