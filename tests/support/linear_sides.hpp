// Two linear bodies in matrices, joined by pads along the seats' normal: sides for the coupling schemes that have more
// than one point. In one process here, as processes of their own in linear_participant.cpp.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "coupler/scheme/side.hpp"
#include "proto/pad/pad_law.hpp"

namespace tests {

/// M q'' + C q' + K q = load(t) + Phi^T f, of the points' motion along the normal: u = Phi q.
struct LinearBody {
  Eigen::MatrixXd mass, damping, stiffness;
  Eigen::MatrixXd points;  ///< Phi [n points][n dofs]
  Eigen::VectorXd q, v;
  std::function<Eigen::VectorXd(double begin, double end)> mean_load;  ///< over a time; none: no load

  Eigen::VectorXd load(double begin, double end) const {
    return mean_load ? mean_load(begin, end) : Eigen::VectorXd::Zero(q.size());
  }
};

/// n values along the normal as 3 n of the wire, and back.
inline std::vector<double> widened(const Eigen::VectorXd& values) {
  std::vector<double> result(3 * static_cast<std::size_t>(values.size()), 0.0);
  for (Eigen::Index i = 0; i < values.size(); ++i) result[3 * static_cast<std::size_t>(i) + 2] = values[i];
  return result;
}
inline Eigen::VectorXd narrowed(const std::vector<double>& values) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(values.size()) / 3);
  for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = values[3 * static_cast<std::size_t>(i) + 2];
  return result;
}

/// Pad as the rail's side sees it: laws of the cells along the normal, and the cells' motion from the points'.
struct RailPad {
  std::vector<proto::PadLaw> laws;
  Eigen::MatrixXd map;  ///< [n cells][n points]
};

/// The rail: average-acceleration Newmark in momentum form, a dense factorisation for every window length and set of
/// pressed cells.
class LinearRail : public coupler::Side {
 public:
  LinearRail(LinearBody body, RailPad pad) : body_(std::move(body)), kept_(body_), pad_(std::move(pad)) {}

  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override { body_.q = kept_.q, body_.v = kept_.v; }
  void commit(const proto::Commit&) override {
    kept_.q = body_.q, kept_.v = body_.v;
    time_ += window_s_;
  }
  const LinearBody& body() const { return body_; }
  proto::FieldSet motion() const;

 private:
  Eigen::VectorXd solve_robin(const proto::Advance& request);
  /// One window under a constant load and the pads of `pressed` cells about x, y.
  void step(double h, const Eigen::VectorXd& load, const std::vector<bool>& pressed, const Eigen::VectorXd& x,
            const Eigen::VectorXd& y);

  LinearBody body_, kept_;
  RailPad pad_;
  double time_ = 0.0, window_s_ = 0.0;
  using Factors = Eigen::PartialPivLU<Eigen::MatrixXd>;
  std::map<std::pair<double, std::vector<bool>>, Factors> factors_;
};

/// The sleepers: lumped masses (a diagonal mass matrix), kick-drift-kick along the rail's straight path.
class LinearSleeper : public coupler::Side {
 public:
  LinearSleeper(LinearBody body, std::vector<proto::PadLaw> laws)
      : body_(std::move(body)), kept_(body_), laws_(std::move(laws)) {}

  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override { body_.q = kept_.q, body_.v = kept_.v; }
  void commit(const proto::Commit&) override { kept_.q = body_.q, kept_.v = body_.v; }
  const LinearBody& body() const { return body_; }
  proto::FieldSet motion() const;

 private:
  Eigen::VectorXd acceleration(const Eigen::VectorXd& force) const;

  LinearBody body_, kept_;
  std::vector<proto::PadLaw> laws_;
};

inline proto::FieldSet LinearRail::motion() const {
  proto::FieldSet data;
  data.set(proto::field::rail_displacement, widened(body_.points * body_.q));
  data.set(proto::field::rail_velocity, widened(body_.points * body_.v));
  return data;
}

inline proto::Result LinearRail::advance(const proto::Advance& request) {
  namespace field = proto::field;
  kept_.q = body_.q, kept_.v = body_.v;
  window_s_ = request.window_s;
  proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
  if (request.data.has(field::force_carry)) {
    const Eigen::VectorXd robin = solve_robin(request), carry = narrowed(request.data.get(field::force_carry));
    result.data = motion();
    result.data.set(field::force_robin, widened(robin));
    result.data.set(field::force_used, widened(robin - carry));
    return result;
  }
  const bool joint = request.data.has(field::joint_force);
  const Eigen::VectorXd given = joint ? Eigen::VectorXd((narrowed(request.data.get(field::joint_force_begin)) +
                                                         narrowed(request.data.get(field::joint_force))) /
                                                        2)
                                      : narrowed(request.data.get(field::force_mean));
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pad_.laws.size()));
  step(request.window_s, body_.load(time_, time_ + request.window_s) - body_.points.transpose() * given,
       std::vector<bool>(pad_.laws.size(), false), none, none);
  result.data = motion();
  result.data.set(field::force_used, joint ? widened(given) : request.data.get(field::force_mean));
  return result;
}

