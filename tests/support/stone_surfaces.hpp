// Surfaces and mesh files of stones for tests.
#pragma once

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "qdem_solver/bed/polyhedron.hpp"
#include "tests/support/box_mesh.hpp"

namespace tests {

using qdem::bed::Polyhedron;

inline Polyhedron box_surface(const Eigen::Vector3d& size, const Eigen::Vector3d& low = Eigen::Vector3d::Zero()) {
  Polyhedron box;
  for (int i = 0; i < 8; ++i) box.corners.push_back(low + size.cwiseProduct(Eigen::Vector3d(i & 1, i / 2 & 1, i / 4)));
  box.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
               {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

/// An octahedron whose facets are cut into four `rounds` times and put on the sphere.
inline Polyhedron sphere_surface(double radius, int rounds) {
  Polyhedron sphere;
  sphere.corners = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  sphere.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] = middles.emplace(std::minmax(a, b), static_cast<int>(sphere.corners.size()));
      if (is_new) sphere.corners.push_back((sphere.corners[a] + sphere.corners[b]).normalized());
      return found->second;
    };
    std::vector<std::array<int, 3>> fine;
    for (const auto& [a, b, c] : sphere.faces) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      fine.insert(fine.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    sphere.faces = fine;
  }
  for (auto& corner : sphere.corners) corner *= radius;
  return sphere;
}

/// Text STL.
inline std::string stl_text(const Polyhedron& shape) {
  std::ostringstream text;
  text.precision(17);
  text << "solid stone\n";
  for (const auto& face : shape.faces) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) text << "vertex " << shape.corners[corner].transpose() << "\n";
    text << "endloop\nendfacet\n";
  }
  text << "endsolid stone\n";
  return text.str();
}

/// OBJ, every corner a line of its own.
inline std::string obj_text(const Polyhedron& shape) {
  std::ostringstream text;
  text.precision(17);
  for (const auto& corner : shape.corners) text << "v " << corner.transpose() << "\n";
  for (const auto& face : shape.faces) text << "f " << face[0] + 1 << " " << face[1] + 1 << " " << face[2] + 1 << "\n";
  return text.str();
}

/// Gmsh's format 2.2; tetrahedra are numbered from 101.
inline std::string msh_text(const Mesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodes.size() << "\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) text << i + 1 << " " << mesh.nodes[i].transpose() << "\n";
  text << "$EndNodes\n$Elements\n" << mesh.tets.size() << "\n";
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    text << e + 101 << " 4 2 1 1";
    for (const int node : mesh.tets[e]) text << " " << node + 1;
    text << "\n";
  }
  text << "$EndElements\n";
  return text.str();
}

}  // namespace tests
