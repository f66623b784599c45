// Test problems of the coupling by name, as linear bodies (linear_sides.hpp) and as text of a case. SI, or no units.
#pragma once

#include <cmath>
#include <complex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "tests/support/linear_sides.hpp"

namespace tests {

struct SeatPlace {
  double x = 0.0;             ///< of the seat's origin [m]
  int n = 1, m = 1;           ///< cells
  double half_length = 0.01;  ///< along both axes [m]
};

struct LinearProblem {
  std::vector<SeatPlace> seats;
  proto::PadLaw law;                         ///< of every cell, along the normal
  std::vector<Eigen::Vector3d> rail_points;  ///< of the only seat; empty: the case's cells [m]
  LinearBody rail, sleeper;
  double end_time = 1.0;

  std::size_t n_cells() const {
    std::size_t n = 0;
    for (const auto& seat : seats) n += static_cast<std::size_t>(seat.n * seat.m);
    return n;
  }
  std::vector<proto::PadLaw> laws() const { return std::vector<proto::PadLaw>(n_cells(), law); }
};

inline LinearBody masses(Eigen::Index n, double mass, double ground_stiffness, double ground_damping = 0.0) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  return {mass * one, ground_damping * one,     ground_stiffness * one,
          one,        Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n),
          {}};
}

/// One seat of 3 x 3 cells with a mass on a spring under each; a net of 4 x 4 masses above, 10 mm off the pad's plane.
/// `tied`: springs to the ground and between neighbours in the net, and a motion that is no rigid one; otherwise all is
/// free and moves as one rigid body (test problem T8).
inline LinearProblem plate(bool tied) {
  LinearProblem p;
  p.seats = {{0.0, 3, 3, 0.1}};
  p.law = {10.0, 0.2, 0.0, false};
  p.end_time = 4.0;
  p.rail = masses(16, 9.0 / 16, tied ? 9.0 / 16 : 0.0);
  p.sleeper = masses(9, 0.5, tied ? 4.0 : 0.0);
  for (int i = 0; i < 16; ++i) {
    const double x = 0.06 * (i % 4) - 0.09, y = 0.06 * (i / 4) - 0.09;
    p.rail_points.emplace_back(x, y, 0.01);
    p.rail.q[i] = tied ? 0.4 + 3.0 * x - 2.0 * y + 30.0 * x * y : 0.4 + 3.0 * x - 2.0 * y;
    p.rail.v[i] = tied ? 0.5 - 20.0 * x * x : 0.1 + 0.5 * x - 0.3 * y;
    for (const int j : {i % 4 < 3 ? i + 1 : -1, i < 12 ? i + 4 : -1}) {
      if (j < 0 || !tied) continue;
      p.rail.stiffness(i, i) += 3.0, p.rail.stiffness(j, j) += 3.0;
      p.rail.stiffness(i, j) -= 3.0, p.rail.stiffness(j, i) -= 3.0;
    }
  }
  for (int c = 0; c < 9; ++c) {
    const double x = (c % 3 - 1) * 0.2 / 3, y = (c / 3 - 1) * 0.2 / 3;
    p.sleeper.q[c] = tied ? -0.2 + 2.0 * x : 0.4 + 3.0 * x - 2.0 * y;
    p.sleeper.v[c] = tied ? 0.3 * (c % 2) : 0.1 + 0.5 * x - 0.3 * y;
  }
  return p;
}

/// Bar of n elements with lumped mass, rho A = EA = 1; its interface is the first node.
inline LinearBody bar(int n, double length, bool last_node_fixed) {
  const Eigen::Index nodes = n + 1, kept = last_node_fixed ? n : n + 1;
  const double h = length / n;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(nodes, nodes), mass = stiffness;
  for (Eigen::Index e = 0; e < n; ++e)
    for (const Eigen::Index i : {e, e + 1}) {
      mass(i, i) += h / 2;
      stiffness(i, i) += 1 / h;
      stiffness(i, 2 * e + 1 - i) -= 1 / h;
    }
  LinearBody body{mass.topLeftCorner(kept, kept),
                  Eigen::MatrixXd::Zero(kept, kept),
                  stiffness.topLeftCorner(kept, kept),
                  Eigen::MatrixXd::Zero(1, kept),
                  Eigen::VectorXd::Zero(kept),
                  Eigen::VectorXd::Zero(kept),
                  {}};
  body.points(0, 0) = 1.0;
  return body;
}

