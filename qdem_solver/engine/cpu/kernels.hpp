// The loops that carry the cost, compiled once per instruction set and chosen at run time.
//
// Plain pointers and counts only: the files behind this header are compiled with different instruction sets, so nothing
// in them may instantiate a template that another file could instantiate as well.
#pragma once

#include <cstdint>

#include "qdem_solver/physics/bond_dissipation.hpp"
#include "qdem_solver/physics/quadruple_dissipation.hpp"

namespace qdem::cpu {

/// Elements shared by the bodies of a batch, quadruples or bonds, and their reference shape.
struct ElementView {
  int n_elements;
  int n_particles;        ///< of an element
  int n_shape;            ///< values of an element's shape
  const int* particles;   ///< [n_elements][n_particles]
  const double* shapes;   ///< [n_elements][n_shape]: rows of Dm^-1, or rest lengths
  const double* weights;  ///< volumes, or stiffness over E [n_elements]
  const int* adjacency_offsets;
  const int* adjacency_slots;
};

/// A material as every force law reads it.
struct ElementMaterial {
  QuadrupleMaterial quadruple;
  BondMaterial bond;
};

/// Eight bodies side by side: x, v, force are the batch's own parts of the arrays, [node][component][8].
struct LaneForces {
  ElementView elements;
  ElementMaterial material;
  const double* scale;  ///< [8]
  const double* x;
  const double* v;
  double* force;  ///< added to, element by element in ascending order
};

/// One block of a body's elements, see ElementBlocks; x, v [node][component].
struct BlockForces {
  ElementMaterial material;
  double scale;
  int n_groups, n_copies;
  const std::uint16_t* corners;  ///< [n_groups][corner][8]
  const double* numbers;         ///< [n_groups][value][8]
  const int* copies;             ///< node of each particle of the block
  const double* x;
  const double* v;
  double* records;  ///< [n_copies][8], scratch
  double* slots;    ///< [n_copies][4]: force on each particle by this block, and one value without meaning
};

/// x += dt (v + dt/2 a), v += dt a over `n` rows of `lanes` values.
struct Drift {
  double dt;
  int lanes;
  int n;
  double* x;
  double* v;
  const double* a;
};
struct DriftResult {
  double largest_move[8];  ///< of one value of each lane [m]
  double sum;              ///< of all |moves|: not finite when any of them is not
};

/// a_new = force / m + gravity, damped; v += dt/2 (a_new - a); a = a_new, over `n_nodes` nodes of `lanes` lanes, 1
/// or 8. All arrays reach to the next whole group of eight values.
struct Kick {
  double dt;
  double gravity[3];
  double local_damping, drag;
  int lanes;
  int n_nodes;
  const double* force;
  const double* inverse_mass;  ///< 0 for a held component and for spare lanes
  double* v;
  double* a;
};

/// Replaces the forces on the particles of a batch by those that make an undamped kick move the bodies with other
/// inertia (see Inertia) and damping. The acceleration a is split into a_rigid, its mass-weighted least-squares fit by
/// the free accelerations of a rigid body, and the rest, and so is the velocity. Both parts of a are scaled; the rigid
/// one has Cundall's damping, the other a drag, which has neither resultant nor moment: what rings inside a body does
/// not brake it. Spin is taken to be slow: the centripetal part counts as deformation.
struct ScaleInertia {
  double gravity[3];
  double local_damping;     ///< of rigid motion [-]
  double deformation_drag;  ///< [1/s]
  int lanes;
  int n_nodes;
  const double* volumes;      ///< [n_nodes], lumped, scale 1
  const double* mass_factor;  ///< [lanes], mass of a particle = this x its volume
  const double* rigid;        ///< [lanes], 1 / Inertia::rigid
  const double* deformation;  ///< [lanes], 1 / Inertia::deformation
  const double* free;         ///< [6][lanes], 1 for a free translation or rotation, 0 for a held one
  const double* x;
  const double* v;
  double* force;
};

/// Forces of one body gathered from its blocks: force[node] += sum of its copies' slots in ascending order.
struct Gather {
  const int* offsets;  ///< CSR: node -> copies
  const int* copies;
  int first, last;  ///< nodes
  const double* slots;
  double* force;
};

/// Loops over the elements of one force law.
struct ElementKernels {
  void (*lane_forces)(const LaneForces&);
  void (*block_forces)(const BlockForces&);
  void (*lane_power)(const LaneForces&, double* sums);  ///< dissipated by each of the eight bodies [W]; force unused
  double (*block_power)(const BlockForces&);            ///< by the elements of the block [W]; slots unused
};

struct Kernels {
  const char* instruction_set;
  ElementKernels quadruple, bond;
  DriftResult (*drift)(const Drift&);
  void (*kick)(const Kick&);
  void (*gather)(const Gather&);
  void (*scale_inertia)(const ScaleInertia&);
};

/// The best set that this processor runs.
const Kernels& kernels();

const Kernels& kernels_base();
#if defined(__x86_64__)
const Kernels& kernels_v3();  ///< AVX2 and FMA
const Kernels& kernels_v4();  ///< AVX-512
#endif

}  // namespace qdem::cpu
