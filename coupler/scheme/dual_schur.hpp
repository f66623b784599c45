// GC and PH: rigid joints. No pad; a joint force keeps the velocities of both sides equal.
#pragma once

#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler {

/// For sides that take a joint force (fields joint_force_begin, joint_force: linear over the window, on the sleeper;
/// the rail feels its reverse) and answer linearly. Their operators, velocity at the window's end per force at the
/// window's end, are probed once by unit forces and rollback; so is the joint force at time 0.
class DualSchur : public CouplingScheme {
 public:
  using CouplingScheme::CouplingScheme;

 protected:
  using Values = std::vector<double>;

  /// The window in which the sleeper's side is probed: PH its whole window, GC the first sub-step.
  struct SleeperWindow {
    std::int64_t number;
    double length_s;
    std::uint32_t sub_cycles;
  };
  /// Probes both sides and rolls them back, unless that was done.
  void probe(const WindowRecord& record, Sides sides, const SleeperWindow& fine);

  proto::Advance joint_request(std::int64_t window, std::uint32_t iteration, const Values& begin, const Values& end,
                               double window_s, std::uint32_t sub_cycles) const;
  /// The change of the joint force at the window's end that takes away the difference of velocities rail - sleeper.
  Values correction(const Values& rail_velocity, const Values& sleeper_velocity) const;

  std::uint32_t probes_ = 0;  ///< solves of this window that the probing took
};

/// PH (Prakash and Hjelmstad): velocities equal at every window's end, the force linear over the window. Second order
/// for any number of sub-cycles. Source: Int. J. Numer. Meth. Engng 61 (2004) 2183-2204.
class RigidPerWindow : public DualSchur {
 public:
  using DualSchur::DualSchur;

 private:
  void solve(WindowRecord& record, Sides sides) override;
};

/// GC (Gravouil and Combescure): velocities equal in every sub-step, the rail's free velocity linear between windows.
/// First order and dissipative with sub-cycles. The sleeper's side gets a window of its own for every sub-step.
/// Source: Int. J. Numer. Meth. Engng 50 (2001) 199-225.
class RigidPerStep : public DualSchur {
 public:
  using DualSchur::DualSchur;
  void commit(std::int64_t window, Sides sides) const override;

 private:
  void solve(WindowRecord& record, Sides sides) override;
  /// Sub-steps of the window; adds up impulse and work. Returns the joint force at the end.
  Values sub_steps(WindowRecord& record, const Values& free_begin, const Values& free_end, Side& sleeper);
};

}  // namespace coupler
