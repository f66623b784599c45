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

void lane_forces(const LaneForces& job) {
  for (int lane = 0; lane < lanes; lane += width) {
    const Vector scale = load(job.scale + lane);
    const QuadrupleForce<Vector> force{scale * scale, 1.0 / scale, job.material};
    const double* x = job.x + lane;
    const double* v = job.v + lane;
    double* out = job.force + lane;
    for (int e = 0; e < job.shape.n_tets; ++e) {
      const int* tet = job.shape.tets + 4 * e;
      const int first = tet[0] * 3 * lanes;
      Vector dx[9], dv[9], f[9];
      for (int c = 0; c < 3; ++c) {
        const Vector x0 = load(x + first + c * lanes), v0 = load(v + first + c * lanes);
        for (int k = 0; k < 3; ++k) {
          const int other = tet[k + 1] * 3 * lanes + c * lanes;
          dx[3 * k + c] = load(x + other) - x0;
          dv[3 * k + c] = load(v + other) - v0;
        }
      }
      force(dx, dv, job.shape.gradients + 9 * e, job.shape.volumes[e], f);
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 3; ++k) add_to(out + tet[k + 1] * 3 * lanes + c * lanes, f[3 * k + c]);
        add_to(out + first + c * lanes, -(f[c] + f[3 + c] + f[6 + c]));
      }
    }
  }
}

/// `count` <= width elements of one body, one a vector lane.
inline void single_group(const SingleForces& job, const QuadrupleForce<Vector>& force, int first, int count) {
  alignas(64) double dx[9][width], dv[9][width], g[9][width], volume[width], f[9][width];
  for (int lane = 0; lane < width; ++lane) {
    const int e = first + (lane < count ? lane : 0);
    const int* tet = job.shape.tets + 4 * e;
    const double *x0 = job.x + 3 * tet[0], *v0 = job.v + 3 * tet[0];
    for (int k = 0; k < 3; ++k) {
      const double *xk = job.x + 3 * tet[k + 1], *vk = job.v + 3 * tet[k + 1];
      for (int c = 0; c < 3; ++c) dx[3 * k + c][lane] = xk[c] - x0[c], dv[3 * k + c][lane] = vk[c] - v0[c];
    }
    for (int i = 0; i < 9; ++i) g[i][lane] = job.shape.gradients[9 * e + i];
    volume[lane] = job.shape.volumes[e];
  }
  force(reinterpret_cast<const Vector*>(dx), reinterpret_cast<const Vector*>(dv), reinterpret_cast<const Vector*>(g),
        load(volume), reinterpret_cast<Vector*>(f));
  for (int lane = 0; lane < count; ++lane) {
    double* slot = job.slots + 12 * (first + lane);
    for (int c = 0; c < 3; ++c) {
      slot[c] = -(f[c][lane] + f[3 + c][lane] + f[6 + c][lane]);
      for (int k = 0; k < 3; ++k) slot[3 * (k + 1) + c] = f[3 * k + c][lane];
    }
  }
}

void single_forces(const SingleForces& job) {
  const Vector one = Vector{} + 1.0;
  const QuadrupleForce<Vector> force{one * (job.scale * job.scale), one / job.scale, job.material};
  for (int e = job.first; e < job.last; e += width) {
    single_group(job, force, e, job.last - e < width ? job.last - e : width);
  }
}

DriftResult drift(const Drift& job) {
  double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::int64_t i = 0; i < job.n; ++i) {
    const double move = job.dt * (job.v[i] + 0.5 * job.dt * job.a[i]);
    job.x[i] += move;
    job.v[i] += job.dt * job.a[i];
    const double size = move < 0 ? -move : move;
    largest = size > largest ? size : largest;
    sum += size;
  }
  return {largest, sum};
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

}  // namespace

const Kernels& QDEM_KERNELS() {
  static const Kernels table{QDEM_INSTRUCTION_SET, lane_forces, single_forces, drift, kick, gather};
  return table;
}

}  // namespace qdem::cpu
