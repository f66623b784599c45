#include "qdem_solver/participant/energy_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace qdem {
namespace {

constexpr const char* problem = "the energy ledger does not close";
constexpr const char* advice =
    "lower [qdem] step_safety; if that changes nothing the contacts are too soft for this load, so that surfaces pass "
    "through each other";

}  // namespace

const EnergyBalance& EnergyWatch::look(const Engine& engine, const State& state) {
  last_ = engine.balance(state);
  const double residual = std::abs(last_.relative());
  largest_ = std::max(largest_, residual);
  if (residual <= energy_warning) return last_;
  const std::string where =
      fmt::format("step {}, t = {:.6g} s: {:.3g} J {}, {:.1f} % of the {:.3g} J that were moved", state.step,
                  state.time, std::abs(last_.residual()), last_.residual() > 0 ? "came from nowhere" : "went nowhere",
                  100 * residual, last_.scale);
  if (!(residual <= energy_limit)) throw proto::Error(proto::ExitCode::numerics, problem, where, advice);
  if (!warned_) warn_(fmt::format("{} - {} - {}", problem, where, advice));
  warned_ = true;
  return last_;
}

void EnergyWatch::exchange(proto::StateArchive& archive) {
  archive("energy/largest_residual", largest_);
  archive("energy/warned", warned_);
}

std::vector<proto::Fact> EnergyWatch::facts() const {
  if (!last_.open) return {};
  return {{"qdem.energy.work_j", last_.work, {}},
          {"qdem.energy.viscous_j", last_.viscous, {}},
          {"qdem.energy.contact_dashpots_j", last_.contact_dashpots, {}},
          {"qdem.energy.friction_j", last_.friction, {}},
          {"qdem.energy.radiated_j", last_.radiated, {}},
          {"qdem.energy.residual_j", last_.residual(), {}},
          {"qdem.energy.residual_relative", last_.relative(), {}},
          {"qdem.energy.largest_residual_relative", largest_, {}}};
}

}  // namespace qdem
