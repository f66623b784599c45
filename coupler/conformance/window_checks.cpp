// What the participant answers in a window, held against what can be known at the interface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "coupler/conformance/check.hpp"
#include "coupler/conformance/subject.hpp"

namespace coupler::conformance {
namespace {

namespace field = proto::field;

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

/// Along a straight path the work is the impulse times the rail's velocity, whatever the law and the sub-cycles:
/// sum f_j+1/2 (u_1 - u_0)/m = I (u_1 - u_0)/H. To round-off.
std::string wrong_work(const proto::Advance& request, const proto::Result& result) {
  const auto& u0 = request.data.get(field::rail_displacement_begin);
  const auto& u1 = request.data.get(field::rail_displacement);
  const auto& impulse = result.data.get(field::impulse);
  const auto& work = result.data.get(field::pad_work);
  std::vector<double> wanted;
  for (std::size_t i = 0; i < u0.size(); ++i) wanted.push_back(impulse[i] * (u1[i] - u0[i]) / request.window_s);
  // The path's differences carry the round-off of the displacements.
  const double scale = largest(wanted) + largest(impulse) / request.window_s * (largest(u0) + largest(u1)) * 1e-4;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (std::abs(work[i] - wanted[i]) > 1e-10 * scale)
      return fmt::format("window {}, value {}: pad_work {:.10g} J, but impulse times rail velocity is {:.10g} J",
                         result.window, i, work[i], wanted[i]);
  return {};
}

std::vector<double> pad_force(const std::vector<proto::PadLaw>& laws, const std::vector<double>& u,
                              const proto::Result& at) {
  const auto& x = at.data.get(field::sleeper_displacement);
  const auto& y = at.data.get(field::sleeper_velocity);
  std::vector<double> force;
  for (std::size_t i = 0; i < laws.size(); ++i) force.push_back(laws[i].force(u[i] - x[i], -y[i]));
  return force;
}

/// Under a standing rail the pad's law at the motions that the participant returns gives the force at both ends of the
/// window; the trapezoid of the two is the impulse but for (w H)^2 / 12 of it, w the largest angular frequency in the
/// force. In a window of a quarter of the case's this is below 1 % for whatever the case's window resolves (w H < 1.4).
std::string wrong_impulse(Bench& bench, double& worst) {
  constexpr double tolerance = 0.02;
  const auto laws = proto::interface_laws(bench.candidate().seats);
  Settings settings;
  settings.window_share = 0.25;
  Subject subject(bench, settings);
  subject.bring_to(Stage::marching);
  const auto rail = subject.motion().standing_rail();
  auto before = subject.initial();
  double largest_force = 0.0, largest_error = 0.0;
  for (int n = 0; n < 4; ++n) {
    auto request = subject.request();
    request.data = rail;
    const auto result = subject.solve(request);
    subject.commit();
    const auto& u = rail.get(field::rail_displacement);
    const auto first = pad_force(laws, u, before), second = pad_force(laws, u, result);
    const auto& impulse = result.data.get(field::impulse);
    for (std::size_t i = 0; i < impulse.size(); ++i) {
      largest_error = std::max(largest_error, std::abs(impulse[i] / request.window_s - (first[i] + second[i]) / 2));
      largest_force = std::max(largest_force, std::abs(first[i]));
    }
    if (const double work = largest(result.data.get(field::pad_work)); work != 0.0)
      return fmt::format("the rail stands, but pad_work is {} J", work);
    before = result;
  }
  worst = largest_force > 0.0 ? largest_error / largest_force : 0.0;
  if (worst <= tolerance) return {};
  return fmt::format("under a standing rail impulse/H is off the pad law at the returned motions by {:.2g} of {:.4g} N",
                     worst, largest_force);
}

Verdict impulse(Bench& bench) {
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  for (int n = 0; n < 4; ++n) {
    const auto request = subject.request();
    const auto result = subject.solve(request);
    if (const auto text = wrong_work(request, result); !text.empty()) return fail(text);
    subject.commit();
  }
  double worst = 0.0;
  if (const auto text = wrong_impulse(bench, worst); !text.empty()) return fail(text);
  return pass(fmt::format("work to round-off, impulse within {:.1e} of the law", worst));
}

/// u_1 = u_0 + H (v_0 + v_1)/2 of every value.
std::string wrong_path(const proto::Result& before, const proto::Result& result, double window_s) {
  const auto& u0 = before.data.get(field::rail_displacement);
  const auto& v0 = before.data.get(field::rail_velocity);
  const auto& u1 = result.data.get(field::rail_displacement);
  const auto& v1 = result.data.get(field::rail_velocity);
  const double scale = largest(u0) + largest(u1) + window_s * (largest(v0) + largest(v1));
  for (std::size_t i = 0; i < u0.size(); ++i)
    if (std::abs(u1[i] - u0[i] - window_s * (v0[i] + v1[i]) / 2) > 1e-9 * scale)
      return fmt::format(
          "window {}, value {}: the displacement grew by {:.10g} m, the mean velocity times H is {:.10g} m",
          result.window, i, u1[i] - u0[i], window_s * (v0[i] + v1[i]) / 2);
  return {};
}

/// f_robin is the pad's law about the predicted sleeper at the window means; f_used is that less the carry.
std::string wrong_robin(const Subject& subject, const std::vector<proto::PadLaw>& laws, const proto::Result& before,
                        const proto::Advance& request, const proto::Result& result) {
  const auto u0 = subject.at_cells(before.data.get(field::rail_displacement));
  const auto u1 = subject.at_cells(result.data.get(field::rail_displacement));
  const auto& x = request.data.get(field::sleeper_mean_displacement);
  const auto& y = request.data.get(field::sleeper_mean_velocity);
  const auto& carry = request.data.get(field::force_carry);
  const auto& robin = result.data.get(field::force_robin);
  const auto& used = result.data.get(field::force_used);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double rate = (u1[i] - u0[i]) / request.window_s;
    const double wanted = laws[i].force((u0[i] + u1[i]) / 2 - x[i], rate - y[i]);
    const double scale = laws[i].stiffness * (std::abs(u0[i]) + std::abs(u1[i]) + std::abs(x[i])) +
                         laws[i].damping * ((std::abs(u0[i]) + std::abs(u1[i])) / request.window_s + std::abs(y[i]));
    if (std::abs(robin[i] - wanted) > 1e-9 * scale)
      return fmt::format(
          "window {}, value {}: force_robin {:.10g} N, the pad's law at the window means gives {:.10g} N",
          result.window, i, robin[i], wanted);
    if (std::abs(used[i] - (robin[i] - carry[i])) > 1e-12 * (std::abs(robin[i]) + std::abs(carry[i])))
      return fmt::format("window {}, value {}: force_used {:.10g} N instead of force_robin less the carry, {:.10g} N",
                         result.window, i, used[i], robin[i] - carry[i]);
  }
  return {};
}

Verdict robin_law(Bench& bench) {
  if (!bench.reference().capabilities.robin) return not_offered("not robin");
  const auto laws = proto::interface_laws(bench.candidate().seats);
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  auto before = subject.initial();
  for (int n = 0; n < 4; ++n) {
    const auto request = subject.request();
    const auto result = subject.solve(request);
    if (const auto text = wrong_path(before, result, request.window_s); !text.empty()) return fail(text);
    if (const auto text = wrong_robin(subject, laws, before, request, result); !text.empty()) return fail(text);
    subject.commit();
    before = result;
  }
  return pass("path, force_robin and force_used from the returned displacements");
}

/// Three windows under the mean force, `scale` times.
std::vector<proto::Result> forced_march(Bench& bench, double scale) {
  Settings settings;
  settings.mode = proto::LoadMode::prescribed_force;
  Subject subject(bench, settings);
  subject.bring_to(Stage::marching);
  std::vector<proto::Result> results{subject.initial()};
  for (int n = 0; n < 3; ++n) {
    const auto request = subject.request(scale);
    results.push_back(subject.solve(request));
    if (results.back().data.get(field::force_used) != request.data.get(field::force_mean))
      throw proto::Error(proto::ExitCode::protocol, "force_used is not the force_mean that was given");
    subject.commit();
  }
  return results;
}

/// Two runs that differ by the force alone. The work of the reaction's difference along the difference of the motions
/// is what the latter stores and dissipates, so it is positive; exactly so where the rail is linear.
Verdict momentum(Bench& bench) {
  const auto weak = forced_march(bench, 0.0), strong = forced_march(bench, 1.0);
  double work = 0.0;
  for (std::size_t n = 1; n < weak.size(); ++n) {
    if (const auto text = wrong_path(strong[n - 1], strong[n], bench.candidate().coupling.window_s); !text.empty())
      return fail(text);
    const auto& f0 = weak[n].data.get(field::force_used);
    const auto& f1 = strong[n].data.get(field::force_used);
    const auto moved = [&](const std::vector<proto::Result>& run, std::size_t i) {
      return run[n].data.get(field::rail_displacement)[i] - run[n - 1].data.get(field::rail_displacement)[i];
    };
    for (std::size_t i = 0; i < f0.size(); ++i) work -= (f1[i] - f0[i]) * (moved(strong, i) - moved(weak, i));
  }
  if (!(work > 0.0))
    return fail(
        fmt::format("a force on the sleeper must push the rail the other way; the reaction's work is {:.3g} J", work));
  return pass(fmt::format("force_used as given; the reaction's work on the rail is {:.3g} J", work));
}

/// The second of two windows with `factor` times the sub-cycles.
proto::Result with_sub_cycles(Bench& bench, std::uint32_t factor) {
  Settings settings;
  settings.sub_cycle_factor = factor;
  Subject subject(bench, settings);
  subject.bring_to(Stage::marching);
  return subject.march(2).back();
}

/// Largest over the fields of the largest difference over the field's largest value.
double distance(const proto::Result& a, const proto::Result& b) {
  double result = 0.0;
  for (const auto& values : a.data.all()) {
    const auto& other = b.data.get(values.name);
    double difference = 0.0;
    for (std::size_t i = 0; i < other.size(); ++i)
      difference = std::max(difference, std::abs(values.values[i] - other[i]));
    if (const double scale = largest(other); scale > 0.0) result = std::max(result, difference / scale);
  }
  return result;
}

/// At least of first order: that much every consistent integrator has, contacts that form within the window included.
Verdict sub_cycles(Bench& bench) {
  constexpr double smallest_order = 0.8, round_off = 1e-12;
  const auto coarse = with_sub_cycles(bench, 1), middle = with_sub_cycles(bench, 2), fine = with_sub_cycles(bench, 4);
  const double first = distance(coarse, middle), second = distance(middle, fine);
  if (first <= round_off && second <= round_off) return pass("does not depend on it");
  const double order = std::log2(first / second);
  const auto text = fmt::format("twice the sub-cycles change a window by {:.2e}, four times by {:.2e}: order {:.2f}",
                                first, second, order);
  return order >= smallest_order ? pass(text) : fail(text);
}

Verdict unknown_field(Bench& bench) {
  const auto& reference = bench.reference();
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  for (const auto& wanted : {reference.windows[0], reference.windows[1]}) {
    auto request = subject.request();
    request.data.set("a_field_of_a_later_version",
                     std::vector<double>(subject.n_values_of("a_field_of_a_later_version"), 1.0));
    if (const auto text = difference(subject.solve(request), wanted); !text.empty())
      return fail("a field that it does not know changes the answer: " + text);
    subject.commit();
  }
  return pass();
}

}  // namespace

std::vector<Check> window_checks() {
  return {
      {"impulse", "pad_work is impulse times rail velocity; the impulse is that of the pad's law", Role::qdem, impulse},
      {"robin_law", "force_robin is the law at the window means, force_used that less the carry", Role::fem, robin_law},
      {"momentum", "takes the mean force as given; its reaction pushes the rail the right way", Role::fem, momentum},
      {"sub_cycles", "a window depends on the number of sub-cycles to first order or better", Role::both, sub_cycles},
      {"unknown_field", "ignores a field that it does not know", Role::both, unknown_field}};
}

}  // namespace coupler::conformance
