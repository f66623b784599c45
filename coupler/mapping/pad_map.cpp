#include "coupler/mapping/pad_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coupler/mapping/interface_check.hpp"
#include "coupler/mapping/patch_map.hpp"
#include "proto/error.hpp"

namespace coupler {
namespace {

using Vector = Eigen::VectorXd;

/// In seat axes, from the seat's origin.
Points in_seat_axes(const Points& points, const proto::RailSeat& seat) {
  Points result;
  for (const auto& point : points) result.emplace_back(seat.axes.transpose() * (point - seat.origin));
  return result;
}

PatchMap map_seat(const std::string& side, const Points& points, const proto::RailSeat& seat) {
  try {
    return map_patch(in_seat_axes(points, seat), in_seat_axes(cell_points(seat), seat));
  } catch (const proto::Error& error) {
    throw proto::Error(error.code(), error.what(), fmt::format("interface of {}, seat '{}'", side, seat.name));
  }
}

/// The blocks applied one after the other, or their transposes.
std::vector<double> apply(const std::vector<Eigen::MatrixXd>& blocks, const std::vector<double>& values,
                          bool transposed) {
  Eigen::Index n_in = 0, n_out = 0;
  for (const auto& block : blocks) n_in += transposed ? block.rows() : block.cols();
  if (n_in != static_cast<Eigen::Index>(values.size()))
    throw proto::Error(proto::ExitCode::protocol,
                       fmt::format("{} values came to be mapped instead of {}", values.size(), n_in));
  const Eigen::Map<const Vector> in(values.data(), n_in);
  std::vector<double> result;
  n_in = 0;
  for (const auto& block : blocks) {
    n_out = transposed ? block.cols() : block.rows();
    const Eigen::Index n = transposed ? block.rows() : block.cols();
    const Vector part =
        transposed ? Vector(block.transpose() * in.segment(n_in, n)) : Vector(block * in.segment(n_in, n));
    result.insert(result.end(), part.data(), part.data() + n_out);
    n_in += n;
  }
  return result;
}

}  // namespace

std::vector<double> PadMap::to_cells(const std::vector<double>& motion) const {
  return apply(seats_, motion, false);
}

std::vector<double> PadMap::to_points(const std::vector<double>& force) const {
  return apply(seats_, force, true);
}

std::vector<double> PadMap::pad_map() const {
  std::vector<double> result;
  for (const auto& seat : seats_)
    for (Eigen::Index row = 0; row < seat.rows(); ++row)
      for (Eigen::Index column = 0; column < seat.cols(); ++column) result.push_back(seat(row, column));
  return result;
}

std::optional<PadMap> map_to_pad(const std::string& side, const proto::Interface& registered,
                                 const std::vector<proto::RailSeat>& seats) {
  const bool any =
      std::any_of(registered.seats.begin(), registered.seats.end(), [](const auto& seat) { return seat.own_points; });
  if (!any) return std::nullopt;
  PadMap result;
  for (std::size_t s = 0; s < seats.size(); ++s) {
    const auto& found = registered.seats[s];
    if (!found.own_points) {
      result.seats_.push_back(Eigen::MatrixXd::Identity(3 * seats[s].n_cells(), 3 * seats[s].n_cells()));
      continue;
    }
    auto map = map_seat(side, registered_points(found), seats[s]);
    result.notes_.push_back(fmt::format("seat '{}': {} points of {} are mapped to {} cells{}", seats[s].name,
                                        found.points.size() / 3, side, seats[s].n_cells(),
                                        map.n_rigid_motions == 6
                                            ? ""
                                            : fmt::format(", of which {} of six rigid motions come over; moments about "
                                                          "the others are lost",
                                                          map.n_rigid_motions)));
    result.carries_all_ = result.carries_all_ && map.n_rigid_motions == 6;
    result.seats_.push_back(std::move(map.matrix));
  }
  return result;
}

}  // namespace coupler
