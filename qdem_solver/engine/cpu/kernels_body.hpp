// Bodies of the kernels. Included by one file per instruction set, which defines
//   QDEM_KERNELS        name of the function that returns the table
//   QDEM_KERNEL_WIDTH   doubles in one vector register
#if QDEM_KERNEL_WIDTH > 2
#include <immintrin.h>
#endif

#include <utility>

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
inline void store(double* p, Vector value) {
  *reinterpret_cast<Loose*>(p) = value;
}
inline void add_to(double* p, Vector value) {
  *reinterpret_cast<Loose*>(p) += value;
}

#include "qdem_solver/engine/cpu/lane_exchange.hpp"

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
__attribute__((flatten)) void lane_forces(const LaneForces& job) {
  using Force = typename Law::Force;
  constexpr int n_particles = Force::n_particles, others = n_particles - 1;
  for (int lane = 0; lane < lanes; lane += width) {
    const Force force = Law::force(load(job.scale + lane), job.material);
    const double* __restrict x = job.x + lane;
    const double* __restrict v = job.v + lane;
    double* __restrict out = job.force + lane;
    const int* particles = job.elements.particles;
    const double* shape = job.elements.shapes;
    const int n = job.elements.n_elements;
    for (int e = 0; e < n; ++e, particles += n_particles, shape += Force::n_shape) {
      std::int64_t at[n_particles];
      for (int k = 0; k < n_particles; ++k) at[k] = std::int64_t{particles[k]} * (3 * lanes);
      Vector dx[3 * others], dv[3 * others], f[3 * others];
      for (int c = 0; c < 3; ++c) {
        const Vector x0 = load(x + at[0] + c * lanes), v0 = load(v + at[0] + c * lanes);
        for (int k = 0; k < others; ++k) {
          dx[3 * k + c] = load(x + at[k + 1] + c * lanes) - x0;
          dv[3 * k + c] = load(v + at[k + 1] + c * lanes) - v0;
        }
      }
      force(dx, dv, shape, job.elements.weights[e], f);
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < others; ++k) add_to(out + at[k + 1] + c * lanes, f[3 * k + c]);
        add_to(out + at[0] + c * lanes, -sum_of<others>(f, c));
      }
    }
  }
}

/// Positions and velocities of a block's particles as records {x y z vx vy vz - -}.
inline void read_records(const BlockForces& job) {
  for (int copy = 0; copy < job.n_copies; ++copy) {
    const double *x = job.x + std::int64_t{3} * job.copies[copy], *v = job.v + std::int64_t{3} * job.copies[copy];
    double* record = job.records + std::int64_t{8} * copy;
    *reinterpret_cast<Pair*>(record) = load_pair(x);
    *reinterpret_cast<Pair*>(record + 2) = Pair{x[2], v[0]};
    *reinterpret_cast<Pair*>(record + 4) = load_pair(v + 1);
  }
}

/// Element numbers come from memory: asked for so many groups before they are needed.
constexpr int groups_ahead = 6;

/// Calls `visit` with dx, dv, shape, weight and corners of so many elements of a block at a time as a vector has lanes.
template <class Force, class Visit>
inline void for_each_group(const BlockForces& job, Visit visit) {
  constexpr int n_particles = Force::n_particles, others = n_particles - 1, n_shape = Force::n_shape;
  read_records(job);
  const double* __restrict records = job.records;
  const std::uint16_t* corners = job.corners;
  const double* numbers = job.numbers;
  for (int group = 0; group < job.n_groups; ++group) {
    for (int i = 0; i <= n_shape; ++i) __builtin_prefetch(numbers + (i + groups_ahead * (n_shape + 1)) * lanes);
    for (int lane = 0; lane < lanes; lane += width) {
      Vector first[6], other[6], dx[3 * others], dv[3 * others], shape[n_shape];
      for (int i = 0; i < 3; ++i) read_pair(records, corners + lane, i, first);
#pragma GCC unroll 3
      for (int k = 0; k < others; ++k) {
        for (int i = 0; i < 3; ++i) read_pair(records, corners + (k + 1) * lanes + lane, i, other);
        for (int c = 0; c < 3; ++c) dx[3 * k + c] = other[c] - first[c], dv[3 * k + c] = other[3 + c] - first[3 + c];
      }
      for (int i = 0; i < n_shape; ++i) shape[i] = load(numbers + i * lanes + lane);
      visit(dx, dv, shape, load(numbers + n_shape * lanes + lane), corners + lane);
    }
    corners += n_particles * lanes, numbers += (n_shape + 1) * lanes;
  }
}

