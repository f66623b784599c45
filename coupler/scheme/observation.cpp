#include "coupler/scheme/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coupler {

void Observation::add(const WindowRecord& record) {
  const std::int64_t n = state_.n_windows++, quarter = n_windows_ / 4;
  state_.n_solves += record.solves;
  state_.most_solves = std::max(state_.most_solves, record.solves);
  if (!record.converged) ++state_.n_unconverged;
  if (record.contraction > 0.0) {
    state_.log_contraction += std::log(record.contraction);
    ++state_.n_contractions;
  }
  double defect = 0.0;
  for (std::size_t i = 0; i < record.impulse.size(); ++i) {
    const double value = window_s_ * record.force_used[i] - record.impulse[i];
    defect += value * value;
    state_.impulse += record.impulse[i] * record.impulse[i];
  }
  if (n >= n_windows_ - quarter)
    state_.defect_last += defect;
  else if (n >= n_windows_ - 2 * quarter)
    state_.defect_before += defect;
  for (std::size_t i = 0; i < record.force_law.size(); ++i) {
    const double deviation = record.force_robin[i] - record.force_law[i];
    state_.law_deviation += deviation * deviation;
    state_.law_force += record.force_law[i] * record.force_law[i];
  }
}

void Observation::exchange(proto::StateArchive& archive) {
  auto planned = n_windows_;
  archive("observation/planned", planned);
  archive("observation/windows", state_.n_windows);
  archive("observation/solves", state_.n_solves);
  archive("observation/unconverged", state_.n_unconverged);
  archive("observation/contractions", state_.n_contractions);
  archive("observation/most_solves", state_.most_solves);
  archive("observation/log_contraction", state_.log_contraction);
  archive("observation/defect_before", state_.defect_before);
  archive("observation/defect_last", state_.defect_last);
  archive("observation/impulse", state_.impulse);
  archive("observation/law_deviation", state_.law_deviation);
  archive("observation/law_force", state_.law_force);
  // A run that goes on for longer than it was planned has other quarters.
  if (planned != n_windows_) state_.defect_before = state_.defect_last = 0.0;
}

double Observation::mean_solves() const {
  return state_.n_windows > 0 ? static_cast<double>(state_.n_solves) / static_cast<double>(state_.n_windows) : 0.0;
}

double Observation::contraction() const {
  return state_.n_contractions > 0 ? std::exp(state_.log_contraction / static_cast<double>(state_.n_contractions))
                                   : 0.0;
}

double Observation::growth() const {
  const auto quarter = static_cast<double>(n_windows_ / 4);
  constexpr double round_off = 1e-12;
  const double least = round_off * round_off * state_.impulse;
  if (quarter < 2.0 || !(state_.defect_before > least) || !(state_.defect_last > least)) return 1.0;
  return std::pow(state_.defect_last / state_.defect_before, 0.5 / quarter);
}

double Observation::law_deviation() const {
  return state_.law_force > 0.0 ? std::sqrt(state_.law_deviation / state_.law_force) : 0.0;
}

std::string Observation::text() const {
  auto text = fmt::format("passes per window {:.2f} (at most {})", mean_solves(), state_.most_solves);
  if (state_.n_contractions > 0) text += fmt::format(", contraction {:.2g}", contraction());
  if (state_.n_unconverged > 0) text += fmt::format(", {} windows not converged", state_.n_unconverged);
  return text + fmt::format(", growth of the momentum defect {:+.1e} per window", growth() - 1.0);
}

}  // namespace coupler
