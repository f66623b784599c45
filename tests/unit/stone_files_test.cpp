// Stones from files: what is repaired, what is refused with which words, and what becomes of the rest.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "proto/error.hpp"
#include "qdem_solver/bed/random.hpp"
#include "qdem_solver/bed/rough_surface.hpp"
#include "qdem_solver/bed/scan.hpp"
#include "qdem_solver/bed/stone_files.hpp"
#include "qdem_solver/bed/surface_algorithms.hpp"
#include "qdem_solver/bed/surface_file.hpp"
#include "qdem_solver/contact/surface_point.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/stone_surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace tests;
using namespace qdem::bed;
using Eigen::Vector3d;

const Vector3d brick(48, 40, 32);  // mm

class StoneFiles : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.file(name), std::ios::binary) << content;
    return folder_.file(name);
  }
  Scan scan_of(const Polyhedron& shape) const { return read_scan(write("stone.stl", stl_text(shape))); }

  StoneTemplates templates_of(const std::vector<std::string>& paths) const {
    StoneShapes shapes;
    shapes.files = paths, shapes.n_templates = static_cast<int>(paths.size());
    return read_stone_templates(shapes);
  }

  template <class Work>
  std::string refusal(const Work& work) const {
    try {
      work();
    } catch (const proto::Error& error) {
      EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
      EXPECT_NE(std::string(error.what()).find(folder_.path()), std::string::npos) << error.what();
      return error.what();
    }
    return "accepted";
  }
  std::string refusal_of(const Polyhedron& shape) const {
    return refusal([&] { scan_of(shape); });
  }

  TemporaryFolder folder_;
};

void expect_told(const std::vector<std::string>& notes, const std::string& words) {
  const bool told = std::any_of(notes.begin(), notes.end(),
                                [&](const std::string& note) { return note.find(words) != std::string::npos; });
  EXPECT_TRUE(told) << words << "\n" << ::testing::PrintToString(notes);
}

bool contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
  return true;
}

TEST_F(StoneFiles, AGoodSurfaceIsNotRepaired) {
  const Scan scan = scan_of(box_surface(brick));
  EXPECT_TRUE(scan.repairs.empty());
  EXPECT_EQ(scan.shape.corners.size(), 8u);
  EXPECT_TRUE(near_rel(volume(scan.shape), brick.prod(), 1e-12));
}

TEST_F(StoneFiles, WhatIsWrittenIsRead) {
  const Polyhedron sphere = sphere_surface(0.5, 2);
  write_stl(folder_.file("sphere.stl"), sphere, 60.0);
  const Scan scan = read_scan(folder_.file("sphere.stl"));
  EXPECT_EQ(scan.shape.faces.size(), sphere.faces.size());
  EXPECT_TRUE(near_rel(volume(scan.shape), std::pow(60.0, 3) * volume(sphere), 1e-6));
}

TEST_F(StoneFiles, DuplicateVerticesAreMerged) {
  Polyhedron loose;
  for (const auto& face : box_surface(brick).faces) {
    const int first = static_cast<int>(loose.corners.size());
    for (const int corner : face)
      loose.corners.push_back(box_surface(brick).corners[corner] + Vector3d(1e-6, 0, 0) * first);
    loose.faces.push_back({first, first + 1, first + 2});
  }
  const Scan scan = read_scan(write("loose.obj", obj_text(loose)));
  EXPECT_EQ(scan.shape.corners.size(), 8u);
  expect_told(scan.repairs, "28 duplicate vertices merged");
}

TEST_F(StoneFiles, DegenerateAndDoubledFacetsAreDropped) {
  Polyhedron box = box_surface(brick);
  box.faces.push_back({0, 1, 1});
  box.faces.push_back(box.faces[3]);
  const Scan scan = read_scan(write("box.obj", obj_text(box)));
  EXPECT_EQ(scan.shape.faces.size(), 12u);
  expect_told(scan.repairs, "1 degenerate facets dropped");
  expect_told(scan.repairs, "1 doubled facets dropped");
}

TEST_F(StoneFiles, AFacetWithItsCornersOnALineIsDropped) {
  Polyhedron box = box_surface(brick);
  const int middle = 8;  // of the edge 0-1: one neighbour keeps the whole edge, a facet without area fills in
  box.corners.push_back(0.5 * (box.corners[0] + box.corners[1]));
  box.faces[0] = {0, 2, middle};
  box.faces.push_back({middle, 2, 1});
  box.faces.push_back({0, middle, 1});
  const Scan scan = scan_of(box);
  expect_told(scan.repairs, "degenerate facets dropped");
  EXPECT_TRUE(near_rel(volume(scan.shape), brick.prod(), 1e-12));
}

