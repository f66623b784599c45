// Everything about a QDEM problem that does not change while it is integrated.
//
// A *template* is a tetrahedral mesh in its own frame; a *body* is a scaled instance of one. Bodies of one template and
// one material stand side by side in a *batch*: value (node i, component c) of the body in lane l lies at
//     batch.offset + (i * 3 + c) * batch.lanes + l
// of every state array, so that one vector instruction serves as many bodies as it has lanes, and the reference shape
// is read once for all of them. A body without siblings forms a batch of one lane. Spare lanes of a last batch repeat
// the batch's first body; they are integrated in free space, nothing touches them, and nobody reads them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proto/pad/pad_law.hpp"
#include "qdem_solver/model/absorbing_boundary.hpp"
#include "qdem_solver/model/patch_load.hpp"

namespace qdem {

inline constexpr int lane_width = 8;

/// How the particles of a body act on each other.
enum class Interaction {
  quadruple,  ///< four at a time, as a constant-strain solid: physics/quadruple_force.hpp
  bond,       ///< two at a time along the edges of the tetrahedra, as in ordinary DEM: physics/bond_force.hpp
};

/// Isotropic Kelvin-Voigt solid (physics of 3D linear viscoelasticity under finite rotation).
struct Material {
  std::string name;
  double young = 0.0;            ///< [Pa]
  double poisson = 0.0;          ///< [-]
  double density = 0.0;          ///< [kg/m3]
  double lame_viscosity = 0.0;   ///< lambda_v [Pa s]
  double shear_viscosity = 0.0;  ///< mu_v [Pa s]
  Interaction interaction = Interaction::quadruple;
  double lambda() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
  double mu() const { return young / (2 * (1 + poisson)); }
  /// Viscosity in uniaxial tension [Pa s]: what E is to the Lame constants; E times a common retardation time.
  double tensile_viscosity() const {
    const double sum = lame_viscosity + shear_viscosity;
    return sum > 0 ? shear_viscosity * (3 * lame_viscosity + 2 * shear_viscosity) / sum : 0.0;
  }
};

struct Triangle {
  std::array<int, 3> nodes;
};  ///< outward by the right-hand rule
struct Edge {
  std::array<int, 2> nodes;
  std::array<int, 2> triangles;
  bool sharp;
};  ///< sharp: can touch another edge

struct BondNetwork;

/// Reference shape shared by bodies: topology, gradients, lumped volumes, skin. Built by make_template().
struct Template {
  std::string name;
  std::vector<Eigen::Vector3d> nodes;            ///< [m] at scale 1
  std::vector<std::array<int, 4>> tets;          ///< positively oriented
  std::vector<std::array<double, 9>> gradients;  ///< per tet: g_2, g_3, g_4 (rows of Dm^-1) [1/m]
  std::vector<double> volumes;                   ///< per tet [m3]
  std::vector<double> node_volumes;              ///< row-sum lumping: quarter of each adjacent tet [m3]
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;
  std::vector<int> surface_nodes;                       ///< ascending
  std::vector<int> adjacency_offsets, adjacency_slots;  ///< CSR: node -> 4 * tet + corner, ascending
  double whole_volume = 0.0;                            ///< [m3]
  std::shared_ptr<const BondNetwork> bonds;             ///< made by make_batches() where a bonded body needs them
  double volume() const { return whole_volume; }
  int n_nodes() const { return static_cast<int>(nodes.size()); }
  int n_tets() const { return static_cast<int>(tets.size()); }
};

inline constexpr double default_sharp_angle_deg = 10.0;

/// How messages about tetrahedra of a file name them and their volumes.
struct TetLabels {
  std::vector<std::size_t> tags;  ///< empty: their numbers from 0
  const char* volume_unit = "m3";
};

/// Builds the derived parts. Throws proto::Error (bad_data) listing inverted or degenerate tetrahedra by id and volume.
/// Edges whose faces meet at less than `sharp_angle_deg` are not sharp.
Template make_template(std::string name, std::vector<Eigen::Vector3d> nodes, std::vector<std::array<int, 4>> tets,
                       double sharp_angle_deg = default_sharp_angle_deg, const TetLabels& labels = {});

enum class BodyKind {
  stone,
  sleeper,
  other,
  ground,  ///< a layer of the ground: has settled under its own weight before, so it has none; planes do not touch it,
           ///< nor do its edges touch anything, since the ground goes on beyond them
};

struct Body {
  BodyKind kind = BodyKind::stone;
  std::string name;
  int template_id = 0;
  int material_id = 0;
  double scale = 1.0;
  int batch = 0, lane = 0;  ///< set by make_model()
};

/// Bodies side by side; see the head of this file.
struct Batch {
  int template_id = 0, material_id = 0;
  int lanes = 1;                         ///< 1 or lane_width
  std::int64_t offset = 0;               ///< of its first value in the state arrays
  std::array<int, lane_width> bodies{};  ///< body of each lane; -1: spare
  std::array<double, lane_width> scale{};
};

/// What gives way behind a surface, as one contact point feels it: a pad, a mat, the ground. Every contact point
/// presses a footprint of its own; neighbours do not feel each other (Winkler's foundation).
struct Bearing {
  double normal_stiffness = 0.0, tangential_stiffness = 0.0;  ///< of a footprint [N/m]; normal 0: rigid
  double normal_damping = 0.0, tangential_damping = 0.0;      ///< of a footprint [N s/m]
  double footprint = 0.0;                                     ///< its area, for reports [m2]
  bool is_rigid() const { return !(normal_stiffness > 0); }
};

/// Half-space boundary: bodies stay on the side the normal points to. At State::time t it passes through
/// point + t * velocity.
struct Plane {
  std::string name;
  Eigen::Vector3d point, normal, velocity = Eigen::Vector3d::Zero();
  double friction = 0.0;
  bool touches_stones = true, touches_sleeper = true;
  Bearing bearing = {};  ///< behind it
};

/// What of two surfaces touches.
enum class ContactShape {
  facet,   ///< particles with triangles and edges with edges, all rounded by one radius
  sphere,  ///< spheres around the surface particles
};

/// How large the spheres around the surface particles of a body are.
enum class SphereRadii {
  equal,    ///< all have ContactLaw::rounding
  by_edge,  ///< in proportion to the longest surface edge at the particle; their mean is ContactLaw::rounding
};

/// Contact of surfaces rounded with a small radius: Voigt normal and tangential, Coulomb slider with history.
struct ContactLaw {
  double normal_stiffness = 0.0;    ///< k_n [N/m]
  double tangential_ratio = 0.8;    ///< k_t / k_n [-]
  double damping_ratio = 0.0;       ///< zeta of the contact dashpots, against the reduced mass of the two bodies [-]
  double friction = 0.0;            ///< [-]
  double rounding = 0.0;            ///< radius by which every surface is rounded [m]
  double skin = 0.0;                ///< how much farther than touching the candidate list reaches [m]; 0: the rounding
  double normal_damping = 0.0;      ///< of what lies behind the surfaces, beside the contact's own dashpot [N s/m]
  double tangential_damping = 0.0;  ///< the same along them [N s/m]
  ContactShape shape = ContactShape::facet;
  SphereRadii radii = SphereRadii::equal;  ///< of spheres
  double rolling_friction = 0.0;           ///< mu_r, of spheres [-]
};

/// One pad value on the QDEM side: weights of sleeper particles and the direction it measures. See proto::RailSeat.
struct PadCell {
  std::vector<int> nodes;       ///< local node numbers of the sleeper body
  std::vector<double> weights;  ///< sum to one
  Eigen::Matrix3d axes;         ///< seat axes
  std::array<proto::PadLaw, 3> laws;
};

/// Particle components held at zero velocity (bit c of mask: component c).
struct Fixity {
  int body, node;
  unsigned mask;
};

/// Inertia of a body while it is brought to rest, as multiples of its true masses: `rigid` for its motion as a rigid
/// body, `deformation` for all other motion. Weights, stiffness and hence the state of rest are those of the true body;
/// only the way there differs (selective mass scaling: Olovsson, Simonsson and Unosson 2005).
struct Inertia {
  double rigid = 1.0, deformation = 1.0;
};

struct Model {
  std::vector<Material> materials;
  std::vector<Template> templates;
  std::vector<Body> bodies;
  std::vector<Batch> batches;
  std::int64_t n_values = 0;  ///< length of each state array
  std::vector<Plane> planes;
  ContactLaw contact;
  Eigen::Vector3d gravity{0, 0, -9.81};
  std::vector<PadCell> pads;               ///< cells in order of seat, cell
  int pad_body = -1;                       ///< the sleeper
  Bearing lining;                          ///< on the bottom of the pad body: the lowest plane of its template
  double ground_friction = 0.0;            ///< of bodies of kind ground [-]
  std::vector<BoundaryParticle> boundary;  ///< where the meshed ground ends
  std::vector<Fixity> fixities;
  std::vector<PatchLoad> loads;
  double local_damping = 0.0;              ///< Cundall's non-viscous damping, only while relaxing [-]
  double drag_per_s = 0.0;                 ///< mass-proportional drag, only while pouring [1/s]
  Eigen::Vector3d pad_body_load{0, 0, 0};  ///< on the pad body, spread as its mass is [N]
  std::vector<Inertia> inertia;  ///< of each body, only while relaxing: local_damping then acts on rigid motion,
                                 ///< a drag on deformation. Empty: true masses, damping particle by particle

  /// Index of component 0 of a body's node in the state arrays; component c lies `stride(body)` values further.
  std::int64_t index(int body, int node) const {
    const Body& b = bodies[body];
    const Batch& t = batches[b.batch];
    return t.offset + std::int64_t{node} * 3 * t.lanes + b.lane;
  }
  int stride(int body) const { return batches[bodies[body].batch].lanes; }
  const Template& shape(int body) const { return templates[bodies[body].template_id]; }
  const Material& material(int body) const { return materials[bodies[body].material_id]; }
  double node_mass(int body, int node) const;  ///< [kg]
  double body_mass(int body) const;            ///< [kg]
  Eigen::Vector3d gravity_on(int body) const;  ///< [m/s2]
  std::int64_t n_elements() const;             ///< of all bodies
};

/// Sorts bodies into batches and sets their offsets. The order of `bodies` is kept; only batch and lane are written,
/// and the bonds of templates that bodies of bonded material use.
void make_batches(Model& model);

}  // namespace qdem
