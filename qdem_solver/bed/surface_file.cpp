#include "qdem_solver/bed/surface_file.hpp"

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <fstream>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"

namespace qdem::bed {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Polygons = std::vector<std::vector<std::size_t>>;

void add_polygon(const std::vector<std::size_t>& polygon, Polyhedron& shape) {
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    shape.faces.push_back(
        {static_cast<int>(polygon[0]), static_cast<int>(polygon[k - 1]), static_cast<int>(polygon[k])});
  }
}

bool is_sound(const std::vector<Point>& points, const Polygons& polygons) {
  for (const Point& p : points) {
    if (!(std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()))) return false;
  }
  for (const auto& polygon : polygons) {
    for (const std::size_t corner : polygon) {
      if (corner >= points.size()) return false;
    }
  }
  return !polygons.empty();
}

}  // namespace

Polyhedron read_surface(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw proto::Error(proto::ExitCode::missing_input, "the file cannot be read", path, "check its permissions");
  const bool is_obj = proto::file_ending(path) == ".obj";
  std::vector<Point> points;
  Polygons polygons;
  const bool read = is_obj ? CGAL::IO::read_OBJ(in, points, polygons) : CGAL::IO::read_STL(in, points, polygons);
  if (!read || !is_sound(points, polygons)) {
    throw proto::Error(proto::ExitCode::bad_data,
                       std::string("it is not a whole surface in the format ") + (is_obj ? "OBJ" : "STL"), path,
                       "export the stone's surface as triangles in STL, text or binary, or in OBJ");
  }
  Polyhedron shape;
  for (const Point& p : points) shape.corners.emplace_back(p.x(), p.y(), p.z());
  for (const auto& polygon : polygons) add_polygon(polygon, shape);
  return shape;
}

void write_stl(const std::string& path, const Polyhedron& shape, double factor) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& x : shape.corners) points.emplace_back(factor * x[0], factor * x[1], factor * x[2]);
  Polygons faces;
  for (const auto& face : shape.faces) faces.emplace_back(face.begin(), face.end());
  std::ofstream out(path, std::ios::binary);
  CGAL::IO::set_binary_mode(out);
  if (!out || !CGAL::IO::write_STL(out, points, faces) || !out.flush()) {
    throw proto::Error(proto::ExitCode::cannot_create, "the surface cannot be written", path);
  }
}

}  // namespace qdem::bed
