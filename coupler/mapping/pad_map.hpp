// Between the points that the rail's side registered and the pad's cells, for all seats of a case.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/rail_seat.hpp"
#include "proto/wire/messages.hpp"

namespace coupler {

/// Vectors of points and of cells run over seats, points or cells, and seat axes.
class PadMap {
 public:
  /// Motion of the cells [m], [m/s] from that of the points. Throws proto::Error (protocol) for a wrong length.
  std::vector<double> to_cells(const std::vector<double>& motion) const;
  /// Forces at the points [N] from those at the cells: same sums of force and moment, same work.
  std::vector<double> to_points(const std::vector<double>& force) const;
  /// As Configure takes it.
  std::vector<double> pad_map() const;
  /// One line a seat: points, cells, and what does not come over.
  const std::vector<std::string>& notes() const { return notes_; }
  bool carries_all_rigid_motions() const { return carries_all_; }

 private:
  friend std::optional<PadMap> map_to_pad(const std::string&, const proto::Interface&,
                                          const std::vector<proto::RailSeat>&);
  std::vector<Eigen::MatrixXd> seats_;  ///< [3 cells][3 points] each
  std::vector<std::string> notes_;
  bool carries_all_ = true;
};

/// The operator of every seat (map_patch(); the identity where the cells were registered); none when no seat has points
/// of the participant's own. `registered` has passed check_interface(). Throws as map_patch(), naming `side` and seat.
std::optional<PadMap> map_to_pad(const std::string& side, const proto::Interface& registered,
                                 const std::vector<proto::RailSeat>& seats);

}  // namespace coupler