/// T4: bar of length 1, fixed at one end and free at the other, in its first mode, cut in the middle; joined rigidly.
inline LinearProblem split_bar() {
  LinearProblem p;
  p.seats = {{}};
  p.end_time = 3.0;
  const int n = 8;
  p.rail = bar(n, 0.5, true), p.sleeper = bar(n, 0.5, false);
  for (int i = 0; i <= n; ++i) {
    const double away = 0.5 * i / n;
    if (i < n) p.rail.q[i] = std::sin(M_PI / 2 * (0.5 - away));
    p.sleeper.q[i] = std::sin(M_PI / 2 * (0.5 + away));
  }
  return p;
}

/// T3: the split oscillator (T2) under a sinusoidal load on the rail, in its steady state from the beginning.
constexpr double drive_frequency = 2.5;

/// Complex amplitudes of rail and sleeper, u = Re(U e^{iwt}), under Re(e^{iwt}).
inline Eigen::Vector2cd forced_amplitudes() {
  const std::complex<double> i(0, 1), pad = 10.0 + i * drive_frequency * 0.2;
  const double w2 = drive_frequency * drive_frequency;
  Eigen::Matrix2cd dynamic;
  dynamic << 1.0 - w2 + pad, -pad, -pad, 4.0 - 0.5 * w2 + pad;
  return dynamic.partialPivLu().solve(Eigen::Vector2cd(1.0, 0.0));
}

inline LinearProblem forced() {
  LinearProblem p;
  p.seats = {{}};
  p.law = {10.0, 0.2, 0.0, false};
  p.end_time = 4.0;
  p.rail = masses(1, 1.0, 1.0), p.sleeper = masses(1, 0.5, 4.0);
  const auto amplitudes = forced_amplitudes();
  const std::complex<double> rate(0, drive_frequency);
  p.rail.q[0] = amplitudes[0].real(), p.rail.v[0] = (rate * amplitudes[0]).real();
  p.sleeper.q[0] = amplitudes[1].real(), p.sleeper.v[0] = (rate * amplitudes[1]).real();
  p.rail.mean_load = [](double begin, double end) -> Eigen::VectorXd {
    const double w = drive_frequency;
    return Eigen::VectorXd::Constant(1, (std::sin(w * end) - std::sin(w * begin)) / (w * (end - begin)));
  };
  return p;
}

/// T5: a bar that moves with velocity 1 strikes an equal one at rest, through a pad that only presses.
inline LinearProblem impact(int n_elements) {
  LinearProblem p;
  p.seats = {{}};
  p.law = {10.0, 0.1, 0.0, true};
  p.end_time = 1.2;  // before the waves are back
  p.rail = bar(n_elements, 1.0, false), p.sleeper = bar(n_elements, 1.0, false);
  p.sleeper.v.setOnes();
  return p;
}

/// Beam on seats: EI = rho A = 1 on a foundation of stiffness 4 per length, hence b = (k / 4 EI)^{1/4} = 1; half of the
/// compliance is the pads', half the ballast's. The rail has a little internal damping, so that the modes which no
/// window here resolves die out.
struct WinklerBeam {
  double spacing = 0.5, speed = 0.0, damping = 0.0, clip = -1.0;  ///< clip: preload of pads that do not pull else
  static constexpr double half_length = 8.0, foundation = 4.0, load = 1.0, sleeper_mass_per_length = 0.05,
                          retardation = 4e-3;  ///< of the rail [s]

  int n_seats() const { return 2 * static_cast<int>(std::lround(half_length / spacing)) + 1; }
  double start() const { return speed > 0.0 ? -1.0 : 0.0; }  ///< of the load [m]

  /// Closed form of an endless beam below its critical speed (2 sqrt(k EI) / rho A)^{1/2}: displacement (positive up)
  /// and its first two derivatives at `x` from the load.
  Eigen::Vector3d deflection(double x) const {
    const double mass = 1.0 + sleeper_mass_per_length / 4, critical = 2 * std::sqrt(foundation) / mass;
    const double a2 = speed * speed / critical, decay = std::sqrt(1 - a2), wave = std::sqrt(1 + a2);
    const double scale = -load / (2 * foundation), r = std::abs(x), sign = x < 0 ? -1.0 : 1.0;
    // The real part of A e^{(-decay + i wave) r}, A = 1/decay - i/wave, and its derivatives.
    const std::complex<double> rate(-decay, wave),
        value = std::complex<double>(1 / decay, -1 / wave) * std::exp(rate * r);
    return scale * Eigen::Vector3d(value.real(), sign * (rate * value).real(), (rate * rate * value).real());
  }
};

