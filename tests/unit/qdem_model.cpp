// Templates, batches, pad cells.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "proto/error.hpp"
#include "qdem_solver/engine/pads.hpp"
#include "qdem_solver/model/pad_cells.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

using Eigen::Vector3d;
using tests::near_abs;
using tests::near_rel;

TEST(Template, BoxHasItsVolumeSkinAndSharpEdges) {
  const auto shape = tests::box_template({3, 2, 2}, {0.3, 0.2, 0.4});
  EXPECT_TRUE(near_rel(shape.volume(), 0.3 * 0.2 * 0.4, 1e-14));
  double lumped = 0;
  for (const double v : shape.node_volumes) lumped += v;
  EXPECT_TRUE(near_rel(lumped, shape.volume(), 1e-14));
  EXPECT_EQ(shape.triangles.size(), 2u * (2 * 3 * 2 + 2 * 3 * 2 + 2 * 2 * 2));
  Vector3d area = Vector3d::Zero();
  double outward = 0;  // three times the volume, by the divergence theorem
  for (const auto& t : shape.triangles) {
    const Vector3d &a = shape.nodes[t.nodes[0]], &b = shape.nodes[t.nodes[1]], &c = shape.nodes[t.nodes[2]];
    const Vector3d n = 0.5 * (b - a).cross(c - a);
    area += n, outward += n.dot(a + b + c) / 3;
  }
  EXPECT_LT(area.norm(), 1e-16);
  EXPECT_TRUE(near_rel(outward, 3 * shape.volume(), 1e-13));
  // Sharp are the 12 edges of the box only: 4 along each direction, cut into cells.
  int sharp = 0;
  for (const auto& edge : shape.edges) sharp += edge.sharp;
  EXPECT_EQ(sharp, 4 * (3 + 2 + 2));
  EXPECT_EQ(2 * shape.edges.size(), 3 * shape.triangles.size());
}

TEST(Template, AdjacencyListsEverySlotOnceInOrder) {
  const auto shape = tests::box_template({2, 2, 2}, {1, 1, 1});
  std::vector<int> seen(4 * shape.n_tets(), 0);
  for (int node = 0; node < shape.n_nodes(); ++node) {
    for (int i = shape.adjacency_offsets[node]; i < shape.adjacency_offsets[node + 1]; ++i) {
      const int slot = shape.adjacency_slots[i];
      EXPECT_EQ(shape.tets[slot / 4][slot % 4], node);
      if (i > shape.adjacency_offsets[node]) {
        EXPECT_LT(shape.adjacency_slots[i - 1], slot);
      }
      ++seen[slot];
    }
  }
  for (const int n : seen) EXPECT_EQ(n, 1);
}

TEST(Template, RefusesInvertedTetrahedronByNumberAndVolume) {
  auto mesh = tests::box_mesh({2, 1, 1}, {2, 1, 1});
  std::swap(mesh.tets[7][0], mesh.tets[7][1]);
  try {
    qdem::make_template("bad", mesh.nodes, mesh.tets);
    FAIL() << "an inverted tetrahedron was accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
    EXPECT_NE(std::string(error.what()).find("7 (volume -0.166667 m3)"), std::string::npos) << error.what();
  }
}

TEST(Template, RefusesOpenSurface) {
  auto mesh = tests::box_mesh({2, 1, 1}, {2, 1, 1});
  // Two tetrahedra that share an edge only.
  mesh.tets = {mesh.tets[0], {mesh.tets[0][0], mesh.tets[0][1], 11, 8}};
  mesh.nodes[11] = {-1, -1, -0.3}, mesh.nodes[8] = {-1, -1, -1.5};
  EXPECT_THROW(qdem::make_template("bad", mesh.nodes, mesh.tets), proto::Error);
}

TEST(Batches, EveryBodyHasItsOwnPlace) {
  auto model = tests::free_bodies(tests::box_template({1, 1, 1}, {1, 1, 1}), tests::rock(), 21);
  model.templates.push_back(tests::box_template({2, 1, 1}, {2, 1, 1}));
  for (const int body : {3, 8, 20}) model.bodies[body].template_id = 1;
  model.bodies[5].scale = 0.5;
  qdem::make_batches(model);
  std::vector<int> owner(model.n_values, -1);
  for (int body = 0; body < 21; ++body) {
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      for (int c = 0; c < 3; ++c) {
        int& place = owner.at(model.index(body, node) + c * model.stride(body));
        EXPECT_EQ(place, -1);
        place = body;
      }
    }
  }
  const Vector3d shift(3, 4, 5);
  std::vector<qdem::Placement> places(21);
  places[5].translation = shift;
  const auto state = qdem::make_state(model, places);
  EXPECT_EQ(state.position(model, 5, 7), 0.5 * model.shape(5).nodes[7] + shift);
  EXPECT_TRUE(near_rel(model.body_mass(5), 2700.0 / 8, 1e-14));
}

