#include "coupler/mapping/interface_check.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace coupler {
namespace {

constexpr double point_tolerance_m = 1e-9;
constexpr double operator_tolerance = 1e-12;
constexpr std::size_t most_own_points = 256;  // of a seat: the operator is dense and travels in one message
constexpr const char* motion_names[6] = {"translation x", "translation y", "translation z",
                                         "rotation x",    "rotation y",    "rotation z"};

[[noreturn]] void refuse(const std::string& problem, const std::string& where) {
  throw proto::Error(proto::ExitCode::protocol, problem, where,
                     "the interface is defined by the case's [[rail_seat]]; see proto/README.md");
}

std::string place(const std::string& side, const proto::RailSeat& seat) {
  return fmt::format("interface of {}, seat '{}'", side, seat.name);
}

void expect_size(std::size_t found, std::size_t wanted, const char* what, const std::string& where) {
  if (found != wanted) refuse(fmt::format("{} {} were registered instead of {}", found, what, wanted), where);
}

using Points = std::vector<Eigen::Vector3d>;

void check_cells(const std::string& side, const proto::SeatRegistration& found, const proto::RailSeat& seat) {
  const std::size_t n = static_cast<std::size_t>(seat.n_cells());
  const auto where = place(side, seat);
  expect_size(found.points.size(), 3 * n, "cell coordinates", where);
  expect_size(found.weights.size(), n, "cell weights", where);
  for (std::size_t c = 0; c < n; ++c) {
    const Eigen::Vector3d point(found.points[3 * c], found.points[3 * c + 1], found.points[3 * c + 2]);
    const Eigen::Vector3d wanted = seat.cell_point(static_cast<int>(c));
    if (!((point - wanted).norm() <= point_tolerance_m))
      refuse(fmt::format("cell {} lies at ({}, {}, {}) m instead of ({}, {}, {}) m", c, point[0], point[1], point[2],
                         wanted[0], wanted[1], wanted[2]),
             where);
    if (!(std::abs(found.weights[c] - seat.cell_weight()) <= operator_tolerance))
      refuse(fmt::format("cell {} has the weight {} instead of {}", c, found.weights[c], seat.cell_weight()), where);
  }
}

/// Points of the participant's own lie on the pad or around it, and the pad's owner has none.
void check_own_points(const std::string& side, const proto::SeatRegistration& found, const proto::RailSeat& seat) {
  const auto where = place(side, seat);
  if (!found.stiffness.empty()) refuse("the pad's owner registered points of its own instead of the cells", where);
  if (found.points.empty() || found.points.size() > 3 * most_own_points)
    refuse(fmt::format("{} points of its own were registered, between 1 and {} can be mapped", found.points.size() / 3,
                       most_own_points),
           where);
  expect_size(found.points.size(), 3 * found.weights.size(), "point coordinates", where);
  const double reach = 2.0 * seat.half_lengths.norm();
  for (const auto& point : registered_points(found))
    if (!((point - seat.origin).norm() <= reach))
      refuse(fmt::format("a point of its own, ({}, {}, {}) m, lies more than {} m from the seat's origin", point[0],
                         point[1], point[2], reach),
             where);
}

/// Displacement of a point at `arm` from the seat's origin under unit motion `motion` (three translations, three
/// rotations).
Eigen::Vector3d rigid_motion(int motion, const Eigen::Vector3d& arm) {
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(motion % 3);
  return motion < 3 ? axis : Eigen::Vector3d(axis.cross(arm));
}

void check_rigid_response(const std::string& side, const proto::SeatRegistration& found, const proto::RailSeat& seat,
                          const Points& points) {
  const int n = static_cast<int>(points.size());
  const auto where = place(side, seat);
  expect_size(found.rigid_response.size(), 18 * static_cast<std::size_t>(n), "rigid responses", where);
  const double size = seat.half_lengths.norm();
  for (int motion = 0; motion < 6; ++motion)
    for (int c = 0; c < n; ++c) {
      const Eigen::Vector3d wanted =
          seat.axes.transpose() * rigid_motion(motion, points[static_cast<std::size_t>(c)] - seat.origin);
      for (int axis = 0; axis < 3; ++axis) {
        const double value = found.rigid_response[static_cast<std::size_t>((motion * n + c) * 3 + axis)];
        if (!(std::abs(value - wanted[axis]) <= operator_tolerance * (motion < 3 ? 1.0 : size)))
          refuse(fmt::format("the operator does not reproduce rigid motions: {} gives {:.17g} in cell {} axis {} "
                             "instead of {:.17g}",
                             motion_names[motion], value, c, axis + 1, wanted[axis]),
                 where);
      }
    }
}

void check_force_resultants(const std::string& side, const proto::SeatRegistration& found, const proto::RailSeat& seat,
                            const Points& points) {
  const int n = static_cast<int>(points.size());
  const auto where = place(side, seat);
  expect_size(found.force_resultants.size(), 18 * static_cast<std::size_t>(n), "force resultants", where);
  const double size = seat.half_lengths.norm();
  for (int c = 0; c < n; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d force = seat.axes.col(axis);
      const Eigen::Vector3d moment = (points[static_cast<std::size_t>(c)] - seat.origin).cross(force);
      for (int k = 0; k < 6; ++k) {
        const double value = found.force_resultants[static_cast<std::size_t>((c * 3 + axis) * 6 + k)];
        const double wanted = k < 3 ? force[k] : moment[k - 3];
        if (!(std::abs(value - wanted) <= operator_tolerance * (k < 3 ? 1.0 : size)))
          refuse(fmt::format("the operator does not conserve {}: a unit force in cell {} axis {} has {} {} = {:.17g} "
                             "instead of {:.17g}",
                             k < 3 ? "forces" : "moments", c, axis + 1, k < 3 ? "force" : "moment", "xyz"[k % 3], value,
                             wanted),
                 where);
      }
    }
}

std::vector<proto::FieldSpec>::const_iterator find_field(const proto::Interface& registered, const std::string& name,
                                                         bool outgoing) {
  return std::find_if(registered.fields.begin(), registered.fields.end(),
                      [&](const auto& spec) { return spec.outgoing == outgoing && spec.name == name; });
}

double coefficient(const std::vector<double>& values, std::size_t i, const char* name, const std::string& where) {
  const double value = values[i];
  if (!(std::isfinite(value) && value >= 0.0))
    refuse(fmt::format("the pad's {} of cell {} axis {} is {}", name, i / 3, i % 3 + 1, value), where);
  return value;
}

}  // namespace

