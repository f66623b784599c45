// Meshes for tests: a box of cubes, six tetrahedra each around the cube's diagonal.
#pragma once

#include <array>
#include <random>
#include <string>
#include <vector>

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace tests {

struct Mesh {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<int, 4>> tets;
};

/// How the bricks of a box are cut: all alike, or every brick as the mirror image of its neighbours, which leaves no
/// direction preferred over its mirror images.
enum class Cut { alike, mirrored };

/// Box [0, size] of cells[0] x cells[1] x cells[2] bricks.
inline Mesh box_mesh(std::array<int, 3> cells, const Eigen::Vector3d& size, Cut cut = Cut::alike) {
  Mesh mesh;
  const auto id = [&](const std::array<int, 3>& p) { return (p[0] * (cells[1] + 1) + p[1]) * (cells[2] + 1) + p[2]; };
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k) {
        mesh.nodes.emplace_back(size[0] * i / cells[0], size[1] * j / cells[1], size[2] * k / cells[2]);
      }
    }
  }
  constexpr int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int k = 0; k < cells[2]; ++k) {
        std::array<int, 3> flip{i % 2, j % 2, k % 2};
        if (cut == Cut::alike) flip = {0, 0, 0};
        for (int path = 0; path < 6; ++path) {
          std::array<int, 3> corner{i + flip[0], j + flip[1], k + flip[2]};
          std::array<int, 4> tet{id(corner)};
          for (int step = 0; step < 3; ++step) {
            const int axis = paths[path][step];
            corner[axis] += flip[axis] ? -1 : 1, tet[step + 1] = id(corner);
          }
          const bool turned = (path >= 3) != ((flip[0] + flip[1] + flip[2]) % 2 == 1);
          if (turned) std::swap(tet[2], tet[3]);  // the odd paths turn the other way, and so does a mirror
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  return mesh;
}

/// Moves every node by up to `amount` in each direction, the same for every run.
inline void distort(Mesh& mesh, double amount, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  for (auto& node : mesh.nodes) {
    for (int c = 0; c < 3; ++c) node[c] += amount * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
  }
}

inline qdem::Template box_template(std::array<int, 3> cells, const Eigen::Vector3d& size, double distortion = 0.0,
                                   Cut cut = Cut::alike) {
  Mesh mesh = box_mesh(cells, size, cut);
  if (distortion > 0) distort(mesh, distortion);
  return qdem::make_template("box", mesh.nodes, mesh.tets);
}

/// A model of `n` equal bodies without gravity or contact.
inline qdem::Model free_bodies(qdem::Template shape, qdem::Material material, int n = 1) {
  qdem::Model model;
  model.materials = {std::move(material)};
  model.templates = {std::move(shape)};
  model.gravity.setZero();
  model.contact.normal_stiffness = 1e6, model.contact.rounding = 1e-4;
  for (int i = 0; i < n; ++i) {
    qdem::Body body;
    body.kind = qdem::BodyKind::other, body.name = "body " + std::to_string(i);
    model.bodies.push_back(body);
  }
  qdem::make_batches(model);
  return model;
}

/// Bodies side by side, far from each other.
inline std::vector<qdem::Placement> apart(int n, double distance) {
  std::vector<qdem::Placement> places(n);
  for (int i = 0; i < n; ++i) places[i].translation = Eigen::Vector3d(distance * i, 0, 0);
  return places;
}

inline qdem::Material rock() {
  return {"rock", 60e9, 0.25, 2700.0, 0.0, 0.0};
}
inline qdem::Material bonded(qdem::Material material) {
  material.interaction = qdem::Interaction::bond;
  return material;
}
inline qdem::Material concrete() {
  return {"concrete", 40e9, 0.2, 2400.0, 0.0, 0.0};
}
inline qdem::Material with_retardation(qdem::Material material, double tau) {
  material.lame_viscosity = tau * material.lambda(), material.shear_viscosity = tau * material.mu();
  return material;
}

}  // namespace tests
