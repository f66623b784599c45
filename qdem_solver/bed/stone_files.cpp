#include "qdem_solver/bed/stone_files.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"
#include "qdem_solver/bed/gmsh_mesh.hpp"
#include "qdem_solver/bed/scan.hpp"
#include "qdem_solver/bed/stone_mesh.hpp"
#include "qdem_solver/bed/surface_algorithms.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;
using Notes = std::vector<std::string>;

constexpr double told_step = 0.75, least_step = 0.25;  // of the median
constexpr double enough_of_best = 0.8;                 // of the step: then the finer surface is taken

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

void check_one_part(const Template& shape, const std::string& path) {
  const int n_parts = count_parts(skin_of(shape));
  if (n_parts == 1) return;
  throw proto::Error(proto::ExitCode::bad_data, fmt::format("the mesh has a skin of {} parts", n_parts), path,
                     "a file holds one stone without hollows, its parts sharing whole faces");
}

double signed_volume(const TetMesh& mesh, const std::array<int, 4>& tet) {
  const Vector3d& a = mesh.nodes[tet[0]];
  return (mesh.nodes[tet[1]] - a).cross(mesh.nodes[tet[2]] - a).dot(mesh.nodes[tet[3]] - a) / 6;
}

/// A file that numbers every tetrahedron the other way round is not a mesh with inverted elements.
void turn_left_handed(TetMesh& mesh, const std::string& name, Notes& notes) {
  const bool left_handed =
      std::all_of(mesh.tets.begin(), mesh.tets.end(), [&](const auto& tet) { return signed_volume(mesh, tet) < 0; });
  if (!left_handed) return;
  for (auto& tet : mesh.tets) std::swap(tet[2], tet[3]);
  notes.push_back(name + ": all tetrahedra were numbered left-handed and are turned");
}

Candidate read_mesh(const std::string& path, Notes& notes) {
  const std::string name = name_of(path);
  TetMesh mesh = read_msh(path);
  turn_left_handed(mesh, name, notes);
  Candidate candidate;
  candidate.shape =
      make_template(path, mesh.nodes, mesh.tets, default_sharp_angle_deg, {mesh.tags, "file units cubed"});
  check_one_part(candidate.shape, path);
  const SieveFrame frame = sieve_frame(skin_of(candidate.shape));
  for (Vector3d& x : mesh.nodes) x = frame(x);
  candidate.shape = make_template(name, std::move(mesh.nodes), std::move(mesh.tets));
  candidate.step = step_of_unit_rock(candidate.shape);
  candidate.tags = std::move(mesh.tags);
  return candidate;
}

/// Wishes for a mesh of a scan: those for generated stones, which have 50 to 100 tetrahedra, at another fineness.
struct ScanWish {
  MeshWish mesh;
  std::vector<int> facets;  ///< of coarsened surfaces to try, falling
};

ScanWish wish_for_scans(const StoneShapes& wanted) {
  const double fineness = 0.5 * (wanted.least_tets + wanted.most_tets) / 75;
  ScanWish wish{{wanted.least_tets, wanted.most_tets, {}, 0.005 * std::min(1.0, 1 / fineness)}, {}};
  for (const double size : {1.0, 0.8, 0.68, 0.58, 0.5, 0.44, 0.39})
    wish.mesh.sizes.push_back(size / std::cbrt(fineness));
  for (const int n : {52, 40, 32, 24, 18}) {
    wish.facets.push_back(std::max(8, static_cast<int>(n * std::pow(fineness, 2.0 / 3))));
  }
  return wish;
}

struct Filled {
  Candidate candidate;
  std::size_t n_facets = 0;
  double volume_share = 0.0;  ///< of the scan's
};

/// The finest of the coarsened surfaces whose mesh has nearly the best step.
Filled fill(const std::string& name, const Polyhedron& scan, const ScanWish& wish) {
  std::vector<Filled> tried;
  double best = 0.0;
  for (const int n_facets : wish.facets) {
    const Polyhedron coarse = coarsened(scan, n_facets);
    tried.push_back(
        {best_mesh(name, at_sieve_size(coarse), wish.mesh), coarse.faces.size(), volume(coarse) / volume(scan)});
    best = std::max(best, tried.back().candidate.step);
  }
  return *std::find_if(tried.begin(), tried.end(),
                       [&](const Filled& filled) { return filled.candidate.step >= enough_of_best * best; });
}

Candidate read_surface_stone(const std::string& path, const StoneShapes& wanted, Notes& notes) {
  const std::string name = name_of(path);
  const Scan scan = read_scan(path);
  for (const std::string& repair : scan.repairs) notes.push_back(name + ": " + repair);
  const Filled filled = fill(name, scan.shape, wish_for_scans(wanted));
  if (!filled.candidate.refusal.empty()) {
    throw proto::Error(proto::ExitCode::bad_data, "the surface cannot be filled: " + filled.candidate.refusal, path,
                       "widen [bed] elements_per_stone, or smooth the scan");
  }
  notes.push_back(fmt::format("{}: {} facets coarsened to {}, {} tetrahedra, {:.3f} of the scan's volume", name,
                              scan.shape.faces.size(), filled.n_facets, filled.candidate.shape.n_tets(),
                              filled.volume_share));
  return filled.candidate;
}

/// The tetrahedron that bounds the step first.
std::size_t worst_tet(const Template& shape) {
  std::size_t worst = 0;
  double largest = 0.0;
  for (std::size_t e = 0; e < shape.tets.size(); ++e) {
    const Eigen::Matrix3d g = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.gradients[e].data());
    const double size = g.squaredNorm() + g.colwise().sum().squaredNorm();
    if (size > largest) largest = size, worst = e;
  }
  return worst;
}

void judge_step(const Candidate& candidate, double median, const std::string& path, Notes& notes) {
  const double share = candidate.step / median;
  if (share >= told_step) return;
  const std::size_t worst = worst_tet(candidate.shape);
  const std::string problem = fmt::format("its stable step is {:.2f} of the median of all stones, by tetrahedron {}",
                                          share, candidate.tags.empty() ? worst : candidate.tags[worst]);
  if (share < least_step) {
    throw proto::Error(proto::ExitCode::bad_data, problem, path,
                       "mesh the stone again without slivers, or leave it out");
  }
  notes.push_back(name_of(path) + ": " + problem);
}

}  // namespace

StoneTemplates read_stone_templates(const StoneShapes& wanted) {
  StoneTemplates result;
  std::vector<Candidate> candidates;
  for (const std::string& path : wanted.files) {
    candidates.push_back(proto::file_ending(path) == ".msh" ? read_mesh(path, result.notes)
                                                            : read_surface_stone(path, wanted, result.notes));
  }
  const double median = median_step(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    judge_step(candidates[i], median, wanted.files[i], result.notes);
    result.templates.push_back(std::move(candidates[i].shape));
  }
  return result;
}

}  // namespace qdem::bed
