// Checks what a participant registered against the interface that the case defines.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "proto/case/rail_seat.hpp"
#include "proto/pad/pad_law.hpp"
#include "proto/wire/messages.hpp"

namespace coupler {

/// Both participants must have registered exactly the case's seats and cells (names and order, points to 1e-9 m,
/// weights to 1e-12), or, who does not own the pad, points of its own (at most 256 a seat, within two half-diagonals of
/// its origin); an operator that returns the six rigid motions of a seat's points; and a transpose that keeps the sums
/// of force and of moment about the seat's origin. Motions and sums are compared at 1e-12, rotations and moments
/// relative to the seat's half-diagonal.
///
/// Throws proto::Error (protocol) naming side, seat, cell, what was found and what was wanted.
void check_interface(const std::string& side, const proto::Interface& registered,
                     const std::vector<proto::RailSeat>& seats);

/// Points of a seat as registered [m], global frame.
std::vector<Eigen::Vector3d> registered_points(const proto::SeatRegistration& seat);

/// Points of a seat's cells [m], global frame.
std::vector<Eigen::Vector3d> cell_points(const proto::RailSeat& seat);

/// Throws proto::Error (protocol) unless `registered` gives (outgoing) every field of `names` with three components.
void check_outgoing_fields(const std::string& side, const proto::Interface& registered,
                           const std::vector<std::string>& names);

/// Throws proto::Error (config) unless `registered` takes (not outgoing) every field of `names`, which `user` needs.
void check_taken_fields(const std::string& side, const proto::Interface& registered,
                        const std::vector<std::string>& names, const std::string& user);

/// The pad law of every interface value as the pad's owner registered it.
/// Throws proto::Error (protocol) for a missing, negative or non-finite coefficient.
std::vector<proto::PadLaw> registered_pad(const std::string& side, const proto::Interface& registered,
                                          const std::vector<proto::RailSeat>& seats);

}  // namespace coupler
