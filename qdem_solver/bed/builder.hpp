// Pours, tamps and relaxes a bed with the QDEM engine.
#pragma once

#include <functional>
#include <vector>

#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/bed/loose_stack.hpp"
#include "qdem_solver/bed/settings.hpp"

namespace qdem::bed {

/// Builds one bed; README.md describes the stages. Use once: `Builder(settings, physics).build()`.
class Builder {
 public:
  Builder(const Settings& settings, const BedPhysics& physics);

  /// The bed at rest. Throws proto::Error: bad_data when it misses a limit of the case, numerics from the engine.
  Bed build();

 private:
  /// How soft stones are in a stage, and how the motion is damped.
  struct Softness {
    double young, stiffness;  ///< of stones [Pa], of contacts [N/m]
    double friction, damping_ratio;
    double local_damping, drag;
  };
  /// When a run may end before its last step.
  struct Rest {
    double speed = 0.0;       ///< root mean square over mass [m/s]; 0: never
    double unbalanced = 0.0;  ///< ratio; 0: not asked
    double kinetic = 0.0;     ///< [J]; 0: not asked
  };

  void make_stones();
  void pour_layer();
  void pour_crib();
  void bed_in();
  void harden(int first, int last);
  void come_to_rest();
  void finish();
  void check_limits() const;

  void add_planes();
  void soften(const Softness& softness, double preload);
  void add_stones(const std::vector<Stone>& stones, const std::vector<Rectangle>& floor, double bottom);
  void hold_sleeper(unsigned mask);
  void drop_contacts();
  void drop_spare_lanes();
  /// Steps for `most_time` [s]; after `least_time` ends early at rest, or when `enough` says so (every 200 steps).
  void run(double least_time, double most_time, const Rest& rest, const std::function<bool()>& enough);
  /// Presses a plane down on the stones to `level` [m] or until it bears `pressure` [Pa]; returns where it stopped [m].
  double tamp(double level, double pressure);
  double pressure_on(double level, double area) const;
  double top_of_stones() const;
  double mass_of_stones() const;
  double sleeper_weight() const;  ///< [N]
  /// Stones undeformed, at their true size, at rest where they are; contacts forgotten.
  void restore_shapes();
  /// The formwork goes; the stones come to rest, soft, under gravity and the sleeper.
  void settle();
  /// Level of the ramp from pouring (0) to real stiffness (ramp_levels).
  Softness at_level(int level, double drag) const;
  int settling_level() const { return (3 * settings_.ramp_levels + 7) / 8; }
  int bedding_level() const { return (6 * settings_.ramp_levels + 7) / 8; }
  void run_steps(int least, int most, const Rest& rest);
  double rattling_frequency(double stiffness) const;
  double seat_height() const;
  double envelope_volume(int template_id, double size) const;

  const Settings& settings_;
  const BedPhysics& physics_;
  Random random_;
  std::vector<Stone> layer_, crib_;
  double sleeper_bottom_ = 0.0;  ///< where the tamped layer ends, before the last shift [m]
  Model model_;
  State state_;
  BedReport report_;
};

}  // namespace qdem::bed
