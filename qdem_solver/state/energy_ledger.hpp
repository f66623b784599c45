// What flows into the energy of all bodies and out of it, counted from one moment on.
#pragma once

#include <cstdint>

#include "proto/span.hpp"

namespace qdem {

/// Energies that a state holds [J]. `gravity` counts from the origin, `boundary` is that of the springs of artificial
/// boundaries.
struct StoredEnergy {
  double kinetic = 0.0, strain = 0.0, contact = 0.0, gravity = 0.0, boundary = 0.0;
};

/// What the contacts dissipate at one time level [W].
struct ContactPower {
  double dashpot = 0.0;   ///< normal and tangential, and springs that a dashpot keeps from pushing back
  double friction = 0.0;  ///< of the sliders
  HOUSE_HOST_DEVICE ContactPower& operator+=(const ContactPower& other) {
    dashpot += other.dashpot, friction += other.friction;
    return *this;
  }
};

/// Flows since the ledger was opened. Part of State, so that a snapshot holds it.
struct EnergyLedger {
  bool open = false;
  StoredEnergy start;             ///< when it was opened
  std::int64_t first_step = 0;    ///< State::step then
  double work = 0.0;              ///< of pads and loads on the bodies [J]
  double largest_work = 0.0;      ///< largest |work| so far [J]
  double contact_dashpots = 0.0;  ///< dissipated [J]
  double friction = 0.0;          ///< dissipated [J]
  double viscous = 0.0;           ///< dissipated in the elements until viscous_time [J]
  double viscous_time = 0.0;      ///< State::time of the last sample [s]
  double viscous_power = 0.0;     ///< at the last sample [W]
  double radiated = 0.0;          ///< into the dashpots of artificial boundaries [J]
  double radiated_power = 0.0;    ///< at the state's time level [W]
  ContactPower contact_power;     ///< at the state's time level; kept while the ledger is closed, too
};

}  // namespace qdem
