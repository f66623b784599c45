// Hertz contact of two bodies with crossed principal curvatures (Johnson, Contact Mechanics, chapter 4).
#pragma once

namespace fem {

/// Elastic half of a pair in contact.
struct ElasticBody {
  double young = 210e9;  ///< [Pa]
  double poisson = 0.3;
};

/// Solution at one load.
struct HertzState {
  double semi_axis_long = 0.0;   ///< a >= b [m]
  double semi_axis_short = 0.0;  ///< b [m]
  double peak_pressure = 0.0;    ///< [Pa]
  double approach = 0.0;         ///< delta [m]
  double stiffness = 0.0;        ///< dF/d delta = 1.5 F/delta [N/m]
};

/// Wheel of radius `radius_1` rolling on a rail whose crown has `radius_2` across; both positive [m].
class Hertz {
 public:
  /// Solves the ellipse's shape once. Throws proto::Error (bad_data) for radii or moduli that are not positive.
  Hertz(double radius_1, double radius_2, const ElasticBody& body_1, const ElasticBody& body_2);

  /// F = coefficient * delta^1.5 [N/m^1.5].
  double coefficient() const { return coefficient_; }

  HertzState at_force(double force) const;

 private:
  double contact_modulus_, curvature_, axis_ratio_, parameter_, coefficient_;
};

}  // namespace fem
