// Bodies of the kernels. Included by one file per instruction set, which defines
//   QDEM_KERNELS        name of the function that returns the table
//   QDEM_KERNEL_WIDTH   doubles in one vector register
#include "qdem_solver/engine/cpu/kernels.hpp"

namespace qdem::cpu {
namespace {

constexpr int width = QDEM_KERNEL_WIDTH;
constexpr int lanes = 8;

typedef double Vector __attribute__((vector_size(8 * QDEM_KERNEL_WIDTH)));
typedef double Loose __attribute__((vector_size(8 * QDEM_KERNEL_WIDTH), aligned(8), may_alias));

inline Vector load(const double* p) {
  return *reinterpret_cast<const Loose*>(p);
}
inline void add_to(double* p, Vector value) {
  *reinterpret_cast<Loose*>(p) += value;
}

/// What the loops over elements have to know of a force law.
struct Quadruples {
  using Force = QuadrupleForce<Vector>;
  static Force force(Vector scale, const ElementMaterial& material) {
    return {scale * scale, 1.0 / scale, material.quadruple};
  }
};
struct Bonds {
  using Force = BondForce<Vector>;
  static Force force(Vector scale, const ElementMaterial& material) { return {scale, material.bond}; }
};

/// One component of the sum of the forces on all particles but the first.
template <int others>
inline Vector sum_of(const Vector* force, int component) {
  Vector sum = force[component];
  for (int k = 1; k < others; ++k) sum += force[3 * k + component];
  return sum;
}

template <class Law>
void lane_forces(const LaneForces& job) {
  using Force = typename Law::Force;
  constexpr int others = Force::n_particles - 1;
  for (int lane = 0; lane < lanes; lane += width) {
    const Vector scale = load(job.scale + lane);
    const Force force = Law::force(scale, job.material);
    const double* x = job.x + lane;
    const double* v = job.v + lane;
    double* out = job.force + lane;
    for (int e = 0; e < job.elements.n_elements; ++e) {
      const int* particles = job.elements.particles + Force::n_particles * e;
      const int first = particles[0] * 3 * lanes;
      Vector dx[3 * others], dv[3 * others], f[3 * others];
      for (int c = 0; c < 3; ++c) {
        const Vector x0 = load(x + first + c * lanes), v0 = load(v + first + c * lanes);
        for (int k = 0; k < others; ++k) {
          const int other = particles[k + 1] * 3 * lanes + c * lanes;
          dx[3 * k + c] = load(x + other) - x0;
          dv[3 * k + c] = load(v + other) - v0;
        }
      }
      force(dx, dv, job.elements.shapes + Force::n_shape * e, job.elements.weights[e], f);
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < others; ++k) add_to(out + particles[k + 1] * 3 * lanes + c * lanes, f[3 * k + c]);
        add_to(out + first + c * lanes, -sum_of<others>(f, c));
      }
    }
  }
}

/// `count` <= width elements of one body, one a vector lane.
template <class Force>
inline void single_group(const SingleForces& job, const Force& force, int first, int count) {
  constexpr int n_particles = Force::n_particles, others = n_particles - 1, n_shape = Force::n_shape;
  alignas(64) double dx[3 * others][width], dv[3 * others][width], shape[n_shape][width], weight[width];
  alignas(64) double f[3 * others][width];
  for (int lane = 0; lane < width; ++lane) {
    const int e = first + (lane < count ? lane : 0);
    const int* particles = job.elements.particles + n_particles * e;
    const double *x0 = job.x + 3 * particles[0], *v0 = job.v + 3 * particles[0];
    for (int k = 0; k < others; ++k) {
      const double *xk = job.x + 3 * particles[k + 1], *vk = job.v + 3 * particles[k + 1];
      for (int c = 0; c < 3; ++c) dx[3 * k + c][lane] = xk[c] - x0[c], dv[3 * k + c][lane] = vk[c] - v0[c];
    }
    for (int i = 0; i < n_shape; ++i) shape[i][lane] = job.elements.shapes[n_shape * e + i];
    weight[lane] = job.elements.weights[e];
  }
  force(reinterpret_cast<const Vector*>(dx), reinterpret_cast<const Vector*>(dv),
        reinterpret_cast<const Vector*>(shape), load(weight), reinterpret_cast<Vector*>(f));
  for (int lane = 0; lane < count; ++lane) {
    double* slot = job.slots + 3 * n_particles * (first + lane);
    for (int c = 0; c < 3; ++c) {
      double sum = f[c][lane];
      for (int k = 1; k < others; ++k) sum += f[3 * k + c][lane];
      slot[c] = -sum;
      for (int k = 0; k < others; ++k) slot[3 * (k + 1) + c] = f[3 * k + c][lane];
    }
  }
}

template <class Law>
void single_forces(const SingleForces& job) {
  const auto force = Law::force(Vector{} + job.scale, job.material);
  for (int e = job.first; e < job.last; e += width) {
    single_group(job, force, e, job.last - e < width ? job.last - e : width);
  }
}

#include "qdem_solver/engine/cpu/dissipation_body.hpp"

