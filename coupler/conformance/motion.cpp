#include "coupler/conformance/motion.hpp"

#include <cmath>
#include <utility>

namespace coupler::conformance {
namespace {

namespace field = proto::field;

constexpr double period_windows = 16.0;
constexpr double direction[3] = {0.3, 0.2, -1.0};  // mostly downwards: the pad is pressed
constexpr double carry_share = 0.05;               // of the force that the amplitude gives

}  // namespace

Motion::Motion(std::vector<double> start, std::vector<proto::PadLaw> laws, double window_s, double amplitude_m)
    : start_(std::move(start)), laws_(std::move(laws)), window_s_(window_s), amplitude_m_(amplitude_m) {}

std::vector<double> Motion::displacement(double windows, double scale) const {
  const double share = (1.0 - std::cos(2.0 * M_PI * windows / period_windows)) / 2.0;
  auto values = start_;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += scale * amplitude_m_ * direction[i % 3] * share;
  return values;
}

std::vector<double> Motion::velocity(double windows, double scale) const {
  const double rate = M_PI / (period_windows * window_s_) * std::sin(2.0 * M_PI * windows / period_windows);
  std::vector<double> values(start_.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = scale * amplitude_m_ * direction[i % 3] * rate;
  return values;
}

proto::FieldSet Motion::rail(std::int64_t n, double scale) const {
  const auto begin = static_cast<double>(n);
  proto::FieldSet data;
  data.set(field::rail_displacement_begin, displacement(begin, scale));
  data.set(field::rail_displacement, displacement(begin + 1.0, scale));
  data.set(field::rail_velocity_begin, velocity(begin, scale));
  data.set(field::rail_velocity, velocity(begin + 1.0, scale));
  return data;
}

proto::FieldSet Motion::standing_rail() const {
  const auto pressed = displacement(period_windows / 2.0, 1.0);
  const std::vector<double> still(start_.size(), 0.0);
  proto::FieldSet data;
  data.set(field::rail_displacement_begin, pressed);
  data.set(field::rail_displacement, pressed);
  data.set(field::rail_velocity_begin, still);
  data.set(field::rail_velocity, still);
  return data;
}

proto::FieldSet Motion::sleeper(std::int64_t n, double scale) const {
  const double middle = static_cast<double>(n) + 0.5;
  proto::FieldSet data;
  data.set(field::sleeper_mean_displacement, displacement(middle, scale));
  data.set(field::sleeper_mean_velocity, velocity(middle, scale));
  std::vector<double> carry;
  for (const auto& law : laws_) carry.push_back(carry_share * law.stiffness * amplitude_m_);
  data.set(field::force_carry, carry);
  return data;
}

proto::FieldSet Motion::force(std::int64_t n, double scale) const {
  const auto x = displacement(static_cast<double>(n) + 0.5, scale);
  std::vector<double> values;
  for (std::size_t i = 0; i < laws_.size(); ++i) values.push_back(laws_[i].stiffness * (start_[i] - x[i]));
  proto::FieldSet data;
  data.set(field::force_mean, values);
  return data;
}

}  // namespace coupler::conformance