inline Eigen::VectorXd LinearRail::solve_robin(const proto::Advance& request) {
  namespace field = proto::field;
  const double h = request.window_s;
  const Eigen::VectorXd x = narrowed(request.data.get(field::sleeper_mean_displacement)),
                        y = narrowed(request.data.get(field::sleeper_mean_velocity)),
                        carry = narrowed(request.data.get(field::force_carry));
  const Eigen::MatrixXd cells = pad_.map * body_.points;
  const auto n = static_cast<Eigen::Index>(pad_.laws.size());
  std::vector<bool> pressed(pad_.laws.size(), true), before;
  Eigen::VectorXd force(n);
  for (int attempt = 0; attempt < 50 && pressed != before; ++attempt) {
    before = pressed;
    Eigen::VectorXd clip = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      if (!pressed[static_cast<std::size_t>(i)]) clip[i] = pad_.laws[static_cast<std::size_t>(i)].preload;
    body_.q = kept_.q, body_.v = kept_.v;
    step(h, body_.load(time_, time_ + h) + cells.transpose() * (carry - clip), pressed, x, y);
    const Eigen::VectorXd gap = cells * (kept_.q + body_.q) / 2 - x, rate = cells * (body_.q - kept_.q) / h - y;
    for (Eigen::Index i = 0; i < n; ++i) {
      pressed[static_cast<std::size_t>(i)] = pad_.laws[static_cast<std::size_t>(i)].engaged(gap[i], rate[i]);
      force[i] = pad_.laws[static_cast<std::size_t>(i)].force(gap[i], rate[i]);
    }
  }
  return force;
}

inline void LinearRail::step(double h, const Eigen::VectorXd& load, const std::vector<bool>& pressed,
                             const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const auto n = static_cast<Eigen::Index>(pad_.laws.size());
  Eigen::VectorXd k(n), c(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& law = pad_.laws[static_cast<std::size_t>(i)];
    k[i] = pressed[static_cast<std::size_t>(i)] ? law.stiffness : 0.0;
    c[i] = pressed[static_cast<std::size_t>(i)] ? law.damping : 0.0;
  }
  const Eigen::MatrixXd cells = pad_.map * body_.points;
  const Eigen::MatrixXd stiffness = body_.stiffness + cells.transpose() * k.asDiagonal() * cells,
                        damping = body_.damping + cells.transpose() * c.asDiagonal() * cells;
  auto factors = factors_.find({h, pressed});
  if (factors == factors_.end())
    factors =
        factors_.emplace(std::pair(h, pressed), Factors(2.0 / h * body_.mass + h / 2 * stiffness + damping)).first;
  const Eigen::VectorXd outer = load + cells.transpose() * (k.cwiseProduct(x) + c.cwiseProduct(y));
  const Eigen::VectorXd mean_v = factors->second.solve(2.0 / h * body_.mass * body_.v - stiffness * body_.q + outer);
  body_.q += h * mean_v;
  body_.v = 2 * mean_v - body_.v;
}

inline proto::FieldSet LinearSleeper::motion() const {
  proto::FieldSet data;
  data.set(proto::field::sleeper_displacement, widened(body_.points * body_.q));
  data.set(proto::field::sleeper_velocity, widened(body_.points * body_.v));
  return data;
}

inline Eigen::VectorXd LinearSleeper::acceleration(const Eigen::VectorXd& force) const {
  return (body_.points.transpose() * force - body_.stiffness * body_.q - body_.damping * body_.v)
      .cwiseQuotient(body_.mass.diagonal());
}

inline proto::Result LinearSleeper::advance(const proto::Advance& request) {
  namespace field = proto::field;
  kept_.q = body_.q, kept_.v = body_.v;
  const bool joint = request.data.has(field::joint_force);
  const Eigen::VectorXd begin = narrowed(
                            request.data.get(joint ? field::joint_force_begin : field::rail_displacement_begin)),
                        end = narrowed(request.data.get(joint ? field::joint_force : field::rail_displacement));
  const double h = request.window_s / request.sub_cycles;
  const Eigen::VectorXd rate = (end - begin) / request.window_s;
  const auto force_at = [&](double s, const Eigen::VectorXd& velocity) {
    const Eigen::VectorXd driven = begin + s * (end - begin), y = body_.points * velocity;
    if (joint) return driven;
    const Eigen::VectorXd gap = driven - body_.points * body_.q;
    Eigen::VectorXd force(gap.size());
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      force[i] = laws_[static_cast<std::size_t>(i)].force(gap[i], rate[i] - y[i]);
    return force;
  };
  Eigen::VectorXd force = force_at(0.0, body_.v), impulse = Eigen::VectorXd::Zero(begin.size()), work = impulse;
  for (std::uint32_t j = 1; j <= request.sub_cycles; ++j) {
    const Eigen::VectorXd a = acceleration(force), half = body_.v + h / 2 * a, old = force, before = body_.q;
    body_.q += h * half;
    // Dashpots act at the force's own time level, hence on the predicted end velocity: second order.
    body_.v += h * a;
    force = force_at(static_cast<double>(j) / request.sub_cycles, body_.v);
    body_.v = half + h / 2 * acceleration(force);
    impulse += h / 2 * (old + force);
    const Eigen::VectorXd moved =
        joint ? Eigen::VectorXd(body_.points * (body_.q - before)) : Eigen::VectorXd(h * rate);
    work += (old + force).cwiseProduct(moved) / 2;
  }
  proto::Result result{request.phase, request.window, request.iteration, 0.0, motion()};
  result.data.set(field::impulse, widened(impulse));
  result.data.set(field::pad_work, widened(work));
  return result;
}

}  // namespace tests
