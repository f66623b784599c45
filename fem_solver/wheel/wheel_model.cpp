#include "fem_solver/wheel/wheel_model.hpp"

#include <Eigen/LU>

namespace fem {

WheelModel mass_wheel(const WheelSettings& settings) {
  WheelModel wheel;
  wheel.mass = Eigen::MatrixXd::Constant(1, 1, settings.unsprung_mass);
  wheel.damping = wheel.stiffness = Eigen::MatrixXd::Zero(1, 1);
  wheel.contact = wheel.rigid = Eigen::VectorXd::Ones(1);
  wheel.load = Eigen::VectorXd::Constant(1, settings.static_load);
  add_suspension(wheel, settings);
  return wheel;
}

void add_suspension(WheelModel& wheel, const WheelSettings& settings) {
  const SuspensionSettings& s = settings.suspension;
  if (s.stiffness == 0.0) return;
  const int n = wheel.n_dofs(), sprung = n;
  const auto grow = [n](Eigen::MatrixXd& matrix) {
    matrix.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
  };
  const auto join = [sprung](Eigen::MatrixXd& matrix, double value) {
    matrix(0, 0) += value, matrix(sprung, sprung) += value;
    matrix(0, sprung) -= value, matrix(sprung, 0) -= value;
  };
  grow(wheel.mass), grow(wheel.damping), grow(wheel.stiffness);
  wheel.mass(sprung, sprung) = s.sprung_mass;
  join(wheel.stiffness, s.stiffness);
  join(wheel.damping, s.damping);
  for (auto* row : {&wheel.contact, &wheel.load, &wheel.rigid})
    row->conservativeResizeLike(Eigen::VectorXd::Zero(n + 1));
  wheel.rigid[sprung] = 1.0;
  const double unsprung_weight = settings.unsprung_mass * gravity;
  wheel.load[0] = unsprung_weight;
  wheel.load[sprung] = settings.static_load - unsprung_weight;
}

WheelMotion wheel_at_rest(const WheelModel& wheel, double contact) {
  // The forces balance, so that a spring which holds the hub carries nothing.
  Eigen::MatrixXd held = wheel.stiffness;
  held(0, 0) += 1e9;
  const Eigen::VectorXd force = wheel.static_load() * wheel.contact - wheel.load;
  Eigen::VectorXd u = held.partialPivLu().solve(force);
  u += (contact - wheel.contact.dot(u)) * wheel.rigid;
  return {u, Eigen::VectorXd::Zero(u.size())};
}

WheelStepper::WheelStepper(const WheelModel& wheel, double step)
    : wheel_(wheel), step_(step), inverse_(wheel.n_dofs(), wheel.n_dofs()) {
  const double half = step / 2;
  const auto factor = Eigen::MatrixXd(wheel.mass + half * wheel.damping + half * half * wheel.stiffness).partialPivLu();
  for (int i = 0; i < wheel.n_dofs(); ++i)
    inverse_.col(i) = factor.solve(Eigen::VectorXd(half * Eigen::VectorXd::Unit(wheel.n_dofs(), i)));
  response_ = wheel.contact.dot(inverse_ * wheel.contact);
}

Eigen::VectorXd WheelStepper::mean_velocity(const WheelMotion& motion, double contact_force) const {
  const Eigen::VectorXd held =
      wheel_.damping * motion.velocity + wheel_.stiffness * (motion.displacement + step_ / 2 * motion.velocity);
  return motion.velocity + inverse_ * (contact_force * wheel_.contact - wheel_.load - held);
}

double WheelStepper::free_displacement(const WheelMotion& motion) const {
  return wheel_.contact.dot(motion.displacement + step_ / 2 * mean_velocity(motion, 0.0));
}

void WheelStepper::finish(WheelMotion& motion, double contact_force) const {
  const Eigen::VectorXd mean = mean_velocity(motion, contact_force);
  motion.displacement += step_ * mean;
  motion.velocity = 2 * mean - motion.velocity;
}

}  // namespace fem
