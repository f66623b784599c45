// First half of a step: positions and predicted velocities, and how far every body went.
#pragma once

#include "qdem_solver/engine/device/records.hpp"

namespace qdem::device {

/// x += dt (v + dt/2 a), v += dt a for the particles of a chunk in one lane. Items: ModelView::chunk_blocks.
/// Reads a; writes x, v and, per chunk and lane, the largest |move| of one value [m], infinite when one is not finite.
struct Drift {
  ModelView model;
  MotionView motion;
  Pointer<const Clock> clock;
  double dt;
  Pointer<double> moves;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    if (waits(at, clock)) return;
    const Place place = place_of(at, model, model.chunk_blocks, item, &BatchRecord::n_chunks);
    if (place.batch == nullptr) return;
    const BatchRecord& batch = *place.batch;
    const int first = place.number * chunk_size;
    const int last = first + chunk_size < batch.n_nodes ? first + chunk_size : batch.n_nodes;
    double largest = 0.0;
    for (int value = 3 * first; value < 3 * last; ++value) {
      const std::int64_t i = batch.values_at + std::int64_t{value} * batch.lanes + place.lane;
      const double v = at(motion.v)[i], a = at(motion.a)[i];
      const double move = dt * (v + 0.5 * dt * a);
      at(motion.x)[i] += move;
      at(motion.v)[i] = v + dt * a;
      const double size = move < 0 ? -move : move;
      if (!(size <= largest)) largest = size <= 1e300 ? size : INFINITY;
    }
    at(moves)[batch.chunks_at + std::int64_t{place.number} * batch.lanes + place.lane] = largest;
  }
};

/// Adds the last drift to the travel of every body and plane, and stops the steps when the candidate list is used up or
/// a body's motion is not finite. Items: bodies, then planes. Reads the chunks' moves; writes travel [body] and the
/// clock's flags, always the same value whoever comes first.
struct Travel {
  ModelView model;
  Pointer<const double> moves;
  Pointer<const PlaneRecord> planes;
  Pointer<Clock> clock;
  Pointer<double> travel;
  StepFrame frame;
  double rebuild_time, half_skin;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    Clock& now = *at(clock);
    if (now.halted != 0) return;
    const double moved = item < model.n_bodies ? body_travel(at, static_cast<int>(item))
                                               : plane_travel(at, static_cast<int>(item) - model.n_bodies);
    if (!(moved <= 1e300)) now.blown = 1;
    if (moved > half_skin) now.stale = 1;
  }

 private:
  HOUSE_HOST_DEVICE double body_travel(const Access& at, int number) const {
    const BodyRecord& body = at(model.bodies)[number];
    const BatchRecord& batch = at(model.batches)[body.batch];
    double largest = 0.0;
    for (int chunk = 0; chunk < batch.n_chunks; ++chunk) {
      const double move = at(moves)[batch.chunks_at + std::int64_t{chunk} * batch.lanes + body.lane];
      if (!(move <= largest)) largest = move;
    }
    return at(travel)[number] += std::sqrt(3.0) * largest;  // sqrt(3): of a value to that of a node
  }

  HOUSE_HOST_DEVICE double plane_travel(const Access& at, int number) const {
    const PlaneNow plane(at(planes)[number]);
    return plane.velocity.norm() * std::abs(frame.time(at(clock)->done + 1) - rebuild_time);
  }
};

/// End of a step. One item.
struct FinishStep {
  Pointer<Clock> clock;
  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t) const {
    Clock& now = *at(clock);
    if (now.stale != 0 || now.blown != 0) {
      now.halted = 1;
    } else {
      ++now.done;
    }
  }
};

}  // namespace qdem::device
