// V8 creep and recovery under uniform uniaxial stress, V9 decay of a mode: closed forms of the Kelvin-Voigt solid
// (Fluegge, Viscoelasticity, 1975; Meirovitch, Fundamentals of Vibrations, 2001, for the logarithmic decrement).
#include <gtest/gtest.h>

#include "qdem_solver/physics/quadruple_energy.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/free_modes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tests::near_abs;
using tests::near_rel;

/// Retardation times [s] in volume and in shear: K_v = volume * K, mu_v = shear * mu.
struct Retardation {
  double volume, shear;
};

double bulk(const qdem::Material& m) {
  return m.lambda() + 2 * m.mu() / 3;
}

qdem::Material retarded(const Retardation& tau) {
  qdem::Material m = tests::rock();
  m.shear_viscosity = tau.shear * m.mu();
  m.lame_viscosity = tau.volume * bulk(m) - 2 * m.shear_viscosity / 3;
  return m;
}

struct Strain {
  double axial, lateral;
};

/// Strain at time t of a stress that acts from time 0 on, without inertia: volume and shape creep each by their own
/// time.
Strain creep(const qdem::Material& m, const Retardation& tau, double stress, double t) {
  const double volume = stress / (9 * bulk(m)) * -std::expm1(-t / tau.volume);
  const double shape = stress / (3 * m.mu()) * -std::expm1(-t / tau.shear);
  return {volume + shape, volume - shape / 2};
}

constexpr double stress = 1e5;  // [Pa]

/// Distorted block under stress along x. Every surface particle hangs on a pad so soft that its force is constant.
class CreepBlock {
 public:
  explicit CreepBlock(const Retardation& tau)
      : model_(block(retarded(tau))), state_(qdem::make_state(model_, {{}})), engine_(model_, {1}) {
    engine_.set_pad_reference(state_.x);
    engine_.prepare(state_);
    dt_ = 0.9 * qdem::largest_stable_step(qdem::template_rates(model_.templates[0], model_.materials[0]) +
                                          qdem::pad_rates(model_));
  }

  void load_for(double time) {
    const std::vector<double>& u = drive_;
    engine_.advance(state_, dt_, steps(time), {u, u});
  }
  void rest_for(double time) { engine_.advance(state_, dt_, steps(time)); }
  double time() const { return state_.time; }

  /// Mean over the volume.
  Strain strain() const {
    const auto& shape = model_.shape(0);
    Matrix3d mean = -Matrix3d::Identity();
    for (int e = 0; e < shape.n_tets(); ++e) {
      Matrix3d dx;
      const auto& tet = shape.tets[e];
      for (int k = 0; k < 3; ++k) {
        dx.col(k) = state_.position(model_, 0, tet[k + 1]) - state_.position(model_, 0, tet[0]);
      }
      const Matrix3d g = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.gradients[e].data());
      mean += shape.volumes[e] / shape.volume() * qdem::deformation_gradient(dx, g, 1.0);
    }
    return {mean(0, 0), 0.5 * (mean(1, 1) + mean(2, 2))};
  }

 private:
  static constexpr double pull = 1.0;  ///< of the pads: a million times what the block moves [m]

  std::int64_t steps(double time) const { return std::llround(time / dt_); }

  qdem::Model block(qdem::Material material) {
    auto model = tests::free_bodies(tests::box_template({3, 2, 2}, {0.03, 0.02, 0.02}, 8e-4), std::move(material));
    model.pad_body = 0;
    const auto& shape = model.shape(0);
    std::vector<double> force(shape.n_nodes(), 0.0);
    for (const auto& triangle : shape.triangles) {
      const auto& n = triangle.nodes;
      const Vector3d area = 0.5 * (shape.nodes[n[1]] - shape.nodes[n[0]]).cross(shape.nodes[n[2]] - shape.nodes[n[0]]);
      for (const int node : n) force[node] += stress * area[0] / 3;
    }
    for (const int node : shape.surface_nodes) {
      qdem::PadCell cell{{node}, {1.0}, Matrix3d::Identity(), {}};
      cell.laws[0].stiffness = std::abs(force[node]) / pull;
      model.pads.push_back(cell);
      drive_.insert(drive_.end(), {force[node] < 0 ? -pull : pull, 0.0, 0.0});
    }
    return model;
  }

  std::vector<double> drive_;
  qdem::Model model_;
  qdem::State state_;
  qdem::Engine engine_;
  double dt_ = 0.0;
};

