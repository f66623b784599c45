// How stiff and how damped a part of the system is against its masses.
#pragma once

namespace qdem {

/// Upper bounds of stiffness and damping over mass of one part of the system: the largest eigenvalues of M^-1 K [1/s2]
/// and M^-1 C [1/s].
struct Rates {
  double stiffness = 0.0;
  double damping = 0.0;
};

/// Of two parts that act on the same masses.
inline Rates operator+(const Rates& p, const Rates& q) {
  return {p.stiffness + q.stiffness, p.damping + q.damping};
}

/// The larger of each.
inline Rates larger(const Rates& p, const Rates& q) {
  return {p.stiffness > q.stiffness ? p.stiffness : q.stiffness, p.damping > q.damping ? p.damping : q.damping};
}

}  // namespace qdem
