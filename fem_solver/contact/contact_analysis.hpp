// One contact, solved: pressure, friction, creep-force curve.
#pragma once

#include <vector>

#include "fem_solver/contact/contact_case.hpp"
#include "fem_solver/contact/normal_patch.hpp"

namespace fem {

/// Shear at one creepage.
struct CurvePoint {
  Creepage creepage;
  ShearResultant force;
  double stick_share = 0.0;  ///< of the patch's area
};

struct ContactResult {
  PatchGrid grid;
  ContactGap gap;
  NormalSolution normal;
  PatchEllipse ellipse;         ///< fitted to the pressure
  double area = 0.0;            ///< of the patch [m2]
  TangentialSolution friction;  ///< rolling: slip over a step of one element; shift: whole slip [m]
  std::vector<Zone> zones;      ///< per element, along x first
  CurvePoint point;             ///< at the case's creepage, or of its shift
  std::vector<CurvePoint> curve;
};

/// Pressure from any small approach on: the one that the grid's larger side would have under the force.
NormalSolution first_guess(const PatchGrid& grid, const PairElasticity& pair, double force);

/// Fills in what follows from pressure and friction: ellipse, area, zones, point.
void evaluate(const ContactCase& input, ContactResult& result);

/// On half-spaces. Throws proto::Error: bad_data, numerics.
ContactResult analyse_contact(const ContactCase& input);

}  // namespace fem
