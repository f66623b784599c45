#include "coupler/scheme/staggered.hpp"

namespace coupler {

void StaggeredScheme::solve(WindowRecord& record, Sides sides) {
  if (kind_ == Kind::parallel && record.phase == proto::Phase::march && state_.rail_known) {
    solve_in_parallel(record, sides);
    return;
  }
  auto force = kind_ == Kind::extrapolated ? extrapolated_force(state_) : state_.force_mean;
  solve_rail(record, force_request(record, 0, std::move(force)), sides.implicit_side);
  solve_sleeper(record, path_request(record, 0), sides.explicit_side);
}

void StaggeredScheme::solve_in_parallel(WindowRecord& record, Sides sides) {
  record.rail_displacement_begin = state_.interface.rail_displacement;
  record.rail_displacement = state_.interface.rail_displacement;
  record.rail_velocity = state_.interface.rail_velocity;
  for (std::size_t i = 0; i < n_values(); ++i) record.rail_displacement[i] += window_s() * record.rail_velocity[i];
  sides.implicit_side.begin(force_request(record, 0, state_.force_mean));
  sides.explicit_side.begin(path_request(record, 0));
  take_rail(record, sides.implicit_side.end());
  record.force_robin = record.force_used;
  take_sleeper(record, sides.explicit_side.end());
}

}  // namespace coupler