TEST_F(StoneFiles, FacetsAreTurnedOutward) {
  Polyhedron box = box_surface(brick);
  for (auto& face : box.faces) std::swap(face[0], face[1]);
  const Scan inside_out = scan_of(box);
  expect_told(inside_out.repairs, "inside out");
  EXPECT_TRUE(near_rel(volume(inside_out.shape), brick.prod(), 1e-12));

  box = box_surface(brick);
  std::swap(box.faces[5][0], box.faces[5][1]);
  const Scan mixed = scan_of(box);
  expect_told(mixed.repairs, "1 facets turned");
  EXPECT_TRUE(near_rel(volume(mixed.shape), brick.prod(), 1e-12));
}

TEST_F(StoneFiles, WhatIsNoBodyIsRefused) {
  Polyhedron open = box_surface(brick);
  open.faces.pop_back();
  contains(refusal_of(open),
           "the surface is open: 3 edges belong to one facet only, the first from (48, 40, 0) to (48, 0, 32)");

  Polyhedron finned = box_surface(brick);
  finned.corners.push_back({20, 20, 60});
  finned.faces.push_back({4, 5, 8});
  contains(refusal_of(finned), "the surface is not simple: 3 facets share the edge from (0, 0, 32) to (48, 0, 32)");

  Polyhedron two = box_surface(brick);
  const Polyhedron other = box_surface(brick, {100, 0, 0});
  for (const auto& [a, b, c] : other.faces) two.faces.push_back({a + 8, b + 8, c + 8});
  two.corners.insert(two.corners.end(), other.corners.begin(), other.corners.end());
  contains(refusal_of(two), "the surface has 2 parts");

  Polyhedron crossing = sphere_surface(30, 2);
  crossing.corners[4] *= -2;
  contains(refusal_of(crossing), "the surface cuts through itself, first at (");
}

TEST_F(StoneFiles, WhatIsNoSurfaceIsRefused) {
  const std::string words = "it is not a whole surface in the format STL";
  for (const std::string& content :
       {std::string(), std::string("hello\n"), std::string("solid x\nfacet normal 0 0 1\n"),
        std::string(80, 'x') + std::string("\xff\xff\xff\xff", 4) + std::string(60, 'y')}) {
    const auto path = write("none.stl", content);
    contains(refusal([&] { read_scan(path); }), words);
  }
  const auto path = write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  contains(refusal([&] { read_scan(path); }), "in the format OBJ");
}

TEST_F(StoneFiles, ABoxKeepsItsShape) {
  const auto stones = templates_of({write("brick.stl", stl_text(box_surface(brick)))});
  ASSERT_EQ(stones.templates.size(), 1u);
  const auto& stone = stones.templates[0];
  EXPECT_EQ(stone.name, "brick.stl");
  EXPECT_GE(stone.n_tets(), 50);
  EXPECT_LE(stone.n_tets(), 100);
  EXPECT_TRUE(near_rel(stone.volume(), brick.prod() / std::pow(brick[1], 3), 1e-9));
  Vector3d low = stone.nodes[0], high = low;
  for (const Vector3d& x : stone.nodes) low = low.cwiseMin(x), high = high.cwiseMax(x);
  EXPECT_TRUE(near_abs((high - low - brick / brick[1]).norm(), 0.0, 1e-9));
}

TEST_F(StoneFiles, ASphereKeepsItsVolume) {
  const Polyhedron sphere = sphere_surface(30, 4);
  EXPECT_TRUE(near_rel(volume(sphere), 4 * M_PI / 3 * std::pow(30.0, 3), 6e-3));
  const Polyhedron coarse = coarsened(sphere, 40);
  EXPECT_EQ(coarse.faces.size(), 40u);
  EXPECT_TRUE(near_rel(volume(coarse), 4 * M_PI / 3 * std::pow(30.0, 3), 1e-2));
  const auto stones = templates_of({write("sphere.stl", stl_text(sphere))});
  EXPECT_TRUE(near_rel(stones.templates[0].volume(), M_PI / 6, 0.1));  // its corners stand out of the sphere
  expect_told(stones.notes, "2048 facets coarsened to ");
}

TEST_F(StoneFiles, TheSameFilesGiveTheSameBits) {
  Random random(1, 1);
  const auto path = write("rough.stl", stl_text(roughened(sphere_surface(0.5, 3), {0.02, 0}, random)));
  const auto a = templates_of({path}), b = templates_of({path});
  EXPECT_EQ(a.templates[0].tets, b.templates[0].tets);
  EXPECT_EQ(a.templates[0].nodes, b.templates[0].nodes);
  EXPECT_EQ(a.notes, b.notes);
}

