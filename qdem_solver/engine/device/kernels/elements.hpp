// Forces of the elements, each into slots of its own.
#pragma once

#include "qdem_solver/engine/device/records.hpp"

namespace qdem::device {

/// What the kernel has to know of a force law.
struct QuadrupleLaw {
  using Force = QuadrupleForce<double>;
  HOUSE_HOST_DEVICE static Force force(double scale, const cpu::ElementMaterial& material) {
    return {scale * scale, 1.0 / scale, material.quadruple};
  }
};
struct BondLaw {
  using Force = BondForce<double>;
  HOUSE_HOST_DEVICE static Force force(double scale, const cpu::ElementMaterial& material) {
    return {scale, material.bond};
  }
};

/// One element of one lane. Items: the law's blocks. Reads x, v; writes the element's slots [corner][component] [N].
template <class Law>
struct ElementForces {
  ModelView model;
  Pointer<const WorkBlock> blocks;
  Pointer<const double> x, v;
  Pointer<const Clock> clock;
  Pointer<double> slots;

  HOUSE_HOST_DEVICE void operator()(const Access& at, std::int64_t item) const {
    using Force = typename Law::Force;
    constexpr int n_particles = Force::n_particles, others = n_particles - 1;
    if (waits(at, clock)) return;
    const Place place = place_of(at, model, blocks, item, &BatchRecord::n_elements);
    if (place.batch == nullptr) return;
    const BatchRecord& batch = *place.batch;
    const int lanes = batch.lanes;
    const int* particles = at(model.particles) + batch.particles_at + n_particles * place.number;
    const double *px = at(x) + batch.values_at + place.lane, *pv = at(v) + batch.values_at + place.lane;
    double dx[3 * others], dv[3 * others], f[3 * others];
    for (int c = 0; c < 3; ++c) {
      const std::int64_t first = (std::int64_t{3} * particles[0] + c) * lanes;
      const double x0 = px[first], v0 = pv[first];
      for (int k = 0; k < others; ++k) {
        const std::int64_t other = (std::int64_t{3} * particles[k + 1] + c) * lanes;
        dx[3 * k + c] = px[other] - x0;
        dv[3 * k + c] = pv[other] - v0;
      }
    }
    double shape[Force::n_shape];
    for (int i = 0; i < Force::n_shape; ++i) {
      shape[i] = at(model.shapes)[batch.shapes_at + std::int64_t{Force::n_shape} * place.number + i];
    }
    const double weight = at(model.weights)[batch.weights_at + place.number];
    Law::force(batch.scale[place.lane], batch.material)(dx, dv, shape, weight, f);
    double* slot = at(slots) + batch.slots_at + std::int64_t{3} * n_particles * place.number * lanes + place.lane;
    for (int c = 0; c < 3; ++c) {
      double sum = f[c];
      for (int k = 1; k < others; ++k) sum += f[3 * k + c];
      slot[c * lanes] = -sum;
      for (int k = 0; k < others; ++k) slot[(3 * (k + 1) + c) * lanes] = f[3 * k + c];
    }
  }
};

}  // namespace qdem::device
