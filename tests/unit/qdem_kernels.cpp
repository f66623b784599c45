// The loops of every instruction set this processor has, against plain loops over the same functors.
#include <gtest/gtest.h>

#include <set>

#include "qdem_solver/engine/cpu/tasks.hpp"
#include "qdem_solver/model/bond_network.hpp"
#include "tests/support/box_mesh.hpp"

using namespace qdem::cpu;

namespace {

using Values = std::vector<double>;

std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> sets{&kernels_base()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.push_back(&kernels_v3());
#endif
  if (std::string(kernels().instruction_set) != sets.back()->instruction_set) sets.push_back(&kernels());
  return sets;
}

/// The same numbers in [-1, 1) on every run.
Values some(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  Values values(n);
  for (double& value : values) value = 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
  return values;
}

/// Several blocks, and a last group of each that is not full.
qdem::Template box(qdem::Interaction interaction) {
  auto shape = tests::box_template({9, 8, 7}, {0.9, 0.8, 0.7}, 0.01);
  if (interaction == qdem::Interaction::bond) {
    shape.bonds = std::make_shared<qdem::BondNetwork>(qdem::make_bond_network(shape));
  }
  return shape;
}

struct Motion {
  explicit Motion(const qdem::Template& shape)
      : x(some(3 * shape.nodes.size(), 1)), v(some(3 * shape.nodes.size(), 2)) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1.5 * shape.nodes[i / 3][static_cast<int>(i % 3)] + 1e-3 * x[i];
  }
  Values x, v;
};

constexpr double body_scale = 1.5;
const ElementMaterial material{{3e10, 2e10, 4e3, 7e3}, {6e10, 5e3}};

template <class Force>
Values plain_forces(const ElementView& view, const Force& force, const Motion& motion) {
  constexpr int n = Force::n_particles;
  Values sum(motion.x.size(), 0.0);
  for (int e = 0; e < view.n_elements; ++e) {
    const int* particles = view.particles + n * e;
    double dx[9], dv[9], f[9];
    for (int i = 0; i < 3 * (n - 1); ++i) {
      const int here = 3 * particles[i / 3 + 1] + i % 3, first = 3 * particles[0] + i % 3;
      dx[i] = motion.x[here] - motion.x[first], dv[i] = motion.v[here] - motion.v[first];
    }
    force(dx, dv, view.shapes + Force::n_shape * e, view.weights[e], f);
    for (int i = 0; i < 3 * (n - 1); ++i) {
      sum[3 * particles[i / 3 + 1] + i % 3] += f[i], sum[3 * particles[0] + i % 3] -= f[i];
    }
  }
  return sum;
}

Values plain_forces(const ElementView& view, qdem::Interaction interaction, const Motion& motion) {
  if (interaction == qdem::Interaction::bond) {
    return plain_forces(view, qdem::BondForce<double>{body_scale, material.bond}, motion);
  }
  const qdem::QuadrupleForce<double> force{body_scale * body_scale, 1 / body_scale, material.quadruple};
  return plain_forces(view, force, motion);
}

Values block_forces(const Kernels& set, const ElementKernels& law, const ElementBlocks& all, const Motion& motion) {
  AlignedValues records(8 * all.copies.size()), slots(4 * all.copies.size());
  for (const auto& block : all.blocks) {
    law.block_forces({material, body_scale, block.n_groups, block.n_copies, all.corners_of(block),
                      all.numbers_of(block), &all.copies[block.first_copy], motion.x.data(), motion.v.data(),
                      records.data(), &slots[4 * block.first_copy]});
  }
  Values force(motion.x.size(), 0.0);
  set.gather({all.node_offsets.data(), all.node_copies.data(), 0, static_cast<int>(force.size() / 3), slots.data(),
              force.data()});
  return force;
}

double size_of(const Values& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double difference(const Values& p, const Values& q) {
  Values result(p);
  for (std::size_t i = 0; i < p.size(); ++i) result[i] -= q[i];
  return size_of(result);
}

class Interactions : public testing::TestWithParam<qdem::Interaction> {};

}  // namespace

TEST_P(Interactions, BlockForcesAreThoseOfThePlainLoop) {
  const auto shape = box(GetParam());
  const ElementView view = view_of(shape, GetParam());
  const ElementBlocks blocks = make_blocks(view, shape.nodes);
  const Motion motion(shape);
  const Values expected = plain_forces(view, GetParam(), motion);
  for (const Kernels* set : all_kernels()) {
    const Values found = block_forces(*set, kernels_of(*set, GetParam()), blocks, motion);
    EXPECT_LT(difference(found, expected), 1e-12 * size_of(expected)) << set->instruction_set;
  }
}

