#include "qdem_solver/model/patch_load.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {
namespace {

Patch patch_of(int body, const std::map<int, double>& parts, double whole, const Eigen::Vector3d& direction) {
  Patch patch;
  patch.body = body, patch.direction = direction.normalized();
  for (const auto& [node, part] : parts) {
    patch.nodes.push_back(node);
    patch.weights.push_back(part / whole);
  }
  return patch;
}

}  // namespace

bool Region::holds(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d offset = point - centre;
  if (radius > 0) return offset.norm() <= radius;
  return (offset.cwiseAbs().array() <= half_lengths.array()).all();
}

Patch make_patch(const Model& model, const State& state, int body, const Region& region,
                 const Eigen::Vector3d& direction) {
  std::map<int, double> parts;
  double area = 0.0;
  for (const Triangle& triangle : model.shape(body).triangles) {
    Eigen::Vector3d x[3];
    for (int k = 0; k < 3; ++k) x[k] = state.position(model, body, triangle.nodes[k]);
    if (!std::all_of(x, x + 3, [&](const Eigen::Vector3d& corner) { return region.holds(corner); })) continue;
    const double size = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    for (const int node : triangle.nodes) parts[node] += size / 3;
    area += size;
  }
  if (parts.empty()) {
    std::ostringstream where;
    where << "body '" << model.bodies[body].name << "', patch at (" << region.centre.transpose() << ") m";
    throw proto::Error(proto::ExitCode::bad_data, "no surface triangle lies inside the patch of a load", where.str(),
                       "move the patch onto the body's surface, or make it larger");
  }
  return patch_of(body, parts, area, direction);
}

Patch make_pad_patch(const Model& model) {
  std::map<int, double> parts;
  for (const PadCell& cell : model.pads) {
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) parts[cell.nodes[i]] += cell.weights[i];
  }
  return patch_of(model.pad_body, parts, static_cast<double>(model.pads.size()), -model.pads.front().axes.col(2));
}

}  // namespace qdem
