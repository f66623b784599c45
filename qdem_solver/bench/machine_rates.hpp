// What the machine itself can do, to compare a solver's rates with.
#pragma once

namespace qdem::bench {

struct MachineRates {
  double flops = 0.0;  ///< double precision fused multiply-adds, two flops each, from registers [1/s]
  double triad = 0.0;  ///< bytes moved by a = b + c d in memory, 24 a value [B/s]
};

/// Best of several rounds by the wall clock, all `threads` at once.
MachineRates machine_rates(int threads);

/// MachineRates::flops of one core in one round of half a millisecond or so.
double core_flop_rate();

}  // namespace qdem::bench