TEST_P(Interactions, LaneForcesAreThoseOfThePlainLoop) {
  const auto shape = box(GetParam());
  const ElementView view = view_of(shape, GetParam());
  const Motion motion(shape);
  const Values expected = plain_forces(view, GetParam(), motion);
  Values x(8 * motion.x.size()), v(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = motion.x[i / 8], v[i] = motion.v[i / 8] * static_cast<double>(i % 8);
  const Values scale(8, body_scale);
  for (const Kernels* set : all_kernels()) {
    AlignedValues force(x.size());
    kernels_of(*set, GetParam()).lane_forces({view, material, scale.data(), x.data(), v.data(), force.data()});
    Values of_lane(motion.x.size());
    for (std::size_t i = 0; i < of_lane.size(); ++i) of_lane[i] = force[8 * i + 1];
    EXPECT_LT(difference(of_lane, expected), 1e-12 * size_of(expected)) << set->instruction_set;
  }
}

TEST_P(Interactions, BlocksHoldEveryElementOnceInGroupsWithoutCommonParticles) {
  const auto shape = box(GetParam());
  const ElementView view = view_of(shape, GetParam());
  const ElementBlocks all = make_blocks(view, shape.nodes);
  EXPECT_GT(all.blocks.size(), 3u);
  std::multiset<std::vector<int>> found, expected;
  int n_groups = 0, n_disjoint = 0;
  for (const auto& block : all.blocks) {
    for (int group = 0; group < block.n_groups; ++group, ++n_groups) {
      std::set<int> particles;
      for (int lane = 0; lane < 8; ++lane) {
        std::vector<int> element;
        for (int k = 0; k < view.n_particles; ++k) {
          const int number = all.corners_of(block)[8 * (view.n_particles * group + k) + lane] / 8;
          element.push_back(all.copies[block.first_copy + number]);
        }
        particles.insert(element.begin(), element.end());
        if (all.numbers_of(block)[8 * (all.n_values * group + view.n_shape) + lane] != 0) found.insert(element);
      }
      n_disjoint += static_cast<int>(particles.size()) == 8 * view.n_particles;
    }
  }
  for (int e = 0; e < view.n_elements; ++e) {
    expected.emplace(view.particles + view.n_particles * e, view.particles + view.n_particles * (e + 1));
  }
  EXPECT_EQ(found, expected);
  EXPECT_GT(n_disjoint, 0.9 * n_groups);
  // Locality: blocks of a regular mesh share few particles. Random order would give a copy for nearly every corner.
  EXPECT_LT(static_cast<double>(all.copies.size()), 2.2 * static_cast<double>(shape.nodes.size()));
}

INSTANTIATE_TEST_SUITE_P(Kernels, Interactions, testing::Values(qdem::Interaction::quadruple, qdem::Interaction::bond));

TEST(Kernels, DriftMovesByTheSeriesAndReportsTheLargestMove) {
  constexpr double dt = 0.1;
  for (const Kernels* set : all_kernels()) {
    for (const int lanes : {1, 8}) {
      const int n = 3 * 13;
      const std::size_t padded = (n * lanes + 7) / 8 * 8;
      Values x = some(padded, 1), v = some(padded, 2), a = some(padded, 3);
      for (std::size_t i = n * lanes; i < padded; ++i) x[i] = v[i] = a[i] = 0.0;
      Values expected_x = x, expected_v = v, largest(8, 0.0);
      for (std::size_t i = 0; i < padded; ++i) {
        const double move = dt * v[i] + 0.5 * dt * dt * a[i];
        expected_x[i] += move, expected_v[i] += dt * a[i];
        double& of_lane = largest[i % lanes];
        of_lane = std::max(of_lane, std::abs(move));
      }
      const auto result = set->drift({dt, lanes, n, x.data(), v.data(), a.data()});
      EXPECT_LT(difference(x, expected_x) + difference(v, expected_v), 1e-15);
      for (int l = 0; l < lanes; ++l) EXPECT_NEAR(result.largest_move[l], largest[l], 1e-15) << set->instruction_set;
    }
  }
}

TEST(Kernels, KickAccelerates) {
  constexpr double dt = 0.1, damping = 0.3, drag = 0.2, gravity[3] = {1, -2, 3};
  for (const Kernels* set : all_kernels()) {
    for (const int lanes : {1, 8}) {
      const int n_nodes = 13;
      const std::size_t n = 3 * n_nodes * lanes, padded = (n + 7) / 8 * 8;
      const Values force = some(padded, 1);
      Values inverse_mass = some(padded, 2), v = some(padded, 3), a = some(padded, 4);
      for (std::size_t i = 0; i < padded; ++i) inverse_mass[i] = i >= n || i % 5 == 0 ? 0.0 : 2 + inverse_mass[i];
      Values expected_v = v, expected_a = a;
      for (std::size_t i = 0; i < n; ++i) {
        double accel = i % 5 == 0 ? 0.0 : force[i] * inverse_mass[i] + gravity[i / lanes % 3];
        accel -= damping * std::abs(accel) * (v[i] > 0 ? 1 : -1) + drag * v[i];
        expected_v[i] += 0.5 * dt * (accel - a[i]), expected_a[i] = accel;
      }
      set->kick({dt,
                 {gravity[0], gravity[1], gravity[2]},
                 damping,
                 drag,
                 lanes,
                 n_nodes,
                 force.data(),
                 inverse_mass.data(),
                 v.data(),
                 a.data()});
      v.resize(n), a.resize(n), expected_v.resize(n), expected_a.resize(n);
      EXPECT_LT(difference(v, expected_v) + difference(a, expected_a), 1e-14) << set->instruction_set << lanes;
    }
  }
}
