// Contact of two meshes of finite elements: Hertz (physics.md 3.1) and Cattaneo's shift (K2 of 3.2), and the half-space
// patch against it.
#include <cmath>
#include <cstdio>

#include "fem_solver/contact/block_contact.hpp"
#include "proto/error.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_rel;

/// Two radii under a force, `elements` to a semi-axis, shifted along the rail.
fem::ContactCase radii(double wheel, double crown, const fem::ElasticBody& body, double force, int elements) {
  fem::ContactCase c;
  c.geometry = {1 / wheel, 1 / crown, {}, 0.0};
  c.wheel = c.rail = body;
  c.normal_force = force;
  c.hertz = fem::hertz_ellipse(wheel, crown, body, body, force);
  c.grid = fem::grid_around(*c.hertz, elements, 1.25);
  c.motion = fem::ContactMotion::shift;
  return c;
}

TEST(Blocks, hertz_within_3_percent) {
  fem::ContactCase input = radii(0.43, 0.30, {210e9, 0.3}, 80e3, 16);
  input.friction = 0.3, input.shift_x = -10e-6;
  const auto found = fem::analyse_block_contact(input);
  const auto& e = found.ellipse;
  std::printf("a %.4f mm (6.433), b %.4f mm (5.061), p0 %.2f MPa (1173), approach %.3f um (90.8)\n",
              e.semi_axis_x * 1e3, e.semi_axis_y * 1e3, e.peak_pressure * 1e-6, found.normal.approach * 1e6);
  EXPECT_TRUE(near_rel(e.semi_axis_x, 6.433e-3, 0.03));
  EXPECT_TRUE(near_rel(e.semi_axis_y, 5.061e-3, 0.03));
  EXPECT_TRUE(near_rel(e.peak_pressure, 1173e6, 0.03));
  EXPECT_TRUE(near_rel(found.normal.approach, 90.8e-6, 0.03));
  EXPECT_TRUE(near_rel(found.normal.pressure.sum() * found.grid.area(), 80e3, 1e-8));

  const auto half_space = fem::analyse_contact(input);
  std::printf("half-space over blocks: area %.4f, stiffness %.4f, shear %.4f\n", half_space.area / found.area,
              half_space.normal.tangent / found.normal.tangent,
              half_space.point.force.longitudinal / found.point.force.longitudinal);
  EXPECT_TRUE(near_rel(half_space.area, found.area, 0.05));
  EXPECT_TRUE(near_rel(half_space.normal.tangent, found.normal.tangent, 0.02));
  EXPECT_TRUE(near_rel(half_space.point.force.longitudinal, found.point.force.longitudinal, 0.02));
}

TEST(Blocks, cattaneo_shift_within_5_percent) {
  fem::ContactCase input = radii(0.05, 0.05, {2 * 200e6 * 1.42, 0.42}, 9.1954, 12);
  input.friction = 0.4, input.shift_x = -8.17e-6;
  const auto found = fem::analyse_block_contact(input);
  const double pull = found.point.force.longitudinal / (0.4 * 9.1954);
  const double radius = std::sqrt(found.point.stick_share * found.area / M_PI);
  std::printf("pull %.4f mu F (0.875), stick radius %.4f mm (0.5), p0 %.4f MPa (4.3905)\n", pull, radius * 1e3,
              found.ellipse.peak_pressure * 1e-6);
  EXPECT_TRUE(near_rel(pull, 0.875, 0.05));
  EXPECT_TRUE(near_rel(radius, 0.5e-3, 0.05));
  EXPECT_TRUE(near_rel(found.ellipse.peak_pressure, 4.3905e6, 0.05));
}

TEST(Blocks, refuse_what_they_do_not_cover) {
  fem::ContactCase input = radii(0.43, 0.30, {210e9, 0.3}, 80e3, 8);
  input.motion = fem::ContactMotion::rolling;
  EXPECT_THROW(fem::analyse_block_contact(input), proto::Error);
  input = radii(0.43, 0.30, {210e9, 0.3}, 80e3, 9);
  EXPECT_THROW(fem::analyse_block_contact(input), proto::Error);
}

}  // namespace
