// The interface check finds what is wrong with a registration and names it.
#include "coupler/mapping/interface_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>

#include "proto/error.hpp"

namespace {

proto::RailSeat canted_seat() {
  proto::RailSeat seat;
  seat.name = "left";
  seat.origin = {0.3, 0.7535, -0.01};
  seat.axes = Eigen::AngleAxisd(1.0 / 20.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  seat.half_lengths = {0.075, 0.07};
  seat.cells = {2, 3};
  seat.stiffness = {60e6, 60e6, 225e6};
  seat.damping = {15e3, 15e3, 30e3};
  seat.clip_preload = 20e3;
  seat.tension_cutoff = true;
  return seat;
}

/// What a participant with an exact operator registers.
proto::Interface exact_interface(const proto::RailSeat& seat) {
  proto::SeatRegistration r;
  r.name = seat.name;
  const int n = seat.n_cells();
  r.rigid_response.resize(18 * n);
  for (int c = 0; c < n; ++c) {
    const Eigen::Vector3d point = seat.cell_point(c), arm = point - seat.origin;
    r.points.insert(r.points.end(), point.data(), point.data() + 3);
    r.weights.push_back(1.0 / n);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d direction = seat.axes.col(axis), moment = arm.cross(direction);
      for (int k = 0; k < 3; ++k) r.rigid_response[(k * n + c) * 3 + axis] = direction[k];
      for (int k = 0; k < 3; ++k) r.rigid_response[((k + 3) * n + c) * 3 + axis] = moment[k];
      r.force_resultants.insert(r.force_resultants.end(), direction.data(), direction.data() + 3);
      r.force_resultants.insert(r.force_resultants.end(), moment.data(), moment.data() + 3);
      const auto law = seat.cell_law(axis);
      r.stiffness.push_back(law.stiffness);
      r.damping.push_back(law.damping);
      r.preload.push_back(law.preload);
      r.tension_cutoff.push_back(law.tension_cutoff);
    }
  }
  return {{{"impulse", "N s", 3, true}, {"rail_displacement", "m", 3, false}}, {r}};
}

std::string complaint(const std::function<void()>& check) {
  try {
    check();
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
    return error.what();
  }
  return "";
}

std::string complaint(const proto::Interface& interface) {
  return complaint([&] { coupler::check_interface("fem", interface, {canted_seat()}); });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(InterfaceCheck, AcceptsAnExactOperator) {
  EXPECT_EQ(complaint(exact_interface(canted_seat())), "");
}

TEST(InterfaceCheck, NamesAWrongWeight) {
  auto interface = exact_interface(canted_seat());
  interface.seats[0].weights[4] += 1e-9;
  const auto text = complaint(interface);
  EXPECT_TRUE(contains(text, "cell 4 has the weight")) << text;
  EXPECT_TRUE(contains(text, "interface of fem, seat 'left'")) << text;
}

TEST(InterfaceCheck, NamesAMovedPoint) {
  auto interface = exact_interface(canted_seat());
  interface.seats[0].points[3 * 2 + 1] += 2e-9;
  EXPECT_TRUE(contains(complaint(interface), "cell 2 lies at"));
  interface = exact_interface(canted_seat());
  interface.seats[0].points[3 * 2 + 1] += 5e-10;
  EXPECT_EQ(complaint(interface), "");
}

TEST(InterfaceCheck, FindsARotatedResponse) {
  auto interface = exact_interface(canted_seat());
  auto turned = canted_seat();
  turned.axes = turned.axes * Eigen::AngleAxisd(1e-9, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  interface.seats[0].rigid_response = exact_interface(turned).seats[0].rigid_response;
  EXPECT_TRUE(contains(complaint(interface), "does not reproduce rigid motions: translation x"));
}

TEST(InterfaceCheck, FindsARotationAboutAnotherPoint) {
  auto interface = exact_interface(canted_seat());
  interface.seats[0].rigid_response[(3 * 6 + 1) * 3 + 2] += 1e-11;
  EXPECT_TRUE(contains(complaint(interface), "rotation x gives"));
  EXPECT_TRUE(contains(complaint(interface), "cell 1 axis 3"));
}

TEST(InterfaceCheck, FindsALostMoment) {
  auto interface = exact_interface(canted_seat());
  interface.seats[0].force_resultants[(5 * 3 + 2) * 6 + 4] += 1e-11;
  EXPECT_TRUE(contains(complaint(interface), "does not conserve moments: a unit force in cell 5 axis 3 has moment y"));
}

TEST(InterfaceCheck, NotANumberIsRefused) {
  auto interface = exact_interface(canted_seat());
  interface.seats[0].force_resultants[7] = std::nan("");
  EXPECT_TRUE(contains(complaint(interface), "does not conserve forces"));
}

TEST(InterfaceCheck, NamesSeatAndCount) {
  auto interface = exact_interface(canted_seat());
  interface.seats[0].name = "right";
  EXPECT_TRUE(contains(complaint(interface), "registered as 'right'"));
  interface = exact_interface(canted_seat());
  interface.seats[0].weights.pop_back();
  EXPECT_TRUE(contains(complaint(interface), "5 cell weights were registered instead of 6"));
  interface.seats.clear();
  EXPECT_TRUE(contains(complaint(interface), "0 rail seats were registered instead of 1"));
}

TEST(InterfaceCheck, PadComesFromItsOwner) {
  auto interface = exact_interface(canted_seat());
  const auto laws = coupler::registered_pad("qdem", interface, {canted_seat()});
  ASSERT_EQ(laws.size(), 18u);
  EXPECT_DOUBLE_EQ(laws[2].stiffness, 225e6 / 6);
  EXPECT_TRUE(laws[2].tension_cutoff);
  EXPECT_FALSE(laws[1].tension_cutoff);
  interface.seats[0].damping[5] = -1.0;
  const auto text = complaint([&] { coupler::registered_pad("qdem", interface, {canted_seat()}); });
  EXPECT_TRUE(contains(text, "the pad's damping of cell 1 axis 3 is -1")) << text;
}

TEST(InterfaceCheck, OutgoingFieldsMustBeGiven) {
  const auto interface = exact_interface(canted_seat());
  const auto check = [&](const char* name) {
    return complaint([&] { coupler::check_outgoing_fields("qdem", interface, {name}); });
  };
  EXPECT_EQ(check("impulse"), "");
  EXPECT_TRUE(contains(check("rail_displacement"), "the field 'rail_displacement' is not among those"));
}

}  // namespace