inline double drift_value(const Drift& job, std::int64_t i) {
  const double move = job.dt * (job.v[i] + 0.5 * job.dt * job.a[i]);
  job.x[i] += move;
  job.v[i] += job.dt * job.a[i];
  return move < 0 ? -move : move;
}

DriftResult drift(const Drift& job) {
  DriftResult result{};
  if (job.lanes == 1) {
    double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
    for (int i = 0; i < job.n; ++i) {
      const double size = drift_value(job, i);
      largest = size > largest ? size : largest;
      sum += size;
    }
    result.largest_move[0] = largest, result.sum = sum;
    return result;
  }
  double sums[lanes] = {};
  for (int row = 0; row < job.n; ++row) {
#pragma omp simd
    for (int l = 0; l < lanes; ++l) {
      const double size = drift_value(job, std::int64_t{row} * lanes + l);
      result.largest_move[l] = size > result.largest_move[l] ? size : result.largest_move[l];
      sums[l] += size;
    }
  }
  for (int l = 0; l < lanes; ++l) result.sum += sums[l];
  return result;
}

/// One component of one node over its lanes.
inline void kick_values(const Kick& job, int n, double gravity, const double* force, const double* inverse_mass,
                        double* v, double* a) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    double accel = inverse_mass[i] > 0 ? force[i] * inverse_mass[i] + gravity : 0.0;
    const double size = accel < 0 ? -accel : accel;
    const double sign = v[i] > 0 ? 1.0 : (v[i] < 0 ? -1.0 : 0.0);
    accel -= job.local_damping * size * sign + job.drag * v[i];
    v[i] += 0.5 * job.dt * (accel - a[i]);
    a[i] = accel;
  }
}

void kick(const Kick& job) {
  for (int node = 0; node < job.n_nodes; ++node) {
    for (int c = 0; c < 3; ++c) {
      const std::int64_t at = std::int64_t{3 * node + c} * job.lanes;
      // A constant count lets the compiler unroll the common case.
      if (job.lanes == lanes) {
        kick_values(job, lanes, job.gravity[c], job.force + at, job.inverse_mass + at, job.v + at, job.a + at);
      } else {
        kick_values(job, job.lanes, job.gravity[c], job.force + at, job.inverse_mass + at, job.v + at, job.a + at);
      }
    }
  }
}

void gather(const Gather& job) {
  for (int node = job.first; node < job.last; ++node) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = job.adjacency_offsets[node]; i < job.adjacency_offsets[node + 1]; ++i) {
      const double* slot = job.slots + 3 * job.adjacency_slots[i];
      for (int c = 0; c < 3; ++c) sum[c] += slot[c];
    }
    for (int c = 0; c < 3; ++c) job.force[3 * node + c] += sum[c];
  }
}

/// Values of up to eight bodies side by side.
struct Row {
  double at[lanes] = {};
};

/// Rigid fit of the motion of up to eight bodies: their centres, linear and angular velocity and acceleration.
struct RigidFit {
  Row centre[3], velocity[3], spin[3], linear[3], angular[3];
};

/// Solves the symmetric 3 x 3 system of every lane, entries xx, xy, xz, yy, yz, zz. Cramer's rule.
inline void solve_symmetric(const Row m[6], const Row right[3], int n, Row out[3]) {
#pragma omp simd
  for (int l = 0; l < n; ++l) {
    const double xx = m[0].at[l], xy = m[1].at[l], xz = m[2].at[l], yy = m[3].at[l], yz = m[4].at[l], zz = m[5].at[l];
    const double c0 = yy * zz - yz * yz, c1 = xz * yz - xy * zz, c2 = xy * yz - xz * yy;
    const double d0 = xx * zz - xz * xz, d1 = xy * xz - xx * yz, e0 = xx * yy - xy * xy;
    const double scale = 1 / (xx * c0 + xy * c1 + xz * c2);
    const double r0 = right[0].at[l], r1 = right[1].at[l], r2 = right[2].at[l];
    out[0].at[l] = scale * (c0 * r0 + c1 * r1 + c2 * r2);
    out[1].at[l] = scale * (c1 * r0 + d0 * r1 + d1 * r2);
    out[2].at[l] = scale * (c2 * r0 + d1 * r1 + e0 * r2);
  }
}

