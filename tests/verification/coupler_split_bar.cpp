// A bar split between an implicit and an explicit side (test problem T4): fixed at one end, free at the other, first
// mode u = sin(kx) cos(ckt), k = pi/(2L). Joined rigidly by PH. Errors in space and in time are told apart: the
// semi-discrete bar has the same mode with the frequency w_h = (2c/h) sin(kh/2).
#include <Eigen/Dense>

#include "tests/support/scheme_run.hpp"

namespace {

namespace field = proto::field;

constexpr double length = 1.0, wave_number = 1.5707963267948966;  // c = EA = rho A = 1

/// Half of the bar in n elements of lumped mass: K u + M u'' = force at the joint.
struct HalfBar {
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd mass, u, v;
  Eigen::Index joint;

  /// `fixed`: from x = 0 to L/2 without the node at 0; else from L/2 to L.
  HalfBar(int n, bool fixed) : joint(fixed ? n - 1 : 0) {
    const double h = length / (2 * n);
    const Eigen::Index nodes = fixed ? n : n + 1;
    stiffness = Eigen::MatrixXd::Zero(nodes, nodes);
    mass = u = v = Eigen::VectorXd::Zero(nodes);
    for (Eigen::Index element = 0; element < n; ++element) {
      for (const Eigen::Index node : {element, element + 1}) {
        const Eigen::Index row = fixed ? node - 1 : node;
        if (row < 0) continue;
        mass[row] += h / 2;
        stiffness(row, row) += 1 / h;
        const Eigen::Index other = (fixed ? -1 : 0) + (node == element ? element + 1 : element);
        if (other >= 0) stiffness(row, other) -= 1 / h;
      }
    }
    for (Eigen::Index i = 0; i < nodes; ++i)
      u[i] =
          std::sin(wave_number * (fixed ? (static_cast<double>(i) + 1) * h : length / 2 + static_cast<double>(i) * h));
  }
};

/// Both halves as sides with one interface value; the joint force acts on the explicit one, its reverse on the other.
class BarSide : public coupler::Side {
 public:
  BarSide(int n, bool fixed) : bar_(n, fixed), kept_(bar_), fixed_(fixed) {}
  proto::Result advance(const proto::Advance& request) override {
    kept_ = bar_;
    const double begin = request.data.get(field::joint_force_begin)[0], end = request.data.get(field::joint_force)[0];
    fixed_ ? implicit_step(request.window_s, begin, end) : explicit_steps(request, begin, end);
    proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
    const double u = bar_.u[bar_.joint], v = bar_.v[bar_.joint], impulse = request.window_s * (begin + end) / 2;
    result.data.set(fixed_ ? field::rail_displacement : field::sleeper_displacement, {u});
    result.data.set(fixed_ ? field::rail_velocity : field::sleeper_velocity, {v});
    result.data.set(field::force_used, {(begin + end) / 2});
    result.data.set(field::impulse, {impulse});
    result.data.set(field::pad_work, {impulse * (v + kept_.v[bar_.joint]) / 2});
    return result;
  }
  void rollback(const proto::Rollback&) override { bar_ = kept_; }
  void commit(const proto::Commit&) override {}
  const HalfBar& bar() const { return bar_; }

 private:
  void implicit_step(double h, double begin, double end) {
    Eigen::VectorXd load = -bar_.stiffness * (bar_.u + h / 4 * bar_.v) + bar_.mass.cwiseProduct(bar_.v) / h;
    load[bar_.joint] -= (begin + end) / 2;
    const Eigen::MatrixXd left = Eigen::MatrixXd(bar_.mass.asDiagonal()) / h + h / 4 * bar_.stiffness;
    const Eigen::VectorXd v = left.llt().solve(load);
    bar_.u += h / 2 * (bar_.v + v);
    bar_.v = v;
  }
  void explicit_steps(const proto::Advance& request, double begin, double end) {
    const double h = request.window_s / request.sub_cycles;
    const auto acceleration = [&](double s) -> Eigen::VectorXd {
      Eigen::VectorXd force = -bar_.stiffness * bar_.u;
      force[bar_.joint] += begin + (end - begin) * s;
      return force.cwiseQuotient(bar_.mass);
    };
    for (std::uint32_t j = 0; j < request.sub_cycles; ++j) {
      bar_.v += h / 2 * acceleration(static_cast<double>(j) / request.sub_cycles);
      bar_.u += h * bar_.v;
      bar_.v += h / 2 * acceleration(static_cast<double>(j + 1) / request.sub_cycles);
    }
  }

  HalfBar bar_, kept_;
  bool fixed_;
};

/// Root mean square over the nodes of u - sin(kx) cos(w t) at the end of n windows.
double error(proto::Scheme scheme, int n_elements, int n_windows, std::uint32_t sub_cycles, double frequency) {
  constexpr double end_time = 3.0;
  BarSide rail(n_elements, true), sleeper(n_elements, false);
  tests::SchemeCase c(scheme);
  auto windows = coupler::make_scheme(scheme, c.coupling, {end_time / n_windows, sub_cycles, {proto::PadLaw{}}});
  const double u0 = std::sin(wave_number * length / 2);
  windows->start({{u0}, {0.0}, {u0}, {0.0}});
  for (int n = 0; n < n_windows; ++n) {
    windows->advance(proto::Phase::march, n, {rail, sleeper});
    windows->commit(n, {rail, sleeper});
  }
  const HalfBar first(n_elements, true), second(n_elements, false);
  const double factor = std::cos(frequency * end_time);
  return std::sqrt(
      ((rail.bar().u - factor * first.u).squaredNorm() + (sleeper.bar().u - factor * second.u).squaredNorm()) /
      (2 * n_elements));
}

double discrete_frequency(int n_elements) {
  const double h = length / (2 * n_elements);
  return 2 / h * std::sin(wave_number * h / 2);
}

TEST(SplitBar, PHIsOfSecondOrderInTimeAndGCOfFirst) {
  struct Row {
    proto::Scheme scheme;
    double order;
    int coarsest;  ///< windows; GC's first-order part shows only when the second-order one has gone
  };
  for (const auto& [scheme, order, coarsest] :
       {Row{proto::Scheme::rigid_per_window, 2.0, 120}, Row{proto::Scheme::rigid_per_step, 1.0, 1920}}) {
    std::vector<double> steps, errors;
    for (const int n : {coarsest, 2 * coarsest, 4 * coarsest}) {
      steps.push_back(1.0 / n);
      errors.push_back(error(scheme, 8, n, 10, discrete_frequency(8)));
    }
    std::printf("%s: order in time %.3f\n", proto::name_of(scheme).c_str(), tests::fitted_order(steps, errors));
    EXPECT_TRUE(tests::converges_with_order(steps, errors, order, 0.15)) << proto::name_of(scheme);
  }
}

TEST(SplitBar, IsOfSecondOrderInSpace) {
  std::vector<double> steps, errors;
  for (const int n : {2, 4, 8}) {
    steps.push_back(1.0 / n);
    errors.push_back(error(proto::Scheme::rigid_per_window, n, 1200, 4, wave_number));
  }
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.15));
}

}  // namespace