/// Within 0.5 %, the lateral strain of what goes with the axial one: with unequal times it may pass through zero.
void expect_strain(const CreepBlock& block, const Strain& expected, double& worst) {
  const Strain found = block.strain();
  const double axial = std::abs(expected.axial), lateral = tests::rock().poisson * axial;
  EXPECT_TRUE(near_abs(found.axial, expected.axial, 0.005 * axial)) << "axial, t = " << block.time();
  EXPECT_TRUE(near_abs(found.lateral, expected.lateral, 0.005 * lateral)) << "lateral, t = " << block.time();
  worst = std::max(
      {worst, std::abs(found.axial - expected.axial) / axial, std::abs(found.lateral - expected.lateral) / lateral});
}

/// Inertia shortens or prolongs the retardation of a mode of frequency omega by 1/(omega tau)^2: times far above the
/// block's longest period.
constexpr double unit_time = 80e-6;

class Creep : public ::testing::TestWithParam<Retardation> {};

TEST_P(Creep, CreepAndRecovery) {
  const Retardation tau = GetParam();
  const qdem::Material material = retarded(tau);
  CreepBlock block(tau);
  double worst = 0;
  for (int i = 0; i < 6; ++i) {
    block.load_for(0.5 * unit_time);
    expect_strain(block, creep(material, tau, stress, block.time()), worst);
  }
  const double end = block.time();
  for (int i = 0; i < 4; ++i) {
    block.rest_for(0.5 * unit_time);
    const Strain loaded = creep(material, tau, stress, block.time());
    const Strain unloaded = creep(material, tau, stress, block.time() - end);  // superposition
    expect_strain(block, {loaded.axial - unloaded.axial, loaded.lateral - unloaded.lateral}, worst);
  }
  std::cout << "worst difference " << worst << "\n";
}

INSTANTIATE_TEST_SUITE_P(V8, Creep,
                         ::testing::Values(Retardation{unit_time, unit_time}, Retardation{unit_time, 2 * unit_time},
                                           Retardation{2 * unit_time, unit_time}),
                         [](const auto& name_of) {
                           const Retardation& tau = name_of.param;
                           if (tau.volume == tau.shear) return "Equal";
                           return tau.volume < tau.shear ? "SlowInShear" : "SlowInVolume";
                         });

/// Extreme values of a sampled oscillation and their times, by the parabola through three samples.
struct Extreme {
  double time, value;
};
std::vector<Extreme> extremes(const tests::Signal& signal) {
  std::vector<Extreme> result;
  for (std::size_t i = 1; i + 1 < signal.values.size(); ++i) {
    const double a = signal.values[i - 1], b = signal.values[i], c = signal.values[i + 1];
    if ((b - a) * (c - b) > 0 || b == a) continue;
    const double shift = 0.5 * (a - c) / (a - 2 * b + c);
    result.push_back({(static_cast<double>(i) + shift) * signal.interval, b - 0.25 * (a - c) * shift});
  }
  return result;
}

TEST(V9, ModeDecaysWithHalfOmegaTau) {
  const auto shape = tests::box_template({4, 3, 3}, {0.06, 0.04, 0.03});
  const auto mode = tests::free_modes(shape, tests::rock(), 1, 30e3).front();
  const double omega = 2 * M_PI * mode.frequency;
  std::vector<double> times, ratios;
  for (const double xi : {0.005, 0.02, 0.1, 0.5}) {
    const double tau = 2 * xi / omega, slowing = std::sqrt(1 - xi * xi);
    const auto model = tests::free_bodies(shape, tests::with_retardation(tests::rock(), tau));
    const auto found = extremes(tests::vibration(model, mode.shape, 1.6 / (mode.frequency * slowing), 0.2));
    ASSERT_GE(found.size(), 3u);
    const double decrement = std::log(found[0].value / found[2].value);
    const double ratio = decrement / std::hypot(2 * M_PI, decrement);
    const double damped = 2 * M_PI / (found[2].time - found[0].time);
    std::cout << "tau " << tau << " s: damping ratio " << ratio << " (" << xi << "), damped frequency "
              << damped / (omega * slowing) << " of the closed form\n";
    EXPECT_TRUE(near_rel(ratio, xi, 0.02));
    EXPECT_TRUE(near_rel(damped, omega * slowing, 0.02));
    times.push_back(tau), ratios.push_back(ratio);
  }
  EXPECT_TRUE(tests::converges_with_order(times, ratios, 1.0, 0.01));
}

}  // namespace
