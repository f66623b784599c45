#include "qdem_solver/bed/gmsh_mesh.hpp"

#include <gmsh.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <fstream>
#include <map>

#include "proto/error.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr int four_node_tetrahedron = 4;  // Gmsh's number of the element type

/// Gmsh keeps one global session; this one is silent and serial, so that a mesh depends on its input alone. Gmsh sets
/// the program's number of OpenMP threads; the destructor puts it back.
class GmshSession {
 public:
  GmshSession() : n_threads_(omp_get_max_threads()) {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.Optimize", 1);
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 1);
  }
  ~GmshSession() {
    gmsh::finalize();
    omp_set_num_threads(n_threads_);
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  int n_threads_;
};

/// Runs `work` in a session. What Gmsh 4.8 throws is an exception, a text or a number, as it comes.
template <class Work>
void with_gmsh(const std::string& problem, const std::string& where, const Work& work) {
  const GmshSession session;
  std::string reason;
  try {
    return work();
  } catch (const std::exception& error) {
    reason = error.what();
  } catch (const std::string& text) {
    reason = text;
  } catch (int) {
  }
  throw proto::Error(proto::ExitCode::bad_data, problem + (reason.empty() ? "" : ": " + reason), where);
}

void add_geometry(const Polyhedron& shape, double size) {
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    const Vector3d& x = shape.corners[i];
    gmsh::model::geo::addPoint(x[0], x[1], x[2], size, static_cast<int>(i) + 1);
  }
  std::map<std::pair<int, int>, int> lines;
  std::vector<int> surfaces;
  for (const auto& face : shape.faces) {
    std::vector<int> loop;
    for (int k = 0; k < 3; ++k) {
      const int p = face[k], q = face[(k + 1) % 3];
      auto& line = lines[{std::min(p, q), std::max(p, q)}];
      if (line == 0) line = gmsh::model::geo::addLine(std::min(p, q) + 1, std::max(p, q) + 1);
      loop.push_back(p < q ? line : -line);
    }
    surfaces.push_back(gmsh::model::geo::addPlaneSurface({gmsh::model::geo::addCurveLoop(loop)}));
  }
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(surfaces)});
  gmsh::model::geo::synchronize();
}

/// The tetrahedra of the session's model and their nodes, in ascending order of their tags.
TetMesh take_mesh() {
  TetMesh mesh;
  std::vector<std::size_t> node_tags, tet_nodes;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(node_tags, coordinates, parameters);
  gmsh::model::mesh::getElementsByType(four_node_tetrahedron, mesh.tags, tet_nodes);
  std::map<std::size_t, Vector3d> places;
  for (std::size_t i = 0; i < node_tags.size(); ++i) places[node_tags[i]] = Vector3d(&coordinates[3 * i]);
  std::map<std::size_t, int> numbers;
  for (const std::size_t tag : tet_nodes) numbers[tag] = 0;
  for (auto& [tag, number] : numbers) {
    number = static_cast<int>(mesh.nodes.size());
    mesh.nodes.push_back(places.at(tag));
  }
  mesh.tets.resize(mesh.tags.size());
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    for (int k = 0; k < 4; ++k) mesh.tets[e][k] = numbers.at(tet_nodes[4 * e + k]);
  }
  return mesh;
}

void orient(TetMesh& mesh) {
  for (auto& tet : mesh.tets) {
    const Vector3d &a = mesh.nodes[tet[0]], &b = mesh.nodes[tet[1]], &c = mesh.nodes[tet[2]], &d = mesh.nodes[tet[3]];
    if ((b - a).cross(c - a).dot(d - a) < 0) std::swap(tet[2], tet[3]);
  }
}

/// Gmsh takes a file of another kind for a script and runs it, so the head is looked at first.
void check_head(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string head;
  if (in >> head && head == "$MeshFormat") return;
  throw proto::Error(proto::ExitCode::bad_data, "it is not a mesh file of Gmsh (it does not begin with $MeshFormat)",
                     path, "export the tetrahedra in the MSH format, version 2 or 4");
}

}  // namespace

Template mesh_polyhedron(const std::string& name, const Polyhedron& shape, double size) {
  TetMesh mesh;
  with_gmsh("Gmsh cannot mesh the stone", "template " + name, [&] {
    add_geometry(shape, size);
    gmsh::model::mesh::generate(3);
    mesh = take_mesh();
  });
  orient(mesh);
  return make_template(name, std::move(mesh.nodes), std::move(mesh.tets));
}

TetMesh read_msh(const std::string& path) {
  check_head(path);
  TetMesh mesh;
  with_gmsh("Gmsh cannot read the mesh", path, [&] {
    gmsh::open(path);
    mesh = take_mesh();
  });
  if (mesh.tets.empty()) {
    throw proto::Error(proto::ExitCode::bad_data, "the mesh holds no 4-node tetrahedra", path,
                       "mesh the volume with first-order elements, or give the closed surface as STL or OBJ");
  }
  return mesh;
}

}  // namespace qdem::bed
