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

/// Lanes of the last group that have no element of their own repeat its first, with weight 0.
template <class Law>
double single_power(const SingleForces& job) {
  using Power = typename Law::Power;
  constexpr int n_particles = Power::n_particles, others = n_particles - 1, n_shape = Power::n_shape;
  const Power power = Law::power(Vector{} + job.scale, job.material);
  Vector sum{};
  for (int begin = job.first; begin < job.last; begin += width) {
    alignas(64) double dx[3 * others][width], dv[3 * others][width], shape[n_shape][width], weight[width];
    for (int lane = 0; lane < width; ++lane) {
      const bool own = begin + lane < job.last;
      const int e = own ? begin + lane : begin;
      const int* particles = job.elements.particles + n_particles * e;
      for (int k = 0; k < others; ++k) {
        for (int c = 0; c < 3; ++c) {
          const int first = 3 * particles[0] + c, other = 3 * particles[k + 1] + c;
          dx[3 * k + c][lane] = job.x[other] - job.x[first], dv[3 * k + c][lane] = job.v[other] - job.v[first];
        }
      }
      for (int i = 0; i < n_shape; ++i) shape[i][lane] = job.elements.shapes[n_shape * e + i];
      weight[lane] = own ? job.elements.weights[e] : 0.0;
    }
    sum += power(reinterpret_cast<const Vector*>(dx), reinterpret_cast<const Vector*>(dv),
                 reinterpret_cast<const Vector*>(shape), load(weight));
  }
  double total = 0.0;
  for (int l = 0; l < width; ++l) total += sum[l];
  return total;
}
