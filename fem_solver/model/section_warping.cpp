#include "fem_solver/model/section_warping.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <map>

namespace fem {
namespace {

// A quadrature point: gradients of the element's four shape functions, place, weight.
struct Point {
  std::array<int, 4> nodes;
  Eigen::Matrix<double, 2, 4> gradient;
  Eigen::Vector2d place;
  Eigen::Vector4d shape;
  double weight;
};

class SectionMesh {
 public:
  SectionMesh(const RailSection& section, int divisions) {
    for (const auto& quad : section.quads) {
      Eigen::Matrix<double, 2, 4> corners;
      for (int k = 0; k < 4; ++k) corners.col(k) = section.vertices[quad[k]];
      for (int i = 0; i < divisions; ++i)
        for (int j = 0; j < divisions; ++j) add_element(corners, i, j, divisions);
    }
  }

  int n_nodes() const { return static_cast<int>(numbers_.size()); }
  const std::vector<Point>& points() const { return points_; }

 private:
  static Eigen::Vector4d bilinear(double s, double t) { return {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}; }

  // Blocks share their edges: equal places are one node.
  int node(const Eigen::Vector2d& p) {
    const std::pair<long, long> key(std::lround(p[0] * 1e9), std::lround(p[1] * 1e9));
    return numbers_.emplace(key, n_nodes()).first->second;
  }

  void add_element(const Eigen::Matrix<double, 2, 4>& block, int i, int j, int divisions) {
    Eigen::Matrix<double, 2, 4> corners;
    std::array<int, 4> nodes;
    for (int k = 0; k < 4; ++k) {
      corners.col(k) = block * bilinear(double(i + (k & 1)) / divisions, double(j + (k >> 1)) / divisions);
      nodes[k] = node(corners.col(k));
    }
    const double gauss = 0.5 / std::sqrt(3.0);
    for (const double s : {0.5 - gauss, 0.5 + gauss})
      for (const double t : {0.5 - gauss, 0.5 + gauss}) {
        Eigen::Matrix<double, 4, 2> slope;
        slope << -(1 - t), -(1 - s), 1 - t, -s, -t, 1 - s, t, s;
        const Eigen::Matrix2d jacobian = corners * slope;
        const Eigen::Vector4d shape = bilinear(s, t);
        points_.push_back(
            {nodes, (slope * jacobian.inverse()).transpose(), corners * shape, shape, jacobian.determinant() / 4});
      }
  }

  std::map<std::pair<long, long>, int> numbers_;
  std::vector<Point> points_;
};

// Neumann problems on the section, the last node held.
class Laplace {
 public:
  explicit Laplace(const SectionMesh& mesh) : mesh_(mesh), n_(mesh.n_nodes() - 1) {
    std::vector<Eigen::Triplet<double>> entries;
    for (const Point& p : mesh.points()) {
      const Eigen::Matrix4d k = p.weight * p.gradient.transpose() * p.gradient;
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          if (p.nodes[a] < n_ && p.nodes[b] < n_) entries.emplace_back(p.nodes[a], p.nodes[b], k(a, b));
    }
    Eigen::SparseMatrix<double> matrix(n_, n_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix);
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& load) const {
    Eigen::VectorXd w = Eigen::VectorXd::Zero(n_ + 1);
    w.head(n_) = solver_.solve(load.head(n_));
    return w;
  }

 private:
  const SectionMesh& mesh_;
  int n_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

Eigen::Vector2d gradient(const Point& p, const Eigen::VectorXd& w) {
  return p.gradient * Eigen::Vector4d(w[p.nodes[0]], w[p.nodes[1]], w[p.nodes[2]], w[p.nodes[3]]);
}

double torsion_constant(const SectionMesh& mesh, const Laplace& laplace, const Eigen::Vector2d& centroid) {
  const auto swirl = [&](const Point& p) {
    return Eigen::Vector2d(-(p.place[1] - centroid[1]), p.place[0] - centroid[0]);
  };
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mesh.n_nodes());
  for (const Point& p : mesh.points())
    for (int k = 0; k < 4; ++k) load[p.nodes[k]] -= p.weight * p.gradient.col(k).dot(swirl(p));
  const Eigen::VectorXd warping = laplace.solve(load);
  double constant = 0.0;
  for (const Point& p : mesh.points()) constant += p.weight * (gradient(p, warping) + swirl(p)).squaredNorm();
  return constant;
}

// `axis`: of the shear force, 0 lateral, 1 vertical.
double shear_coefficient(const SectionMesh& mesh, const Laplace& laplace, const Eigen::Vector2d& centroid, int axis,
                         double inertia, double area) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mesh.n_nodes());
  for (const Point& p : mesh.points())
    for (int k = 0; k < 4; ++k) load[p.nodes[k]] += p.weight * p.shape[k] * (p.place[axis] - centroid[axis]) / inertia;
  const Eigen::VectorXd potential = laplace.solve(load);
  double energy = 0.0;
  for (const Point& p : mesh.points()) energy += p.weight * gradient(p, potential).squaredNorm();
  return 1 / (area * energy);
}

}  // namespace

ShearConstants shear_constants(const RailSection& section, int divisions) {
  const SectionProperties figures = section.properties();
  const Eigen::Vector2d centroid(0.0, figures.centroid_height);
  const SectionMesh mesh(section, divisions);
  const Laplace laplace(mesh);
  return {torsion_constant(mesh, laplace, centroid),
          shear_coefficient(mesh, laplace, centroid, 1, figures.inertia_vertical, figures.area),
          shear_coefficient(mesh, laplace, centroid, 0, figures.inertia_lateral, figures.area)};
}

}  // namespace fem
