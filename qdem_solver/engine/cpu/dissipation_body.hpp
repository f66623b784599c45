// Loops that add up what the elements dissipate. Part of kernels_body.hpp, inside its namespaces; compiled once per
// instruction set with it. They run once in many steps: see EngineOptions::steps_per_viscous_sample.

/// Which functor goes with a force law.
struct QuadruplePower {
  using Power = QuadrupleDissipation<Vector>;
  static Power power(Vector scale, const ElementMaterial& material) { return {1.0 / scale, material.quadruple}; }
};
struct BondPower {
  using Power = BondDissipation<Vector>;
  static Power power(Vector scale, const ElementMaterial& material) { return {scale, material.bond}; }
};

template <class Law>
void lane_power(const LaneForces& job, double* sums) {
  using Power = typename Law::Power;
  constexpr int others = Power::n_particles - 1;
  for (int lane = 0; lane < lanes; lane += width) {
    const Power power = Law::power(load(job.scale + lane), job.material);
    Vector sum{};
    for (int e = 0; e < job.elements.n_elements; ++e) {
      const int* particles = job.elements.particles + Power::n_particles * e;
      const int first = particles[0] * 3 * lanes + lane;
      Vector dx[3 * others], dv[3 * others];
      for (int k = 0; k < others; ++k) {
        const int other = particles[k + 1] * 3 * lanes + lane;
        for (int c = 0; c < 3; ++c) {
          dx[3 * k + c] = load(job.x + other + c * lanes) - load(job.x + first + c * lanes);
          dv[3 * k + c] = load(job.v + other + c * lanes) - load(job.v + first + c * lanes);
        }
      }
      sum += power(dx, dv, job.elements.shapes + Power::n_shape * e, job.elements.weights[e]);
    }
    for (int l = 0; l < width; ++l) sums[lane + l] = sum[l];
  }
}

template <class Law>
double block_power(const BlockForces& job) {
  using Power = typename Law::Power;
  const Power power = Law::power(Vector{} + job.scale, job.material);
  Vector sum{};
  for_each_group<Power>(job, [&](const Vector* dx, const Vector* dv, const Vector* shape, Vector weight,
                                 const std::uint16_t*) { sum += power(dx, dv, shape, weight); });
  double total = 0.0;
  for (int l = 0; l < width; ++l) total += sum[l];
  return total;
}
