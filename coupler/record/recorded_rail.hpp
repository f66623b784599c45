// The rail of another run as one side of this one.
#pragma once

#include <string>
#include <vector>

#include "coupler/scheme/scheme_state.hpp"
#include "coupler/scheme/side.hpp"
#include "proto/case/rail_seat.hpp"

namespace coupler {

/// Plays the rail's motion and force_used from a coupling.h5: in the march by its time, linear between its rows; in the
/// initialise phase it stands at its initial values.
class RecordedRail : public Side {
 public:
  /// Reads seats `seats` of `path`; `duration_s`: as long as will be asked for.
  /// Throws proto::Error: missing_input, bad_data (not such a file, other seats or cells, too short).
  RecordedRail(const std::string& path, const std::vector<proto::RailSeat>& seats, double duration_s);

  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override {}
  void commit(const proto::Commit&) override {}

  std::vector<double> initial_displacement() const { return displacement_.front(); }
  std::vector<double> initial_velocity() const { return velocity_.front(); }

 private:
  using Rows = std::vector<std::vector<double>>;  ///< [row][value], all seats
  std::vector<double> at(const Rows& rows, double time) const;

  std::vector<double> time_;
  Rows displacement_, velocity_, force_;
};

}  // namespace coupler
