#include "fem_solver/beam/beam_element.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace fem {
namespace {

// Bending in one plane: deflection and rotation (the slope without shear) from (deflection, rotation) of both ends.
struct PlaneShape {
  Eigen::Vector4d deflection, rotation, slope, curvature;
};

PlaneShape plane_shape(double s, double length, double phi) {
  const double l = length, f = 1 / (1 + phi);
  PlaneShape p;
  p.deflection << 1 - 3 * s * s + 2 * s * s * s + phi * (1 - s),
      l * (s - 2 * s * s + s * s * s + phi * (s - s * s) / 2), 3 * s * s - 2 * s * s * s + phi * s,
      l * (-s * s + s * s * s - phi * (s - s * s) / 2);
  p.slope << -6 * s + 6 * s * s - phi, l * (1 - 4 * s + 3 * s * s + phi * (1 - 2 * s) / 2), 6 * s - 6 * s * s + phi,
      l * (-2 * s + 3 * s * s - phi * (1 - 2 * s) / 2);
  p.rotation << 6 / l * (s * s - s), 1 - 4 * s + 3 * s * s + phi * (1 - s), 6 / l * (s - s * s),
      -2 * s + 3 * s * s + phi * s;
  p.curvature << 6 / l * (2 * s - 1), -4 + 6 * s - phi, 6 / l * (1 - 2 * s), -2 + 6 * s + phi;
  p.deflection *= f, p.slope *= f / l, p.rotation *= f, p.curvature *= f / l;
  return p;
}

// Places of (deflection, rotation) of both ends. A rotation about y turns z towards x: minus the slope of the plane
// x-z.
constexpr int lateral[4] = {1, 5, 7, 11}, vertical[4] = {2, 4, 8, 10};
constexpr double lateral_sign[4] = {1, 1, 1, 1}, vertical_sign[4] = {1, -1, 1, -1};

template <class Row>
void put(Row row, const Eigen::Vector4d& values, const int (&places)[4], const double (&signs)[4]) {
  for (int k = 0; k < 4; ++k) row[places[k]] = signs[k] * values[k];
}

double shear_parameter(double bending, double shear, double length) {
  return 12 * bending / (shear * length * length);
}

// Sum over Gauss points of the weight, exact to degree 7 on [0, 1].
template <class Term>
BeamElement::Matrix12 integrate(double length, const Term& term) {
  const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2)),
               outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
  const double points[4] = {-outer, -inner, inner, outer};
  const double heavy = (18 + std::sqrt(30.0)) / 36, light = (18 - std::sqrt(30.0)) / 36;
  const double weights[4] = {light, heavy, heavy, light};
  BeamElement::Matrix12 sum = BeamElement::Matrix12::Zero();
  for (int q = 0; q < 4; ++q) sum += weights[q] * length / 2 * term((1 + points[q]) / 2);
  return sum;
}

}  // namespace

BeamElement::BeamElement(const RailSection& section, const Material& material, double length) : length_(length) {
  const SectionProperties p = section.properties();
  const double e = material.young, g = material.shear_modulus(), rho = material.density;
  stiffness_ << e * p.area, section.shear_lateral * g * p.area, section.shear_vertical * g * p.area,
      g * section.torsion_constant, e * p.inertia_lateral, e * p.inertia_vertical;
  inertia_ << p.area, p.area, p.area, p.inertia_vertical + p.inertia_lateral, p.inertia_vertical, p.inertia_lateral;
  inertia_ *= rho;
  shear_lateral_ = shear_parameter(stiffness_[4], stiffness_[1], length);
  shear_vertical_ = shear_parameter(stiffness_[5], stiffness_[2], length);
}

BeamElement::Rows BeamElement::motion(double s) const {
  Rows rows = Rows::Zero();
  for (const int along : {0, 3}) rows(along, along) = 1 - s, rows(along, along + 6) = s;
  const PlaneShape y = plane_shape(s, length_, shear_lateral_), z = plane_shape(s, length_, shear_vertical_);
  put(rows.row(1), y.deflection, lateral, lateral_sign);
  put(rows.row(5), y.rotation, lateral, lateral_sign);
  put(rows.row(2), z.deflection, vertical, vertical_sign);
  put(rows.row(4), -z.rotation, vertical, vertical_sign);
  return rows;
}

BeamElement::Rows BeamElement::strain(double s) const {
  Rows rows = Rows::Zero();
  rows(0, 0) = rows(3, 3) = -1 / length_, rows(0, 6) = rows(3, 9) = 1 / length_;
  const PlaneShape y = plane_shape(s, length_, shear_lateral_), z = plane_shape(s, length_, shear_vertical_);
  put(rows.row(1), y.slope - y.rotation, lateral, lateral_sign);
  put(rows.row(2), z.slope - z.rotation, vertical, vertical_sign);
  put(rows.row(4), y.curvature, lateral, lateral_sign);
  put(rows.row(5), z.curvature, vertical, vertical_sign);
  return rows;
}

BeamElement::Matrix12 BeamElement::stiffness() const {
  return integrate(length_, [&](double s) -> Matrix12 {
    const Rows b = strain(s);
    return b.transpose() * stiffness_.asDiagonal() * b;
  });
}

BeamElement::Matrix12 BeamElement::mass() const {
  return integrate(length_, [&](double s) -> Matrix12 {
    const Rows n = motion(s);
    return n.transpose() * inertia_.asDiagonal() * n;
  });
}

double BeamElement::clamped_flexibility(double s) const {
  // Two parts that meet at the force, each clamped at its other end: stiffness of deflection and rotation there.
  const double before = s * length_, after = length_ - before;
  if (std::min(before, after) < 1e-9 * length_) return 0.0;
  Eigen::Matrix2d joint = Eigen::Matrix2d::Zero();
  const auto add = [&](double l, double side) {
    const double phi = shear_parameter(stiffness_[5], stiffness_[2], l), f = stiffness_[5] / (l * l * l * (1 + phi));
    joint += f * (Eigen::Matrix2d() << 12, side * 6 * l, side * 6 * l, (4 + phi) * l * l).finished();
  };
  add(before, -1), add(after, 1);
  return joint.inverse()(0, 0);
}

}  // namespace fem
