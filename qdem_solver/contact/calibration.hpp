// Contact stiffness and damping from what is known of a contact: restitution, duration, Hertz's law.
#pragma once

namespace qdem {

/// Two bodies that meet in one point under F = max(0, k delta - c v), which pushes but never pulls: an impact ends when
/// the force does, before the bodies are apart. With zeta = c/(2 sqrt(m k)), m their reduced mass and s = sqrt(1 -
/// zeta^2) the contact lasts (pi - atan2(2 zeta s, 1 - 2 zeta^2))/(s sqrt(k/m)). Source: Schwager and Poeschel 2007,
/// Granular Matter 9, 465.
///
/// Coefficient of restitution for a damping ratio in [0, 1].
double restitution_of(double damping_ratio);

/// The damping ratio with that restitution, a restitution from least_restitution() to 1.
double damping_ratio_for(double restitution);

/// Least restitution that a damping ratio below 1 reaches.
double least_restitution();

/// Normal stiffness [N/m] with which two bodies of `reduced_mass` [kg] touch for `contact_time` [s].
double stiffness_for(double contact_time, double reduced_mass, double damping_ratio);

/// Tangent stiffness dF/d delta [N/m] of Hertz's law between like bodies of radius `radius` [m] against a plane, at
/// `load` [N]: (6 E*^2 R F)^(1/3) with 1/E* = 2 (1 - nu^2)/E.
double hertz_tangent(double young, double poisson, double radius, double load);

}  // namespace qdem
