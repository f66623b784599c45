#include "qdem_solver/contact/initial_overlap.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "proto/error.hpp"
#include "qdem_solver/contact/contact_stage.hpp"

namespace qdem {
namespace {

constexpr std::size_t most_listed = 5;

double mean_edge(const Model& model, int body) {
  const Template& shape = model.shape(body);
  double sum = 0.0;
  for (const Edge& edge : shape.edges) sum += (shape.nodes[edge.nodes[1]] - shape.nodes[edge.nodes[0]]).norm();
  return model.bodies[body].scale * sum / static_cast<double>(shape.edges.size());
}

std::string name_of(const Model& model, int body) {
  if (body < 0) return "plane '" + model.planes[~body].name + "'";
  return "body " + std::to_string(body) + " '" + model.bodies[body].name + "'";
}

}  // namespace

std::vector<InitialOverlap> initial_overlaps(const Model& model, const State& state, double share) {
  State scratch = state;
  scratch.contact = ContactState{};
  ContactStage stage(model);
  stage.update_candidates(scratch);
  stage.compute(scratch, 0.0);
  std::vector<double> edges;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) edges.push_back(mean_edge(model, b));
  std::map<std::pair<int, int>, InitialOverlap> deepest;
  stage.for_each_live(scratch, [&](const ContactKey& key, int point, double depth) {
    const double edge = key.is_plane() ? edges[key.body_a] : std::min(edges[key.body_a], edges[key.body_b]);
    if (!(depth > share * edge)) return;
    InitialOverlap& found = deepest[std::minmax(key.body_a, key.body_b)];
    if (depth > found.depth) found = {key.body_a, key.body_b, point, depth, edge};
  });
  std::vector<InitialOverlap> result;
  for (const auto& [bodies, overlap] : deepest) result.push_back(overlap);
  std::stable_sort(result.begin(), result.end(), [](const auto& p, const auto& q) { return p.depth > q.depth; });
  return result;
}

void refuse_initial_overlaps(const Model& model, const State& state, double share, const std::string& where,
                             const std::string& advice) {
  const auto overlaps = initial_overlaps(model, state, share);
  if (overlaps.empty()) return;
  std::ostringstream problem;
  problem << overlaps.size() << " pairs overlap at the start by more than " << 100 * share << " % of the edge: ";
  for (std::size_t i = 0; i < overlaps.size() && i < most_listed; ++i) {
    const InitialOverlap& o = overlaps[i];
    const Eigen::Vector3d at = state.position(model, o.body_a, o.point);
    problem << (i > 0 ? "; " : "") << name_of(model, o.body_a) << " node " << o.point << " and "
            << name_of(model, o.body_b) << ", " << 1e3 * o.depth << " mm (" << 100 * o.depth / o.edge << " %) at ("
            << at[0] << ", " << at[1] << ", " << at[2] << ")";
  }
  if (overlaps.size() > most_listed) problem << " and " << overlaps.size() - most_listed << " more";
  throw proto::Error(proto::ExitCode::bad_data, problem.str(), where, advice);
}

}  // namespace qdem
