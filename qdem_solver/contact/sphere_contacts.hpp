// The contacts of spheres between all bodies: what they need of the bodies, and the couples they leave on them.
#pragma once

#include <optional>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/contact/entry_force.hpp"
#include "qdem_solver/contact/live_entries.hpp"
#include "qdem_solver/contact/rigid_body.hpp"
#include "qdem_solver/contact/sphere_pair.hpp"

namespace qdem {

/// Scratch of one step: begin(), push() for every entry, end(); then add_couples(). push() may be called by several
/// threads for different entries.
///
/// The spheres of a body turn as the body does, taken as rigid (RigidBody::spin), as in a clump of spheres; so do the
/// couples act on it.
class SphereContacts {
 public:
  /// Both must outlive the object.
  SphereContacts(const Model& model, const std::vector<BodySkin>& skins) : model_(model), skins_(skins) {}

  /// Takes positions and velocities; makes room for the entries of the state's list.
  void begin(State& state);
  /// Force of one entry, whose law is given; advances its slip and roll by dt [s].
  EntryForce push(const ContactLaw& law, State& state, std::size_t entry, double dt);
  /// Sums up the couples of the live entries of each body.
  void end(const State& state, const LiveEntries& live);
  /// Adds the forces of the couples on `body` [N], an array laid out like State::x.
  void add_couples(int body, proto::Span<double> force) const;

 private:
  struct Couples {
    Eigen::Vector3d on_a, on_b;  ///< [N m]
  };
  bool turning() const;  ///< do couples occur?
  ContactSphere sphere(const State& state, int body, int node) const;

  const Model& model_;
  const std::vector<BodySkin>& skins_;
  std::vector<std::optional<RigidBody>> bodies_;  ///< of bodies that have candidates
  std::vector<Eigen::Vector3d> spins_;
  std::vector<Couples> couples_;      ///< of every entry
  std::vector<double> couple_force_;  ///< laid out like State::x; of bodies with live entries
  std::vector<char> has_couple_;
};

}  // namespace qdem
