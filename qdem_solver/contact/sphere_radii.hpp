// How large the contact spheres of a body are, and whether they close its skin.
#pragma once

#include <vector>

#include "qdem_solver/model/model.hpp"

namespace qdem {

/// Radius of the sphere around every node of a template [m], the same at every scale; 0 for nodes inside.
std::vector<double> sphere_radii(const ContactLaw& law, const Template& shape);

/// Share of all bodies' skin triangles of which some part lies outside the spheres of their corners: a sharp corner may
/// pass there. A flat lattice of equilateral triangles of edge h is closed from a radius of h/sqrt(3) on.
double open_facets(const Model& model);

}  // namespace qdem
