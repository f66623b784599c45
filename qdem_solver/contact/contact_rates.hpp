// How stiff the contacts of a candidate list are against the masses they act on.
#pragma once

#include <optional>
#include <vector>

#include "qdem_solver/contact/body_skin.hpp"
#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/contact/entry_laws.hpp"
#include "qdem_solver/contact/rigid_body.hpp"

namespace qdem {

/// Adds up the candidates of a list that are within `gap` of touching, every one taken as touching. Use once: add()
/// every entry, then result().
///
/// A contact of stiffness k between bodies a and b has the energy k/2 |J_a u_a - J_b u_b|^2 <= k (|J_a u_a|^2 + |J_b
/// u_b|^2), so that twice its stiffness may be given to either body alone; against a plane it is the body's alone. The
/// same holds of its dashpot. A sphere's tangential force moves its particle by u and turns its body by theta: |u +
/// theta x r|^2 <= (1 + s) |u|^2 + (1 + 1/s) |theta x r|^2 for any s > 0, so that one part counts for the particle, the
/// other for the body's turning. For a rigid body J M^-1 J^T = 1/m + [r] I^-1 [r]^T, [r] the cross product with the
/// point's arm; for particles, row sums bound it (Gershgorin).
class ContactRateSums {
 public:
  ContactRateSums(const Model& model, const std::vector<BodySkin>& skins, const EntryLaws& laws, const State& state,
                  double gap);
  void add(std::size_t entry);
  std::vector<ContactRates> result() const;

 private:
  /// Particles of one body that an entry acts on.
  struct Share {
    int body;
    int n = 0;
    std::array<int, 3> nodes{};
    std::array<double, 3> weights{};
    double arm = 0.0;  ///< at which the tangential force turns the body beside moving the particle [m]
  };

  /// Where the force of an entry acts.
  struct Approach {
    Eigen::Vector3d point;
    Share share;
    std::optional<Share> other;                          ///< planes have none
    double rolling_radius = 0.0, rolling_inertia = 0.0;  ///< of spheres, see Rolling [m], [kg m2]
  };

  /// Nothing for an entry that is farther apart than the gap.
  std::optional<Approach> approach(std::size_t entry) const;
  std::optional<Approach> approach_of_spheres(const ContactKey& key) const;
  void add_share(const Share& share, const Eigen::Vector3d& point, const Rates& contact);
  void add_rolling(const Share& share, const Rates& couple);

  const std::vector<BodySkin>& skins_;
  const State& state_;
  const Model& model_;
  const EntryLaws& laws_;
  double gap_;
  std::vector<RigidBody> bodies_;
  std::vector<Rates> particles_;  ///< row sums, where component 0 of a particle lies in the state arrays
  std::vector<Rates> turning_;    ///< of every body: what particles move by as it turns as a whole
  std::vector<ContactRates> rates_;
};

}  // namespace qdem
