#include "qdem_solver/contact/candidates.hpp"

#include <algorithm>
#include <numeric>

#include "qdem_solver/contact/closest_point.hpp"
#include "qdem_solver/contact/found_candidates.hpp"
#include "qdem_solver/contact/sphere_search.hpp"

namespace qdem {
namespace {

using detail::boxes_near, detail::Found, detail::near_box;

/// Finds the candidates of one body as the first of each pair: facets.
class FacetSearch {
 public:
  FacetSearch(const Model& model, const std::vector<BodySkin>& skins, const std::vector<BodyBox>& boxes,
              const double* positions, double reach, double time)
      : model_(model), skins_(skins), boxes_(boxes), positions_(positions), reach_(reach), time_(time) {}

  void search(int a, const std::vector<int>& partners, Found& found) {
    for (int p = static_cast<int>(model_.planes.size()) - 1; p >= 0; --p) against_plane(a, p, found);
    for (const int b : partners) {
      close_in(a, b);
      nodes_against_skin(a, b, found);
      if (a < b && !is_ground(a) && !is_ground(b)) edges_against_edges(a, b, found);
    }
  }

 private:
  struct NearTriangle {
    int id;
    BodyBox box;
    TriangleNow now;
    Eigen::Vector3d normal;
  };
  struct NearEdge {
    int id;
    BodyBox box;
    std::array<Eigen::Vector3d, 2> x;
  };

  bool is_ground(int body) const { return model_.bodies[body].kind == BodyKind::ground; }

  void against_plane(int a, int p, Found& found) const {
    if (is_ground(a)) return;
    const Plane& plane = model_.planes[p];
    const bool sleeper = model_.bodies[a].kind == BodyKind::sleeper;
    if (sleeper ? !plane.touches_sleeper : !plane.touches_stones) return;
    const double reach = reach_ - model_.contact.rounding;
    const Eigen::Vector3d point = plane.point + time_ * plane.velocity, n = plane.normal;
    const BodyBox& box = boxes_[a];
    const Eigen::Vector3d lowest = (n.array() > 0).select(box.low, box.high);
    if (n.dot(lowest - point) > reach) return;
    for (const int node : skins_[a].shape->surface_nodes) {
      if (n.dot(skins_[a].at(positions_, node) - point) > reach) continue;
      found.keys.push_back({a, ~p, node, -1});
      found.triangle_counts.push_back(0);
    }
  }

  /// Parts of a and b in the overlap of their grown boxes.
  void close_in(int a, int b) {
    nodes_.clear(), triangles_.clear(), edges_a_.clear(), edges_b_.clear();
    const BodySkin &sa = skins_[a], &sb = skins_[b];
    for (const int node : sa.shape->surface_nodes) {
      const Eigen::Vector3d x = sa.at(positions_, node);
      if (near_box(boxes_[b], x, reach_)) nodes_.push_back({node, x});
    }
    if (!nodes_.empty()) {
      for (int t = 0; t < static_cast<int>(sb.shape->triangles.size()); ++t) {
        const TriangleNow now(sb, positions_, t);
        const BodyBox box{now.x[0].cwiseMin(now.x[1]).cwiseMin(now.x[2]),
                          now.x[0].cwiseMax(now.x[1]).cwiseMax(now.x[2])};
        if (boxes_near(box, boxes_[a], reach_)) triangles_.push_back({t, box, now, now.area_vector.normalized()});
      }
    }
    if (a < b) collect_edges(sa, boxes_[b], edges_a_), collect_edges(sb, boxes_[a], edges_b_);
  }

  void collect_edges(const BodySkin& skin, const BodyBox& other, std::vector<NearEdge>& edges) const {
    for (int e = 0; e < static_cast<int>(skin.shape->edges.size()); ++e) {
      const Edge& edge = skin.shape->edges[e];
      if (!edge.sharp) continue;
      const Eigen::Vector3d x0 = skin.at(positions_, edge.nodes[0]), x1 = skin.at(positions_, edge.nodes[1]);
      const BodyBox box{x0.cwiseMin(x1), x0.cwiseMax(x1)};
      if (boxes_near(box, other, reach_)) edges.push_back({e, box, {x0, x1}});
    }
  }

