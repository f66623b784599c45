// Which contact law a candidate follows: surfaces may have a viscoelastic layer behind them.
#pragma once

#include <array>
#include <vector>

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Two Voigt elements in series as one: k = k1 k2/(k1 + k2), c = c1 (k2/(k1 + k2))^2 + c2 (k1/(k1 + k2))^2. Exact at
/// rest, for equal c/k, and to first order in omega (c1 + c2)/(k1 + k2); derived here from the complex stiffness. A
/// rigid one leaves the other as it is; the footprint is the first one's that has one.
Bearing in_series(const Bearing& p, const Bearing& q);

/// A rigid disc of this radius [m] on an elastic half-space, per contact point. Vertical: Lysmer's analogue, k = 4 G
/// r/(1 - nu), c = 3.4 r^2 sqrt(rho G)/(1 - nu) (Lysmer and Richart 1966, J. Soil Mech. Found. Div. 92). Along the
/// surface: k = 8 G r/(2 - nu), c = 4.6 r^2 sqrt(rho G)/(2 - nu) (Newmark and Rosenblueth 1971).
Bearing half_space(const Material& ground, double radius);

/// The law of contact points behind which a bearing lies. The contact's own dashpot stays the same share of its forces:
/// its damping ratio is lowered by (k/k_n)^1.5.
ContactLaw in_series(const ContactLaw& law, const Bearing& bearing);

/// Laws of a model's candidates. Knows once which particles, triangles and edges of the pad body lie on its bottom.
class EntryLaws {
 public:
  /// The model must outlive the object.
  explicit EntryLaws(const Model& model);

  /// Takes over the model's contact law and bearings as they are now.
  void refresh();
  /// Law of an entry of a candidate list. A point of another body counts as on the pad body's bottom when its
  /// candidate triangles reach it.
  const ContactLaw& of(const ContactState& contact, std::size_t entry) const;
  bool is_lined(const ContactState& contact, std::size_t entry) const;

 private:
  bool touches_ground(const ContactKey& key) const;

  const Model& model_;
  std::vector<char> nodes_, triangles_, edges_;  ///< of the pad body: on its bottom
  bool has_ground_ = false;
  ContactLaw lined_;
  std::array<ContactLaw, 2> of_ground_;              ///< of bodies of kind ground for bare and for lined particles
  std::vector<std::array<ContactLaw, 2>> of_plane_;  ///< of every plane for bare and for lined particles
};

}  // namespace qdem