/// Takes the held rotations out of the system.
inline void hold_rotations(const double* free, int n, Row inertia[6], Row momentum[3], Row torque[3]) {
  constexpr int axes[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
  for (int e = 0; e < 6; ++e) {
    const double *row = free + axes[e][0] * n, *column = free + axes[e][1] * n;
    for (int l = 0; l < n; ++l) {
      inertia[e].at[l] *= row[l] * column[l];
      if (axes[e][0] == axes[e][1]) inertia[e].at[l] += 1 - row[l];
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (int l = 0; l < n; ++l) momentum[c].at[l] *= free[c * n + l], torque[c].at[l] *= free[c * n + l];
  }
}

/// Sums of r x w over the particles, added to one row.
inline void add_moment(const double r[3], const double w[3], Row sum[3], int l) {
  sum[0].at[l] += r[1] * w[2] - r[2] * w[1];
  sum[1].at[l] += r[2] * w[0] - r[0] * w[2];
  sum[2].at[l] += r[0] * w[1] - r[1] * w[0];
}

inline void fit_translation(const ScaleInertia& job, int n, RigidFit& fit) {
  double volume = 0.0;
  for (int node = 0; node < job.n_nodes; ++node) {
    const double share = job.volumes[node];
    volume += share;
    for (int c = 0; c < 3; ++c) {
      const int at = (3 * node + c) * n;
#pragma omp simd
      for (int l = 0; l < n; ++l) {
        fit.centre[c].at[l] += share * job.x[at + l];
        fit.velocity[c].at[l] += share * job.v[at + l];
        fit.linear[c].at[l] += job.force[at + l];
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (int l = 0; l < n; ++l) {
      const double free = job.free[c * n + l];
      fit.centre[c].at[l] /= volume;
      fit.velocity[c].at[l] *= free / volume;
      fit.linear[c].at[l] = free * (fit.linear[c].at[l] / (job.mass_factor[l] * volume) + job.gravity[c]);
    }
  }
}

inline void fit_rotation(const ScaleInertia& job, int n, RigidFit& fit) {
  Row inertia[6], momentum[3], torque[3];
  for (int node = 0; node < job.n_nodes; ++node) {
    const int at = 3 * node * n;
#pragma omp simd
    for (int l = 0; l < n; ++l) {
      const double m = job.mass_factor[l] * job.volumes[node];
      double r[3], p[3], f[3];
      for (int c = 0; c < 3; ++c) {
        r[c] = job.x[at + c * n + l] - fit.centre[c].at[l];
        p[c] = m * job.v[at + c * n + l];
        f[c] = job.force[at + c * n + l];
      }
      inertia[0].at[l] += m * (r[1] * r[1] + r[2] * r[2]), inertia[1].at[l] -= m * r[0] * r[1];
      inertia[2].at[l] -= m * r[0] * r[2], inertia[3].at[l] += m * (r[0] * r[0] + r[2] * r[2]);
      inertia[4].at[l] -= m * r[1] * r[2], inertia[5].at[l] += m * (r[0] * r[0] + r[1] * r[1]);
      add_moment(r, p, momentum, l);
      add_moment(r, f, torque, l);
    }
  }
  hold_rotations(job.free + 3 * n, n, inertia, momentum, torque);
  solve_symmetric(inertia, momentum, n, fit.spin);
  solve_symmetric(inertia, torque, n, fit.angular);
}

/// Cundall's damping of one component.
inline double damped(double acceleration, double velocity, double share) {
  const double size = acceleration < 0 ? -acceleration : acceleration;
  const double sign = velocity > 0 ? 1.0 : (velocity < 0 ? -1.0 : 0.0);
  return acceleration - share * size * sign;
}

void scale_inertia(const ScaleInertia& job) {
  const int n = job.lanes;
  RigidFit fit;
  fit_translation(job, n, fit);
  fit_rotation(job, n, fit);
  Row linear[3], angular[3];
  for (int c = 0; c < 3; ++c) {
    for (int l = 0; l < n; ++l) {
      linear[c].at[l] = job.rigid[l] * damped(fit.linear[c].at[l], fit.velocity[c].at[l], job.local_damping);
      angular[c].at[l] = job.rigid[l] * damped(fit.angular[c].at[l], fit.spin[c].at[l], job.local_damping);
    }
  }
  for (int node = 0; node < job.n_nodes; ++node) {
    const int at = 3 * node * n;
#pragma omp simd
    for (int l = 0; l < n; ++l) {
      const double m = job.mass_factor[l] * job.volumes[node];
      double r[3];
      for (int c = 0; c < 3; ++c) r[c] = job.x[at + c * n + l] - fit.centre[c].at[l];
      for (int c = 0; c < 3; ++c) {
        const int i = (c + 1) % 3, k = (c + 2) % 3, here = at + c * n + l;
        const double whole = job.force[here] / m + job.gravity[c];
        const double stiff = fit.linear[c].at[l] + fit.angular[i].at[l] * r[k] - fit.angular[k].at[l] * r[i];
        const double drift = fit.velocity[c].at[l] + fit.spin[i].at[l] * r[k] - fit.spin[k].at[l] * r[i];
        const double moved = linear[c].at[l] + angular[i].at[l] * r[k] - angular[k].at[l] * r[i];
        const double bent = job.deformation[l] * (whole - stiff) - job.deformation_drag * (job.v[here] - drift);
        job.force[here] = m * (moved + bent - job.gravity[c]);
      }
    }
  }
}

}  // namespace

const Kernels& QDEM_KERNELS() {
  static const Kernels table{
      QDEM_INSTRUCTION_SET,
      {lane_forces<Quadruples>, single_forces<Quadruples>, lane_power<QuadruplePower>, single_power<QuadruplePower>},
      {lane_forces<Bonds>, single_forces<Bonds>, lane_power<BondPower>, single_power<BondPower>},
      drift,
      kick,
      gather,
      scale_inertia};
  return table;
}

}  // namespace qdem::cpu
