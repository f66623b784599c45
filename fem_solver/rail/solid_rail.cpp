#include "fem_solver/rail/solid_rail.hpp"

#include <algorithm>

namespace fem {
namespace {

std::vector<int> corner_nodes(const RailMesh& mesh) {
  std::vector<int> nodes;
  for (const auto& hexahedron : mesh.hexahedra()) nodes.insert(nodes.end(), hexahedron.begin(), hexahedron.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<double> at_nodes(const std::vector<int>& nodes, const Eigen::VectorXd& field) {
  std::vector<double> values;
  values.reserve(3 * nodes.size());
  for (const int node : nodes) values.insert(values.end(), {field[3 * node], field[3 * node + 1], field[3 * node + 2]});
  return values;
}

}  // namespace

SolidRail::SolidRail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner)
    : material_(settings.material),
      system_(build_rail_system(settings, seats, owner)),
      band_(system_),
      corner_nodes_(corner_nodes(*system_.mesh)) {}

RailFigures SolidRail::figures() const {
  const auto& mesh = *system_.mesh;
  return {mesh.section().properties(), mesh.n_elements(), system_.element_length,
          mesh.planes().back() - mesh.planes().front()};
}

// Force spread over the cross-section of one plane, vertical.
Eigen::VectorXd SolidRail::section_load(int plane) const {
  const NodeWeights mean = system_.mesh->section_mean(plane);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(system_.n_dofs());
  for (std::size_t k = 0; k < mean.nodes.size(); ++k) load[3 * mean.nodes[k] + 2] = mean.weights[k];
  return load;
}

double SolidRail::indentation(const Flexibility& flexibility) const {
  const auto& planes = system_.mesh->planes();
  const int middle = static_cast<int>(planes.size()) / 2, n = system_.planes_per_bay;
  double sum = 0.0;
  for (int plane = middle; plane < middle + n; ++plane) {
    Eigen::VectorXd patch = Eigen::VectorXd::Zero(system_.n_dofs());
    band_.add_load(band_.at(planes[plane]), 1.0, patch);
    sum += flexibility(patch) - flexibility(section_load(plane));
  }
  return sum / n;
}

RailShape SolidRail::shape() const {
  RailShape shape;
  shape.nodes_per_cell = 8;
  for (const int node : corner_nodes_) {
    const auto& x = system_.mesh->nodes()[node];
    shape.points.insert(shape.points.end(), {x[0], x[1], x[2]});
  }
  for (const auto& hexahedron : system_.mesh->hexahedra())
    for (const int node : hexahedron)
      shape.connectivity.push_back(std::lower_bound(corner_nodes_.begin(), corner_nodes_.end(), node) -
                                   corner_nodes_.begin());
  return shape;
}

std::vector<RailField> SolidRail::fields() const {
  using V = const Eigen::VectorXd&;
  return {{"displacement", "m", "of the rail from its unloaded, weightless state", true, 3,
           [this](V u, V) { return at_nodes(corner_nodes_, u); }},
          {"velocity", "m/s", "of the rail", true, 3, [this](V, V v) { return at_nodes(corner_nodes_, v); }},
          {"von_mises_stress", "Pa", "von Mises stress at the centre of the element", false, 1,
           [this](V u, V) { return system_.mesh->solid().von_mises(u, material_); }}};
}

std::unique_ptr<RailModel> build_solid_rail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats,
                                            SeatOwner owner) {
  return std::make_unique<SolidRail>(settings, seats, owner);
}

}  // namespace fem