std::vector<Eigen::Vector3d> registered_points(const proto::SeatRegistration& seat) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + 2 < seat.points.size(); i += 3)
    points.emplace_back(seat.points[i], seat.points[i + 1], seat.points[i + 2]);
  return points;
}

std::vector<Eigen::Vector3d> cell_points(const proto::RailSeat& seat) {
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < seat.n_cells(); ++c) points.push_back(seat.cell_point(c));
  return points;
}

void check_interface(const std::string& side, const proto::Interface& registered,
                     const std::vector<proto::RailSeat>& seats) {
  expect_size(registered.seats.size(), seats.size(), "rail seats", "interface of " + side);
  for (std::size_t s = 0; s < seats.size(); ++s) {
    const auto& found = registered.seats[s];
    if (found.name != seats[s].name)
      refuse(fmt::format("seat {} was registered as '{}'", s, found.name), place(side, seats[s]));
    found.own_points ? check_own_points(side, found, seats[s]) : check_cells(side, found, seats[s]);
    const auto points = found.own_points ? registered_points(found) : cell_points(seats[s]);
    check_rigid_response(side, found, seats[s], points);
    check_force_resultants(side, found, seats[s], points);
  }
}

void check_taken_fields(const std::string& side, const proto::Interface& registered,
                        const std::vector<std::string>& names, const std::string& user) {
  for (const auto& name : names)
    if (find_field(registered, name, false) == registered.fields.end())
      throw proto::Error(proto::ExitCode::config,
                         fmt::format("{} does not take the field '{}' that {} needs", side, name, user),
                         "interface of " + side, "choose another scheme or participant; see proto/README.md, fields");
}

void check_outgoing_fields(const std::string& side, const proto::Interface& registered,
                           const std::vector<std::string>& names) {
  for (const auto& name : names) {
    const auto found = find_field(registered, name, true);
    if (found == registered.fields.end())
      refuse(fmt::format("the field '{}' is not among those the participant gives", name), "interface of " + side);
    if (found->components != 3)
      refuse(fmt::format("the field '{}' has {} components instead of 3", name, found->components),
             "interface of " + side);
  }
}

std::vector<proto::PadLaw> registered_pad(const std::string& side, const proto::Interface& registered,
                                          const std::vector<proto::RailSeat>& seats) {
  std::vector<proto::PadLaw> laws;
  for (std::size_t s = 0; s < seats.size(); ++s) {
    const auto& found = registered.seats[s];
    const std::size_t n = 3 * static_cast<std::size_t>(seats[s].n_cells());
    const auto where = place(side, seats[s]);
    expect_size(found.stiffness.size(), n, "pad stiffnesses", where);
    expect_size(found.damping.size(), n, "pad dampings", where);
    expect_size(found.preload.size(), n, "pad preloads", where);
    expect_size(found.tension_cutoff.size(), n, "pad cut-offs", where);
    for (std::size_t i = 0; i < n; ++i)
      laws.push_back({coefficient(found.stiffness, i, "stiffness", where),
                      coefficient(found.damping, i, "damping", where), coefficient(found.preload, i, "preload", where),
                      found.tension_cutoff[i]});
  }
  return laws;
}

}  // namespace coupler
