// What the engine holds between steps: scratch only, and the parts it drives.
#pragma once

#include <vector>

#include "qdem_solver/engine/boundary_forces.hpp"
#include "qdem_solver/engine/cpu/aligned_values.hpp"
#include "qdem_solver/engine/cpu/tasks.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/pads.hpp"
#include "qdem_solver/engine/patch_loads.hpp"
#include "qdem_solver/engine/stepper.hpp"

namespace qdem {

struct Engine::Data {
  Data(const Model& the_model, EngineOptions the_options);

  /// Positions, predicted velocities, contact forces and loads at `time`; returns with state.v = v_pred.
  void begin_step(State& state, double dt, double time);
  /// All other forces and the second half of the kick.
  void end_step(State& state, double dt, proto::Span<const double> pad_force);

  void drift(State& state, double dt);
  void run(State& state, const cpu::Task& task, double dt, proto::Span<const double> pad_force);
  void run_blocks(const State& state, const cpu::Task& task);
  /// What a kernel needs of block `b` of the body of `task`.
  cpu::BlockForces block_job(const State& state, const cpu::Task& task, int b);
  void run_outer(const State& state, const cpu::Task& task, proto::Span<const double> pad_force);
  void kick(State& state, const Batch& batch, int first, int last, double dt);
  bool relaxing() const { return !model.inertia.empty(); }
  void scale_inertia(const State& state, const Batch& batch, double dt);
  void add_load(const Batch& batch);

  /// Exchanges the pad forces that state.a holds for others at the same time level.
  void add_pad_change(State& state, proto::Span<const double> new_force);
  std::vector<double> pad_values(const std::vector<double>& field) const;
  /// Displacement of the sleeper at the pad cells from pad_reference.
  std::vector<double> pad_displacement(const State& state) const;
  /// For rail motion u, u' and sleeper displacement x.
  std::vector<double> pad_forces(const State& state, const std::vector<double>& u, const std::vector<double>& rate,
                                 const std::vector<double>& x) const;
  double viscous_power(const State& state, const cpu::Task& task);
  static void book_contacts(EnergyLedger& ledger, const ContactPower& power, double dt);
  void book_radiation(State& state, double dt) const;
  static void book_work(EnergyLedger& ledger, double work);
  PadSums advance_on_device(State& state, double dt, std::int64_t n_steps, const PadDrive* drive);

  const Model& model;
  EngineOptions options;
  int n_threads;
  const cpu::Kernels& kernels;
  cpu::TaskList tasks;
  std::vector<double> inverse_mass;
  std::vector<double> free_motions;  ///< of every body, 6 each (cpu::free_motions)
  cpu::AlignedValues force;
  std::vector<double> moves;                ///< of each body in the last drift [m]
  cpu::AlignedValues slots;                 ///< forces of single bodies' blocks
  std::vector<cpu::AlignedValues> records;  ///< of each thread: particles of one block
  ContactStage contact;
  PadOperator pads;
  PatchLoads loads;
  BoundaryForces boundary;
  std::vector<double> pad_reference;  ///< pad values of the positions that count as undisplaced [m]
  std::unique_ptr<Stepper> device;    ///< makes the steps in place of all the above; nullptr: the CPU does
};

}  // namespace qdem