namespace {

proto::RailSeat tilted_seat(const Eigen::Matrix3d& axes, const Vector3d& origin) {
  proto::RailSeat seat;
  seat.name = "seat", seat.origin = origin, seat.axes = axes;
  seat.half_lengths = {0.075, 0.07}, seat.cells = {3, 3};
  seat.stiffness = {6e7, 5e7, 2e8}, seat.damping = {1e4, 2e4, 3e4};
  return seat;
}

/// A sleeper whose top is a little out of the seat's plane: moved by 0.1 mm and tilted by 1e-3.
struct SleeperUnderSeat {
  qdem::Model model;
  qdem::State state;
  proto::RailSeat seat;

  SleeperUnderSeat() {
    auto mesh = tests::box_mesh({5, 9, 3}, {0.3, 0.5, 0.2});
    model = tests::free_bodies(qdem::make_template("sleeper", mesh.nodes, mesh.tets), tests::rock());
    model.pad_body = 0;
    const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.02, Vector3d(0, 1, 0)).toRotationMatrix();
    seat = tilted_seat(axes, {0.01, 0.75, -0.02});
    qdem::Placement place;
    place.rotation = axes * Eigen::AngleAxisd(1e-3, Vector3d(1, 2, 0).normalized()).toRotationMatrix();
    place.translation = seat.origin - place.rotation * Vector3d(0.15, 0.26, 0.2) + axes.col(2) * 1e-4;
    state = qdem::make_state(model, {place});
  }
};

}  // namespace

TEST(PadCells, ReproduceRigidMotionsAndTransposeForces) {
  SleeperUnderSeat s;
  s.model.pads = qdem::make_pad_cells(s.model, s.state, 0, {s.seat});
  const qdem::PadOperator op(s.model);
  ASSERT_EQ(op.n_values(), 27u);
  std::vector<double> field(s.model.n_values), values(27);
  const Vector3d shift(0.3, -0.2, 0.5), turn(0.7, -0.4, 0.2);
  for (int i = 0; i < s.model.shape(0).n_nodes(); ++i) {
    const Vector3d arm = s.state.position(s.model, 0, i) - s.seat.origin;
    qdem::State::scatter(s.model, field, 0, i, shift + turn.cross(arm));
  }
  op.apply(field, values);
  std::vector<double> force(s.model.n_values, 0.0), unit(27);
  for (int i = 0; i < 27; ++i) unit[i] = std::sin(1.0 + i);
  op.add_transposed(unit, force);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  for (int i = 0; i < s.model.shape(0).n_nodes(); ++i) {
    const Vector3d f = qdem::State::gather(s.model, force, 0, i);
    sum += f, moment += (s.state.position(s.model, 0, i) - s.seat.origin).cross(f);
  }
  for (int cell = 0; cell < 9; ++cell) {
    const Vector3d arm = s.seat.cell_point(cell) - s.seat.origin;
    const Vector3d expected = s.seat.axes.transpose() * (shift + turn.cross(arm));
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(near_abs(values[3 * cell + c], expected[c], 1e-12)) << cell;
    const Vector3d f = s.seat.axes * Vector3d(unit[3 * cell], unit[3 * cell + 1], unit[3 * cell + 2]);
    sum -= f, moment -= arm.cross(f);
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT(moment.norm(), 1e-12);
}

TEST(PadCells, RefuseASeatBesideOrAboveTheSleeper) {
  SleeperUnderSeat s;
  auto beside = s.seat, above = s.seat;
  beside.origin += s.seat.axes.col(0) * 0.1;
  above.origin += s.seat.axes.col(2) * 0.003;
  EXPECT_THROW(qdem::make_pad_cells(s.model, s.state, 0, {beside}), proto::Error);
  EXPECT_THROW(qdem::make_pad_cells(s.model, s.state, 0, {above}), proto::Error);
}
