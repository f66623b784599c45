#include "qdem_solver/bed/lone_body.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/bed/drawn_stones.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/relaxation.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr double step_safety = 0.8;
constexpr double damping = 0.5;     // Cundall's
constexpr double flatness = 1e-9;   // of the stone's extent: so far may its particles lie beyond a facet
constexpr double floating_gap = 5;  // above where it would lie [roundings]
constexpr int steps_per_look = 200;

Vector3d centre_of(const Template& shape) {
  Vector3d centre = Vector3d::Zero();
  for (int i = 0; i < shape.n_nodes(); ++i) centre += shape.node_volumes[i] / shape.volume() * shape.nodes[i];
  return centre;
}

/// The sleeper as body 0, its cut held at u_y = 0, or altogether.
Model sleeper_alone(const Settings& settings, const BedPhysics& physics, unsigned held) {
  Model model;
  model.templates.push_back(sleeper_mesh("sleeper", settings.sleeper, settings.sleeper_cells));
  model.materials = physics.materials();
  model.gravity = physics.gravity, model.contact = physics.contact, model.lining = physics.lining;
  Body sleeper;
  sleeper.kind = BodyKind::sleeper, sleeper.name = "sleeper", sleeper.material_id = 1;
  model.bodies.push_back(sleeper);
  model.pad_body = 0;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    const unsigned mask = held | (model.shape(0).nodes[i][1] < 1e-9 ? 2u : 0u);
    if (mask != 0) model.fixities.push_back({0, i, mask});
  }
  return model;
}

/// Lowest point of the stone, turned, from its centre [m].
double lowest_point(const Template& shape, double scale, const Eigen::Matrix3d& rotation) {
  double lowest = 0.0;
  for (const Vector3d& node : shape.nodes) lowest = std::min(lowest, scale * (rotation * (node - centre_of(shape)))[2]);
  return lowest;
}

void come_to_rest(const Settings& settings, Bed& bed) {
  bed.model.local_damping = damping;
  Engine engine(bed.model);
  Relaxation relaxation(bed.model, resting_points, step_safety);
  relaxation.begin(engine, bed.state);
  do {
    engine.advance(bed.state, relaxation.step(), steps_per_look);
    relaxation.fit(engine, bed.state);
    bed.report.unbalanced_force_ratio = engine.unbalanced_ratio(bed.state);
  } while (bed.report.unbalanced_force_ratio > settings.unbalanced_limit && bed.state.step < settings.rest_steps);
  bed.model.local_damping = 0;
  bed.model.inertia.clear();
  bed.report.kinetic_energy = engine.kinetic_energy(bed.state);
  bed.report.largest_penetration = engine.contacts().report(bed.state).largest_penetration;
  bed.state.step = 0, bed.state.time = 0, bed.state.contact.rebuild_time = 0;
  if (bed.report.unbalanced_force_ratio <= settings.unbalanced_limit) return;
  std::ostringstream problem;
  problem << "the stone does not come to rest: unbalanced force ratio " << bed.report.unbalanced_force_ratio;
  throw proto::Error(proto::ExitCode::bad_data, problem.str(), "[bed] unbalanced_limit",
                     "raise the limit or rest_steps");
}

Bed lone_sleeper(const Settings& settings, const BedPhysics& physics) {
  Bed bed;
  bed.model = sleeper_alone(settings, physics, 0u);
  make_batches(bed.model);
  bed.state = make_state(bed.model, {Placement{}});
  return bed;
}

Bed lone_stone(const Settings& settings, const BedPhysics& physics) {
  Bed bed;
  bed.model = sleeper_alone(settings, physics, 7u);
  Random random(settings.seed, 1);
  DrawnStones drawn = draw_bed(settings, physics.contact.rounding, random);
  const Template& shape = bed.model.templates.emplace_back(std::move(drawn.templates.front()));
  bed.report.notes = std::move(drawn.notes);
  Body stone;
  stone.name = "stone_1", stone.template_id = 1, stone.material_id = drawn.layer.front().material_id;
  stone.scale = drawn.layer.front().size - 2 * physics.contact.rounding;
  bed.model.bodies.push_back(stone);
  const double ground = settings.ground_level();
  bed.model.planes.push_back({"ground",
                              {0, 0, ground},
                              Vector3d::UnitZ(),
                              Vector3d::Zero(),
                              physics.ground_friction,
                              true,
                              true,
                              physics.ground});
  make_batches(bed.model);

  const bool lies = physics.gravity.norm() > 0;
  Placement under_seat;
  under_seat.rotation = resting_rotation(shape);
  const double gap = lies ? 0.0 : floating_gap * physics.contact.rounding;
  const double height = gap + physics.contact.rounding - lowest_point(shape, stone.scale, under_seat.rotation);
  const Vector3d& seat = settings.seats.front().origin;
  under_seat.translation =
      Vector3d(seat[0], seat[1], ground + height) - stone.scale * (under_seat.rotation * centre_of(shape));
  bed.state = make_state(bed.model, {Placement{}, under_seat});
  bed.report.stones = 1, bed.report.d50 = drawn.layer.front().size, bed.report.elements_per_stone = shape.n_tets();
  if (lies) come_to_rest(settings, bed);
  return bed;
}

}  // namespace

Eigen::Matrix3d resting_rotation(const Template& stone) {
  const Vector3d centre = centre_of(stone);
  double extent = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& node : stone.nodes) extent = std::max(extent, (node - centre).norm());
  Vector3d down = Vector3d::Zero();
  for (const Triangle& t : stone.triangles) {
    const Vector3d& corner = stone.nodes[t.nodes[0]];
    const Vector3d normal = (stone.nodes[t.nodes[1]] - corner).cross(stone.nodes[t.nodes[2]] - corner).normalized();
    const bool is_outermost = std::all_of(stone.nodes.begin(), stone.nodes.end(), [&](const Vector3d& node) {
      return normal.dot(node - corner) < flatness * extent;
    });
    const double distance = normal.dot(corner - centre);
    if (is_outermost && distance < nearest) nearest = distance, down = normal;
  }
  if (down.isZero()) {
    throw proto::Error(proto::ExitCode::bad_data, "the stone has no facet to lie on", "template '" + stone.name + "'",
                       "take another seed or file");
  }
  return Eigen::Quaterniond::FromTwoVectors(down, -Vector3d::UnitZ()).toRotationMatrix();
}

Bed lone_body(const Settings& settings, const BedPhysics& physics) {
  Bed bed = settings.scene == Scene::sleeper ? lone_sleeper(settings, physics) : lone_stone(settings, physics);
  bed.report.elements = bed.model.n_elements();
  bed.report.seed = static_cast<std::int64_t>(settings.seed);
  return bed;
}

}  // namespace qdem::bed
