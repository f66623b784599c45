// Looks at the energy ledger of a run: warns when it does not close, and stops the run when it is wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "proto/result/state_archive.hpp"
#include "proto/wire/messages.hpp"
#include "qdem_solver/engine/engine.hpp"

namespace qdem {

/// Share of EnergyBalance::scale above which the residual is worth a warning, and a wrong result.
inline constexpr double energy_warning = 0.02, energy_limit = 0.10;
/// At most so many steps between two looks; a look costs about as much as fifteen steps.
inline constexpr std::int64_t steps_per_energy_look = 2000;

class EnergyWatch {
 public:
  /// `warn` is called at most once, with one line.
  explicit EnergyWatch(std::function<void(const std::string&)> warn) : warn_(std::move(warn)) {}

  /// The balance at `state`, the one of the engine's last step.
  /// Throws proto::Error (numerics) with step and time when the residual is above energy_limit.
  const EnergyBalance& look(const Engine& engine, const State& state);

  double largest_residual() const { return largest_; }  ///< of all looks, relative [-]
  /// What a resumed run needs: the largest residual, and whether the warning was given.
  void exchange(proto::StateArchive& archive);
  /// Names below "qdem.energy." for the summary: the last balance, and the largest residual. None
  /// with a closed ledger.
  std::vector<proto::Fact> facts() const;

 private:
  std::function<void(const std::string&)> warn_;
  EnergyBalance last_;
  double largest_ = 0.0;
  bool warned_ = false;
};

}  // namespace qdem
