// The pads' cells on the sleeper: which particles a cell's displacement is read from.
#pragma once

#include <vector>

#include "proto/case/rail_seat.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Cells of all seats on the surface of `sleeper`, in order of seat, cell, for the positions of `state`.
///
/// A cell's value is the mean over 4 x 4 symmetric points of the cell. Each point is expressed linearly by the corners
/// of the tetrahedron under it, so that any affine motion, rigid ones above all, is reproduced at the cell's centre to
/// round-off, also where the sleeper's top lies some micrometres off the seat's plane.
/// Throws proto::Error (bad_data) naming seat and cell when a point is not over the sleeper's top, or when the top is
/// more than 2 mm off the seat's plane.
std::vector<PadCell> make_pad_cells(const Model& model, const State& state, int sleeper,
                                    const std::vector<proto::RailSeat>& seats);

}  // namespace qdem