  void nodes_against_skin(int a, int b, Found& found) const {
    for (const auto& [node, x] : nodes_) {
      int count = 0;
      for (const NearTriangle& t : triangles_) {
        if (std::abs(t.normal.dot(x - t.now.x[0])) > reach_ || !near_box(t.box, x, reach_)) continue;
        const auto point = closest_on_triangle(x, t.now.x[0], t.now.x[1], t.now.x[2], t.now.area_vector);
        if (point.distance2 > reach_ * reach_) continue;
        found.triangles.push_back(t.id);
        ++count;
      }
      if (count == 0) continue;
      found.keys.push_back({a, b, node, -1});
      found.triangle_counts.push_back(count);
    }
  }

  /// The keys of one pair of bodies follow each other by feature; node and edge keys are merged when all are found.
  void edges_against_edges(int a, int b, Found& found) const {
    for (const NearEdge& ea : edges_a_) {
      for (const NearEdge& eb : edges_b_) {
        if (!boxes_near(ea.box, eb.box, reach_)) continue;
        if (segment_distance2(ea.x[0], ea.x[1], eb.x[0], eb.x[1]) > reach_ * reach_) continue;
        found.keys.push_back({a, b, ea.id, eb.id});
        found.triangle_counts.push_back(0);
      }
    }
  }

  const Model& model_;
  const std::vector<BodySkin>& skins_;
  const std::vector<BodyBox>& boxes_;
  const double* positions_;
  double reach_, time_;
  std::vector<std::pair<int, Eigen::Vector3d>> nodes_;
  std::vector<NearTriangle> triangles_;
  std::vector<NearEdge> edges_a_, edges_b_;
};

}  // namespace

std::vector<BodyBox> body_boxes(const std::vector<BodySkin>& skins, const double* positions) {
  std::vector<BodyBox> boxes(skins.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t b = 0; b < skins.size(); ++b) {
    const Eigen::Vector3d start = skins[b].at(positions, 0);
    BodyBox box{start, start};
    for (const int node : skins[b].shape->surface_nodes) {
      const Eigen::Vector3d x = skins[b].at(positions, node);
      box.low = box.low.cwiseMin(x), box.high = box.high.cwiseMax(x);
    }
    boxes[b] = box;
  }
  return boxes;
}

std::vector<std::vector<int>> near_bodies(const std::vector<BodyBox>& boxes, double reach) {
  std::vector<std::vector<int>> near(boxes.size());
  if (boxes.empty()) return near;
  Eigen::Vector3d low = boxes[0].low, high = boxes[0].high;
  for (const BodyBox& box : boxes) low = low.cwiseMin(box.low), high = high.cwiseMax(box.high);
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return boxes[i].low[axis] != boxes[j].low[axis] ? boxes[i].low[axis] < boxes[j].low[axis] : i < j;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const BodyBox& box = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].low[axis] <= box.high[axis] + reach; ++j) {
      if (!boxes_near(box, boxes[order[j]], reach)) continue;
      near[order[i]].push_back(order[j]);
      near[order[j]].push_back(order[i]);
    }
  }
  for (auto& list : near) std::sort(list.begin(), list.end());
  return near;
}

namespace {

/// Searches around every body; `make_search` gives each thread its own search(body, partners, found).
template <class MakeSearch>
CandidateList collect(const std::vector<std::vector<int>>& near, MakeSearch make_search) {
  std::vector<Found> found(near.size());
#pragma omp parallel
  {
    auto search = make_search();
#pragma omp for schedule(dynamic, 8)
    for (std::size_t a = 0; a < near.size(); ++a) {
      search.search(static_cast<int>(a), near[a], found[a]);
      sort_found(found[a]);
    }
  }
  CandidateList list;
  list.triangle_offsets.push_back(0);
  for (const Found& part : found) {
    list.keys.insert(list.keys.end(), part.keys.begin(), part.keys.end());
    for (const int count : part.triangle_counts) list.triangle_offsets.push_back(list.triangle_offsets.back() + count);
    list.triangles.insert(list.triangles.end(), part.triangles.begin(), part.triangles.end());
  }
  return list;
}

}  // namespace

CandidateList find_candidates(const Model& model, const std::vector<BodySkin>& skins, const double* positions,
                              double skin, double time) {
  const auto boxes = body_boxes(skins, positions);
  if (model.contact.shape == ContactShape::sphere) {
    const double largest = detail::largest_sphere(skins);
    const auto near = near_bodies(boxes, 2 * largest + skin);
    return collect(near, [&] { return detail::SphereSearch(model, skins, boxes, positions, largest, skin, time); });
  }
  const double reach = 2 * model.contact.rounding + skin;
  return collect(near_bodies(boxes, reach), [&] { return FacetSearch(model, skins, boxes, positions, reach, time); });
}

}  // namespace qdem
