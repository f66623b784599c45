#include "qdem_solver/bed/drawn_stones.hpp"

#include <algorithm>
#include <cmath>

#include "qdem_solver/bed/polyhedron.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

/// Volume of a template rounded by r: Steiner's formula, V + A r + M r^2 + 4 pi/3 r^3 with M half the sum of edge
/// length times exterior angle, which is negative at hollow edges.
double rounded_volume(const Template& shape, double scale, double r) {
  double area = 0.0, curvature = 0.0;
  std::vector<Vector3d> normals;
  for (const Triangle& t : shape.triangles) {
    const Vector3d& a = shape.nodes[t.nodes[0]];
    const Vector3d n = (shape.nodes[t.nodes[1]] - a).cross(shape.nodes[t.nodes[2]] - a);
    area += n.norm() / 2;
    normals.push_back(n.normalized());
  }
  for (const Edge& e : shape.edges) {
    const double angle = std::acos(std::clamp(normals[e.triangles[0]].dot(normals[e.triangles[1]]), -1.0, 1.0));
    const double sign = is_hollow(shape, e) ? -1.0 : 1.0;
    curvature += sign * (shape.nodes[e.nodes[1]] - shape.nodes[e.nodes[0]]).norm() * angle / 2;
  }
  return shape.volume() * std::pow(scale, 3) + area * scale * scale * r + curvature * scale * r * r +
         4 * M_PI / 3 * std::pow(r, 3);
}

}  // namespace

double envelope_volume(const Template& shape, double size, double rounding) {
  return rounded_volume(shape, size - 2 * rounding, rounding);
}

DrawnStones draw_bed(const Settings& settings, double rounding, Random& random) {
  if (settings.scene == Scene::sleeper) return {};
  StoneTemplates stones = make_stone_templates(settings.shapes);
  DrawnStones drawn{std::move(stones.templates), std::move(stones.notes), {}, {}};
  if (settings.scene == Scene::stone) {
    drawn.layer.push_back({0, settings.gradation.size_at(0.5), settings.mixture.front().material_id});
    return drawn;
  }
  const auto volume_of = [&](int template_id, double size) {
    return envelope_volume(drawn.templates[template_id], size, rounding);
  };
  const auto draw = [&](double volume) {
    auto result = draw_stones(settings.gradation, settings.shapes.n_templates, volume_of,
                              (1 - settings.target_porosity) * volume, random);
    mix_materials(settings.mixture, volume_of, result);
    return result;
  };
  drawn.layer = draw(settings.wall() * settings.spacing * settings.depth);
  const double crib = (settings.wall() * settings.spacing - settings.sleeper.bottom_area()) * settings.crib_height;
  if (crib > 0) drawn.crib = draw(crib);
  return drawn;
}

}  // namespace qdem::bed
