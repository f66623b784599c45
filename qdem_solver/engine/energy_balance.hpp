// The energy ledger at one instant: what is stored, what flowed, and whether it adds up.
#pragma once

#include "qdem_solver/state/energy_ledger.hpp"

namespace qdem {

/// Engine::balance(). While the ledger is closed no flow is counted: they are zero, and so is the change.
struct EnergyBalance {
  bool open = false;              ///< the ledger
  StoredEnergy stored;            ///< now [J]
  StoredEnergy change;            ///< since the ledger was opened [J]
  double work = 0.0;              ///< of pads and loads on the bodies [J]
  double viscous = 0.0;           ///< dissipated in the elements [J]
  double contact_dashpots = 0.0;  ///< [J]
  double friction = 0.0;          ///< [J]
  double radiated = 0.0;          ///< into the ground beyond artificial boundaries [J]

  /// Radiated or turned into heat [J].
  double dissipated() const { return viscous + contact_dashpots + friction + radiated; }
  /// Energy that came from nowhere: change of what is stored, plus what was dissipated, minus the work [J].
  double residual() const;
  /// What the residual is measured by [J]: the largest of |work| so far, of what was dissipated, of what one kind of
  /// stored energy gained from another, and of the motion there was at the start; at least a thousandth of the elastic
  /// energy at the start, so that a bed at rest has a measure, too.
  double scale = 0.0;
  double relative() const { return scale > 0 ? residual() / scale : 0.0; }
};

}  // namespace qdem