/// Hermite shape functions of an element of length h at s in [0, 1].
inline Eigen::Vector4d hermite(double s, double h) {
  const double r = 1 - s;
  return {r * r * (1 + 2 * s), h * s * r * r, s * s * (3 - 2 * s), -h * s * s * r};
}

inline LinearProblem winkler(const WinklerBeam& beam) {
  LinearProblem p;
  const int n = beam.n_seats();
  const double h = beam.spacing, seat = 2 * WinklerBeam::foundation * h;
  for (int i = 0; i < n; ++i) p.seats.push_back({-WinklerBeam::half_length + h * i, 1, 1, 0.01});
  p.law = {seat, 0.02 * h, std::max(0.0, beam.clip), beam.clip >= 0.0};
  p.end_time = 2.0;
  p.sleeper = masses(n, WinklerBeam::sleeper_mass_per_length * h, seat, beam.damping * h / 4);
  const Eigen::Index dofs = 2 * n;
  LinearBody& rail = p.rail;
  rail = {Eigen::MatrixXd::Zero(dofs, dofs),
          {},
          Eigen::MatrixXd::Zero(dofs, dofs),
          Eigen::MatrixXd::Zero(n, dofs),
          Eigen::VectorXd::Zero(dofs),
          Eigen::VectorXd::Zero(dofs),
          {}};
  Eigen::Matrix4d mass, stiffness;
  mass << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h, 54, 13 * h, 156, -22 * h, -13 * h,
      -3 * h * h, -22 * h, 4 * h * h;
  stiffness << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h, -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h,
      -6 * h, 4 * h * h;
  for (Eigen::Index e = 0; e + 1 < n; ++e) {
    rail.mass.block<4, 4>(2 * e, 2 * e) += h / 420 * mass;
    rail.stiffness.block<4, 4>(2 * e, 2 * e) += stiffness / (h * h * h);
  }
  rail.damping = beam.damping * rail.mass + WinklerBeam::retardation * rail.stiffness;
  for (Eigen::Index i = 0; i < n; ++i) {
    rail.points(i, 2 * i) = 1.0;
    if (beam.speed <= 0.0) continue;
    const auto u = beam.deflection(p.seats[static_cast<std::size_t>(i)].x - beam.start());
    rail.q.segment<2>(2 * i) << u[0], u[1];
    rail.v.segment<2>(2 * i) << -beam.speed * u[1], -beam.speed * u[2];
    p.sleeper.q[i] = u[0] / 2, p.sleeper.v[i] = -beam.speed * u[1] / 2;
  }
  // Mean over the time by Gauss's rule with three points; the load seldom crosses a node within it.
  rail.mean_load = [beam, dofs](double begin, double end) -> Eigen::VectorXd {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(dofs);
    for (const auto& [s, weight] : {std::pair(0.5 - std::sqrt(0.15), 5.0 / 18), std::pair(0.5, 8.0 / 18),
                                    std::pair(0.5 + std::sqrt(0.15), 5.0 / 18)}) {
      const double x = beam.start() + beam.speed * (begin + s * (end - begin)) + WinklerBeam::half_length;
      const auto e = std::min(static_cast<Eigen::Index>(x / beam.spacing), dofs / 2 - 2);
      load.segment<4>(2 * e) -=
          weight * WinklerBeam::load * hermite(x / beam.spacing - static_cast<double>(e), beam.spacing);
    }
    return load;
  };
  return p;
}

inline LinearProblem linear_problem(const std::string& name) {
  if (name == "plate") return plate(true);
  if (name == "rigid_plate") return plate(false);
  if (name == "split_bar") return split_bar();
  if (name == "forced") return forced();
  if (name == "impact") return impact(20);
  if (name == "fine_impact") return impact(40);
  if (name == "static_beam") return winkler({0.5, 0.0, 4.0});
  if (name == "fine_static_beam") return winkler({0.25, 0.0, 4.0});
  if (name == "moving_load") return winkler({0.5, 1.0});
  if (name == "uplift") return winkler({0.5, 1.0, 0.0, 2e-3});
  throw std::invalid_argument("no such problem: " + name);
}