template <class Law>
__attribute__((flatten)) void block_forces(const BlockForces& job) {
  using Force = typename Law::Force;
  constexpr int n_particles = Force::n_particles, others = n_particles - 1;
  const Force force = Law::force(Vector{} + job.scale, job.material);
  double* __restrict slots = job.slots;
  for (int i = 0; i < 4 * job.n_copies; ++i) slots[i] = 0.0;
  for_each_group<Force>(
      job, [&](const Vector* dx, const Vector* dv, const Vector* shape, Vector weight, const std::uint16_t* corners) {
        Vector f[3 * n_particles];
        force(dx, dv, shape, weight, f + 3);
        for (int c = 0; c < 3; ++c) f[c] = -sum_of<others>(f + 3, c);
#pragma GCC unroll 4
        for (int k = 0; k < n_particles; ++k) {
          add_lanes(slots, corners + k * lanes, f + 3 * k, std::make_integer_sequence<int, width>());
        }
      });
}

#include "qdem_solver/engine/cpu/dissipation_body.hpp"

DriftResult drift(const Drift& job) {
  DriftResult result{};
  for (int lane = 0; lane < lanes; lane += width) {
    Vector largest{}, sum{};
    for (std::int64_t i = lane; i < std::int64_t{job.n} * job.lanes; i += lanes) {
      const Vector velocity = load(job.v + i), accel = load(job.a + i);
      const Vector move = job.dt * (velocity + 0.5 * job.dt * accel), size = move < 0.0 ? -move : move;
      add_to(job.x + i, move);
      store(job.v + i, velocity + job.dt * accel);
      largest = size > largest ? size : largest;
      sum += size;
    }
    store(result.largest_move + lane, largest);
    for (int l = 0; l < width; ++l) result.sum += sum[l];
  }
  for (int l = 1; job.lanes == 1 && l < lanes; ++l) {
    if (result.largest_move[l] > result.largest_move[0]) result.largest_move[0] = result.largest_move[l];
  }
  return result;
}

inline void kick_values(const Kick& job, Vector gravity, std::int64_t i) {
  const Vector zero{}, inverse_mass = load(job.inverse_mass + i), velocity = load(job.v + i);
  Vector accel = inverse_mass > zero ? load(job.force + i) * inverse_mass + gravity : zero;
  const Vector size = accel < zero ? -accel : accel;
  const Vector sign = velocity > zero ? zero + 1.0 : (velocity < zero ? zero - 1.0 : zero);
  accel -= job.local_damping * size * sign + job.drag * velocity;
  store(job.v + i, velocity + 0.5 * job.dt * (accel - load(job.a + i)));
  store(job.a + i, accel);
}

void kick(const Kick& job) {
  // Components repeat after three groups of eight values, with one lane as with eight.
  constexpr int period = 3 * lanes;
  double gravity[period];
  for (int k = 0; k < period; ++k) gravity[k] = job.gravity[k / job.lanes % 3];
  const std::int64_t n = std::int64_t{3} * job.n_nodes * job.lanes;
  for (std::int64_t i = 0; i < n; i += period) {
    for (int k = 0; k < period && i + k < n; k += width) kick_values(job, load(gravity + k), i + k);
  }
}

void gather(const Gather& job) {
  for (int node = job.first; node < job.last; ++node) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = job.offsets[node]; i < job.offsets[node + 1]; ++i) {
      const double* slot = job.slots + std::int64_t{4} * job.copies[i];
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
      {lane_forces<Quadruples>, block_forces<Quadruples>, lane_power<QuadruplePower>, block_power<QuadruplePower>},
      {lane_forces<Bonds>, block_forces<Bonds>, lane_power<BondPower>, block_power<BondPower>},
      drift,
      kick,
      gather,
      scale_inertia};
  return table;
}

}  // namespace qdem::cpu
