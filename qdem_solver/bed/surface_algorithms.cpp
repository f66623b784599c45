#include "qdem_solver/bed/surface_algorithms.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace qdem::bed {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
namespace sms = CGAL::Surface_mesh_simplification;

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

struct Soup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
};

Soup soup_of(const Polyhedron& shape) {
  Soup soup;
  for (const Eigen::Vector3d& x : shape.corners) soup.points.emplace_back(x[0], x[1], x[2]);
  for (const auto& face : shape.faces) soup.polygons.emplace_back(face.begin(), face.end());
  return soup;
}

Mesh mesh_of(const Polyhedron& shape) {
  const Soup soup = soup_of(shape);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  return mesh;
}

Eigen::Vector3d place(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

Polyhedron shape_of(Mesh& mesh) {
  mesh.collect_garbage();
  Polyhedron shape;
  for (const auto vertex : mesh.vertices()) shape.corners.push_back(place(mesh.point(vertex)));
  for (const auto face : mesh.faces()) {
    std::array<int, 3> corners{};
    int k = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      corners[k++] = static_cast<int>(vertex.idx());
    shape.faces.push_back(corners);
  }
  return shape;
}

}  // namespace

bool make_consistent(Polyhedron& shape) {
  Soup soup = soup_of(shape);
  if (!pmp::orient_polygon_soup(soup.points, soup.polygons)) return false;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) shape.faces[f][k] = static_cast<int>(soup.polygons[f][k]);
  }
  return true;
}

std::optional<int> remove_flat_facets(Polyhedron& shape) {
  Mesh mesh = mesh_of(shape);
  std::vector<Mesh::Face_index> flat;
  pmp::degenerate_faces(mesh, std::back_inserter(flat));
  if (flat.empty()) return 0;
  if (!pmp::remove_degenerate_faces(mesh)) return {};
  shape = shape_of(mesh);
  return static_cast<int>(flat.size());
}

std::optional<Eigen::Vector3d> self_crossing(const Polyhedron& shape) {
  const Mesh mesh = mesh_of(shape);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  if (pairs.empty()) return {};
  return place(mesh.point(mesh.source(mesh.halfedge(pairs.front().first))));
}

Polyhedron coarsened(const Polyhedron& shape, int n_facets) {
  if (static_cast<int>(shape.faces.size()) <= n_facets) return shape;
  Mesh mesh = mesh_of(shape);
  const std::size_t n_edges = static_cast<std::size_t>(n_facets) * 3 / 2;
  sms::edge_collapse(mesh, sms::Count_stop_predicate<Mesh>(n_edges + 1));
  return shape_of(mesh);
}

}  // namespace qdem::bed
