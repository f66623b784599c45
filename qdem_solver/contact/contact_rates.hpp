// How stiff the contacts of a candidate list are against the masses they act on.
#pragma once

#include <optional>
#include <vector>

#include "qdem_solver/contact/body_skin.hpp"
#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/contact/entry_laws.hpp"

namespace qdem {

/// Adds up the candidates of a list that are within `gap` of touching, every one taken as touching. Use once: add()
/// every entry, then result().
///
/// A contact of stiffness k between bodies a and b has the energy k/2 |J_a u_a - J_b u_b|^2 <= k (|J_a u_a|^2 + |J_b
/// u_b|^2), so that twice its stiffness may be given to either body alone; against a plane it is the body's alone. The
/// same holds of its dashpot. For a rigid body J M^-1 J^T = 1/m + [r] I^-1 [r]^T, [r] the cross product with the
/// point's arm; for particles, row sums bound it (Gershgorin).
class ContactRateSums {
 public:
  ContactRateSums(const Model& model, const std::vector<BodySkin>& skins, const EntryLaws& laws, const State& state,
                  double gap);
  void add(std::size_t entry);
  std::vector<ContactRates> result() const;

 private:
  struct RigidBody {
    Eigen::Vector3d centre;
    double inverse_mass;              ///< [1/kg]
    Eigen::Matrix3d inverse_inertia;  ///< about the centre [1/(kg m2)]
    /// Bound of how far a unit force at `point` moves it, times its unit inertia [1/kg].
    double mobility(const Eigen::Vector3d& point) const;
  };
  /// Particles of one body that an entry acts on.
  struct Share {
    int body;
    int n = 0;
    std::array<int, 3> nodes{};
    std::array<double, 3> weights{};
  };

  /// Where the force of an entry acts.
  struct Approach {
    Eigen::Vector3d point;
    Share share;
    std::optional<Share> other;  ///< planes have none
  };

  /// Nothing for an entry that is farther apart than the gap.
  std::optional<Approach> approach(std::size_t entry) const;
  void add_share(const Share& share, const Eigen::Vector3d& point, double stiffness, double damping);

  const std::vector<BodySkin>& skins_;
  const State& state_;
  const Model& model_;
  const EntryLaws& laws_;
  double gap_;
  std::vector<RigidBody> bodies_;
  std::vector<Rates> particles_;  ///< row sums, where component 0 of a particle lies in the state arrays
  std::vector<ContactRates> rates_;
};

}  // namespace qdem
