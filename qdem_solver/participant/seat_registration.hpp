// What the QDEM side tells the coupler about its pad operator.
#pragma once

#include <vector>

#include "proto/case/rail_seat.hpp"
#include "proto/wire/messages.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Registration of every seat, measured on the operator the engine uses: cell points, response to the six rigid motions
/// about each seat's origin, resultants of unit cell forces; and the pads' laws, which this side owns.
std::vector<proto::SeatRegistration> register_seats(const Model& model, const State& state,
                                                    const std::vector<proto::RailSeat>& seats);

}  // namespace qdem