TEST_F(StoneFiles, AMeshIsTakenAsItIs) {
  const Mesh mesh = box_mesh({2, 2, 2}, brick);
  const auto stones = templates_of({write("brick.msh", msh_text(mesh))});
  EXPECT_EQ(stones.templates[0].n_tets(), 48);
  EXPECT_TRUE(near_rel(stones.templates[0].volume(), brick.prod() / std::pow(brick[1], 3), 1e-12));
  EXPECT_TRUE(stones.notes.empty());
}

TEST_F(StoneFiles, BadMeshesAreNamed) {
  const auto refusal_of_mesh = [&](const Mesh& mesh) {
    const auto path = write("bad.msh", msh_text(mesh));
    return refusal([&] { templates_of({path}); });
  };
  Mesh inverted = box_mesh({1, 1, 1}, {6, 6, 6});
  std::swap(inverted.tets[2][0], inverted.tets[2][1]);
  contains(refusal_of_mesh(inverted), "1 inverted or flat tetrahedra: 103 (volume -36 file units cubed)");

  Mesh hinged = box_mesh({1, 1, 1}, {6, 6, 6});
  hinged.tets = {hinged.tets[0], hinged.tets[2]};  // they share the diagonal only
  contains(refusal_of_mesh(hinged), "4 triangles share the edge of nodes");

  Mesh apart = box_mesh({1, 1, 1}, {6, 6, 6});
  for (const Vector3d& node : box_mesh({1, 1, 1}, {6, 6, 6}).nodes) apart.nodes.push_back(node + Vector3d(20, 0, 0));
  for (auto tet : box_mesh({1, 1, 1}, {6, 6, 6}).tets) {
    for (int& node : tet) node += 8;
    apart.tets.push_back(tet);
  }
  contains(refusal_of_mesh(apart), "skin of 2 parts");

  contains(refusal([&] { templates_of({write("text.msh", "Point(1) = {0, 0, 0};\n")}); }), "not a mesh file of Gmsh");
  contains(refusal([&] { templates_of({write("empty.msh", msh_text({}))}); }), "no 4-node tetrahedra");
}

TEST_F(StoneFiles, LeftHandedMeshesAreTurned) {
  Mesh mesh = box_mesh({2, 2, 2}, brick);
  for (auto& tet : mesh.tets) std::swap(tet[0], tet[1]);
  const auto stones = templates_of({write("left.msh", msh_text(mesh))});
  expect_told(stones.notes, "left.msh: all tetrahedra were numbered left-handed");
  EXPECT_GT(stones.templates[0].volume(), 0);
}

TEST_F(StoneFiles, SliversAreToldOrRefused) {
  std::vector<std::string> paths;
  for (const char* name : {"a.msh", "b.msh"}) paths.push_back(write(name, msh_text(box_mesh({2, 2, 2}, brick))));
  Mesh mesh = box_mesh({2, 2, 2}, brick);
  Vector3d& middle = mesh.nodes[13];
  middle[0] = 0.05 * brick[0];
  paths.push_back(write("slim.msh", msh_text(mesh)));
  const auto notes = templates_of(paths).notes;
  expect_told(notes, "slim.msh: its stable step is 0.45 of the median of all stones, by tetrahedron 111");
  middle[0] = 0.01 * brick[0];
  paths.back() = write("sliver.msh", msh_text(mesh));
  contains(refusal([&] { templates_of(paths); }), "of the median of all stones");
}

bool in_a_tetrahedron(const qdem::Template& shape, const Vector3d& p) {
  return std::any_of(shape.tets.begin(), shape.tets.end(), [&](const auto& tet) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = shape.nodes[tet[k + 1]] - shape.nodes[tet[0]];
    const Vector3d weights = edges.inverse() * (p - shape.nodes[tet[0]]);
    return weights.minCoeff() >= 0 && weights.sum() <= 1;
  });
}

TEST_F(StoneFiles, ContactKnowsTheInsideOfHollowStones) {
  Random random(3, 1);
  const auto path = write("rough.stl", stl_text(roughened(sphere_surface(0.5, 3), {0.08, 0}, random)));
  const auto model = free_bodies(templates_of({path}).templates[0], rock());
  const auto& shape = model.templates[0];
  EXPECT_FALSE(is_convex(shape));
  const auto state = make_state(model, {qdem::Placement{}});
  const auto skin = qdem::make_skins(model)[0];
  std::vector<int> triangles(shape.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0);
  int n_near = 0, n_wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p = 0.9 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto point =
        nearest_surface_point(skin, state.x.data(), p, triangles.data(), triangles.data() + triangles.size());
    if (std::abs(point.distance) > 0.1) continue;  // a contact is nearer than that
    ++n_near, n_wrong += (point.distance < 0) != in_a_tetrahedron(shape, p);
  }
  EXPECT_GT(n_near, 1000);
  EXPECT_EQ(n_wrong, 0);
}

}  // namespace
