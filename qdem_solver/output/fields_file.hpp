// qdem.h5: stones and sleeper over time, for ParaView and for reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/result/attributes.hpp"
#include "proto/result/field_series.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// All bodies as one tetrahedral grid. Points are the positions of the state given to the constructor; `displacement`
/// is measured from them. Point fields: displacement [m], velocity [m/s]. Cell fields: von_mises_stress, mean_stress
/// (positive in tension; of bonds, element_stress()) [Pa]. Static: body (number), sleeper (1 or 0), where the model has
/// any ground (1 or 0). Histories with every step: time [s], kinetic_energy, strain_energy, contact_energy,
/// gravity_energy [J], where there is one the energy ledger (EnergyBalance), where the model has a boundary
/// boundary_energy and radiated, touching (live contacts).
class FieldsFile {
 public:
  /// Creates `path`. `model` must outlive the object. Throws proto::Error (cannot_create).
  FieldsFile(const std::string& path, const Model& model, const State& reference, const proto::Attributes& attributes,
             bool has_ledger = true);

  /// Goes on with the file that an earlier process made with the same model and reference, after its first `n_steps`.
  static FieldsFile resume(const std::string& path, const Model& model, const State& reference,
                           const proto::Attributes& attributes, std::uint64_t n_steps, bool has_ledger = true);

  /// Appends one step; `balance` is that of `state`. Throws proto::Error (io_error).
  void write(double time, const State& state, const Engine& engine, const EnergyBalance& balance);

  std::uint64_t n_steps() const { return file_.n_steps(); }
  /// What was written is safe against a loss of power.
  void synchronise() { file_.synchronise(); }
  /// Closes and writes the ParaView sidecar.
  void close();

 private:
  FieldsFile(const Model& model, std::vector<double> reference, proto::FieldSeriesFile file, bool has_ledger);
  void put_energies(const EnergyBalance& balance);
  void put_stresses(const State& state);

  const Model& model_;
  std::vector<double> reference_;  ///< in the order of the points
  proto::FieldSeriesFile file_;
  bool has_ledger_;
};

}  // namespace qdem
