// Sieve curves: which share of the mass passes which sieve, and stones that follow it.
#pragma once

#include <functional>
#include <vector>

#include "qdem_solver/bed/random.hpp"

namespace qdem::bed {

/// A sieve table. Between two sieves the passing share is linear in the size.
struct Gradation {
  std::vector<double> sizes;    ///< sieve openings, ascending [m]
  std::vector<double> passing;  ///< share of the mass that passes, ascending from 0 to 1 [-]

  /// Sieve size that `share` of the mass passes [m].
  double size_at(double share) const;
  double passing_at(double size) const;
};

struct Stone {
  int template_id = 0;
  double size = 0.0;    ///< sieve size: its middle extent [m]
  int material_id = 0;  ///< in BedPhysics::materials()
};

/// A part of a mixture of stones.
struct Ingredient {
  int material_id = 0;
  double share = 1.0;  ///< of the solid volume, in any unit
};

/// Solid volume of a stone of a template and a sieve size [m3].
using StoneVolume = std::function<double(int template_id, double size)>;

/// Draws stones until their solid volume reaches `volume` [m3]. Each stone comes from the sieve interval that lacks
/// most of its share; within an interval sizes are drawn so that mass spreads evenly. Templates are drawn evenly.
std::vector<Stone> draw_stones(const Gradation& gradation, int n_templates, const StoneVolume& volume_of, double volume,
                               Random& random);

/// Gives every stone, in their order, the material that lacks most of its share of the solid volume so far.
void mix_materials(const std::vector<Ingredient>& mixture, const StoneVolume& volume_of, std::vector<Stone>& stones);

}  // namespace qdem::bed