/// z' = A z of z = (q, v of the rail; q, v of the sleepers) with every pad pressed, `map`: cells' motion from the
/// rail's points'; without load.
inline Eigen::MatrixXd system_matrix(const LinearProblem& p, const Eigen::MatrixXd& map) {
  const Eigen::Index a = p.rail.q.size(), b = p.sleeper.q.size();
  const Eigen::MatrixXd cells = map * p.rail.points, feet = p.sleeper.points;
  Eigen::MatrixXd relative(cells.rows(), a + b);
  relative << cells, -feet;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(a + b, a + b), stiffness = mass, damping = mass;
  mass.topLeftCorner(a, a) = p.rail.mass, mass.bottomRightCorner(b, b) = p.sleeper.mass;
  stiffness.topLeftCorner(a, a) = p.rail.stiffness, stiffness.bottomRightCorner(b, b) = p.sleeper.stiffness;
  damping.topLeftCorner(a, a) = p.rail.damping, damping.bottomRightCorner(b, b) = p.sleeper.damping;
  stiffness += p.law.stiffness * relative.transpose() * relative;
  damping += p.law.damping * relative.transpose() * relative;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(2 * (a + b), 2 * (a + b));
  system.topRightCorner(a + b, a + b).setIdentity();
  system.bottomLeftCorner(a + b, a + b) = -mass.partialPivLu().solve(stiffness);
  system.bottomRightCorner(a + b, a + b) = -mass.partialPivLu().solve(damping);
  return system;
}

/// Motion at the cells, (u, u', x, x') one after the other.
inline Eigen::VectorXd at_cells(const LinearProblem& p, const Eigen::MatrixXd& map, const Eigen::VectorXd& state) {
  const Eigen::Index a = p.rail.q.size(), b = p.sleeper.q.size(), n = map.rows();
  Eigen::VectorXd result(4 * n);
  result << map * p.rail.points * state.head(a), map * p.rail.points * state.segment(a + b, a),
      p.sleeper.points * state.segment(a, b), p.sleeper.points * state.tail(b);
  return result;
}

/// By the matrix exponential, at `time`.
inline Eigen::VectorXd exact_motion(const LinearProblem& p, const Eigen::MatrixXd& map, double time) {
  Eigen::VectorXd start(2 * (p.rail.q.size() + p.sleeper.q.size()));
  start << p.rail.q, p.sleeper.q, p.rail.v, p.sleeper.v;
  return at_cells(p, map, (system_matrix(p, map) * time).exp() * start);
}

/// Case of three processes; `more` are further lines of [coupling].
struct LinearCase {
  std::string problem = {}, scheme = "R1", fault = "none", more = {};
  int n_windows = 160;
  int sub_cycles = 1;
  double end_time = 0.0;  ///< 0: the problem's

  double window_s() const { return (end_time > 0.0 ? end_time : linear_problem(problem).end_time) / n_windows; }
  std::string text(const std::string& program) const {
    const auto p = linear_problem(problem);
    std::ostringstream s;
    s.precision(17);
    const auto command = [&](const char* side) {
      s << "[\"" << program << "\", \"--problem\", \"" << problem << "\", \"--side\", \"" << side
        << "\", \"--fault\", \"" << fault << "\", \"--step\", \"" << window_s() / sub_cycles << "\"]\n";
    };
    s << "[coupling]\nscheme = \"" << scheme << "\"\nwindow_s = " << window_s()
      << "\nduration_s = " << window_s() * n_windows << "\nqdem_command = ";
    command("sleeper");
    s << "fem_command = ";
    command("rail");
    s << more << "\n";
    for (std::size_t i = 0; i < p.seats.size(); ++i) {
      const auto& seat = p.seats[i];
      const double cells = seat.n * seat.m;
      s << "[[rail_seat]]\nname = \"seat" << i << "\"\norigin_m = [" << seat.x << ", 0.0, 0.0]\nhalf_lengths_m = ["
        << seat.half_length << ", " << seat.half_length << "]\ncells = [" << seat.n << ", " << seat.m
        << "]\nstiffness_n_per_m = [0.0, 0.0, " << cells * p.law.stiffness << "]\ndamping_ns_per_m = [0.0, 0.0, "
        << cells * p.law.damping << "]\nclip_preload_n = " << cells * p.law.preload
        << "\ntension_cutoff = " << (p.law.tension_cutoff ? "true" : "false") << "\n";
    }
    return s.str();
  }
};

}  // namespace tests
