// What a bed will be and cost, before it is built.
#pragma once

#include <cstdint>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/bed.hpp"

namespace qdem {

struct BedForecast {
  std::int64_t stones = 0;
  std::int64_t particles = 0, elements = 0;  ///< of stones and sleeper
  double stone_step_bound = 0.0;             ///< least largest stable step of a stone without contacts [s]
  double memory_bytes = 0.0;                 ///< of the solver with the bed in it, at its peak
};

/// Draws the stones as the builder does, so that their number is the bed's. Throws as make_bed for bad keys and stones
/// that cannot be meshed.
BedForecast forecast_bed(const proto::CaseFile& file, const BedPhysics& physics);

}  // namespace qdem
