#include "qdem_solver/participant/seat_registration.hpp"

#include <Eigen/Geometry>

#include "qdem_solver/engine/pads.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;

/// One seat's part of the operator; its values begin at `first`.
class SeatMeasure {
 public:
  SeatMeasure(const Model& model, const State& state, const proto::RailSeat& seat, std::size_t first)
      : model_(model), state_(state), seat_(seat), op_(model), first_(first), n_(3 * seat.n_cells()) {}

  proto::SeatRegistration registration() const {
    proto::SeatRegistration result;
    result.name = seat_.name;
    result.weights.assign(seat_.n_cells(), seat_.cell_weight());
    const auto local = response([](const Vector3d& arm) { return arm; });
    for (int cell = 0; cell < seat_.n_cells(); ++cell) {
      const Vector3d point =
          seat_.origin + seat_.axes * Vector3d(local[3 * cell], local[3 * cell + 1], local[3 * cell + 2]);
      result.points.insert(result.points.end(), point.data(), point.data() + 3);
    }
    for (int motion = 0; motion < 6; ++motion) {
      const Vector3d axis = Vector3d::Unit(motion % 3);
      const auto values = response([&](const Vector3d& arm) { return motion < 3 ? axis : Vector3d(axis.cross(arm)); });
      result.rigid_response.insert(result.rigid_response.end(), values.begin(), values.end());
    }
    for (std::size_t value = 0; value < n_; ++value) add_resultants(value, result.force_resultants);
    for (std::size_t value = 0; value < n_; ++value) {
      const proto::PadLaw& law = model_.pads[(first_ + value) / 3].laws[value % 3];
      result.stiffness.push_back(law.stiffness), result.damping.push_back(law.damping);
      result.preload.push_back(law.preload), result.tension_cutoff.push_back(law.tension_cutoff);
    }
    return result;
  }

 private:
  template <class Motion>
  std::vector<double> response(Motion motion) const {
    std::vector<double> motions(model_.n_values, 0.0), values(op_.n_values());
    for (int node = 0; node < model_.shape(model_.pad_body).n_nodes(); ++node) {
      const Vector3d arm = state_.position(model_, model_.pad_body, node) - seat_.origin;
      State::scatter(model_, motions, model_.pad_body, node, motion(arm));
    }
    op_.apply(motions, values);
    return {values.begin() + first_, values.begin() + first_ + n_};
  }

  void add_resultants(std::size_t value, std::vector<double>& resultants) const {
    std::vector<double> unit(op_.n_values(), 0.0), force(model_.n_values, 0.0);
    unit[first_ + value] = 1.0;
    op_.add_transposed(unit, force);
    Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
    for (int node = 0; node < model_.shape(model_.pad_body).n_nodes(); ++node) {
      const Vector3d f = State::gather(model_, force, model_.pad_body, node);
      sum += f, moment += (state_.position(model_, model_.pad_body, node) - seat_.origin).cross(f);
    }
    resultants.insert(resultants.end(), sum.data(), sum.data() + 3);
    resultants.insert(resultants.end(), moment.data(), moment.data() + 3);
  }

  const Model& model_;
  const State& state_;
  const proto::RailSeat& seat_;
  PadOperator op_;
  std::size_t first_, n_;
};

}  // namespace

std::vector<proto::SeatRegistration> register_seats(const Model& model, const State& state,
                                                    const std::vector<proto::RailSeat>& seats) {
  std::vector<proto::SeatRegistration> result;
  std::size_t first = 0;
  for (const proto::RailSeat& seat : seats) {
    result.push_back(SeatMeasure(model, state, seat, first).registration());
    first += 3 * seat.n_cells();
  }
  return result;
}

}  // namespace qdem
