// Which contact spheres of a body may touch those of others.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "qdem_solver/contact/found_candidates.hpp"

namespace qdem::detail {

/// Radius of the largest sphere of all bodies [m].
inline double largest_sphere(const std::vector<BodySkin>& skins) {
  double largest = 0.0;
  for (const BodySkin& skin : skins) {
    largest = std::max(largest, *std::max_element(skin.radii.begin(), skin.radii.end()));
  }
  return largest;
}

/// Finds the candidates of one body as the first of each pair: spheres whose surfaces are nearer than `skin` [m].
class SphereSearch {
 public:
  SphereSearch(const Model& model, const std::vector<BodySkin>& skins, const std::vector<BodyBox>& boxes,
               const double* positions, double largest, double skin, double time)
      : model_(model),
        skins_(skins),
        boxes_(boxes),
        positions_(positions),
        largest_(largest),
        skin_(skin),
        time_(time) {}

  void search(int a, const std::vector<int>& partners, Found& found) {
    for (int p = static_cast<int>(model_.planes.size()) - 1; p >= 0; --p) against_plane(a, p, found);
    for (const int b : partners) {
      if (a < b) against_body(a, b, found);
    }
  }

 private:
  struct NearNode {
    int node;
    Eigen::Vector3d x;
    double radius;
  };

  void against_plane(int a, int p, Found& found) const {
    const Plane& plane = model_.planes[p];
    const bool sleeper = model_.bodies[a].kind == BodyKind::sleeper;
    if (sleeper ? !plane.touches_sleeper : !plane.touches_stones) return;
    const BodySkin& skin = skins_[a];
    const Eigen::Vector3d point = plane.point + time_ * plane.velocity, n = plane.normal;
    const Eigen::Vector3d lowest = (n.array() > 0).select(boxes_[a].low, boxes_[a].high);
    if (n.dot(lowest - point) > largest_ + skin_) return;
    for (const int node : skin.shape->surface_nodes) {
      if (n.dot(skin.at(positions_, node) - point) <= skin.radii[node] + skin_) add({a, ~p, node, -1}, found);
    }
  }

  void against_body(int a, int b, Found& found) {
    collect(a, boxes_[b], near_a_), collect(b, boxes_[a], near_b_);
    for (const NearNode& p : near_a_) {
      for (const NearNode& q : near_b_) {
        const double reach = p.radius + q.radius + skin_;
        if ((p.x - q.x).squaredNorm() <= reach * reach) add({a, b, p.node, q.node}, found);
      }
    }
  }

  void collect(int body, const BodyBox& other, std::vector<NearNode>& nodes) const {
    const BodySkin& skin = skins_[body];
    nodes.clear();
    for (const int node : skin.shape->surface_nodes) {
      const Eigen::Vector3d x = skin.at(positions_, node);
      if (near_box(other, x, skin.radii[node] + largest_ + skin_)) nodes.push_back({node, x, skin.radii[node]});
    }
  }

  static void add(const ContactKey& key, Found& found) {
    found.keys.push_back(key);
    found.triangle_counts.push_back(0);
  }

  const Model& model_;
  const std::vector<BodySkin>& skins_;
  const std::vector<BodyBox>& boxes_;
  const double* positions_;
  double largest_, skin_, time_;
  std::vector<NearNode> near_a_, near_b_;
};

}  // namespace qdem::detail
